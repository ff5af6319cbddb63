#pragma once

#include <vector>

#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/model/spring.hpp"
#include "qddot/model/system.hpp"

namespace qddot::kernels {

// One end of a spring as seen from its node: the other end.
struct Neighbour {
  int point;  // a node, or an extra point; see slice_neighbours
  SpringLaw law;
};

// The springs of all nodes, laid out for a processor that evaluates several at once. A row is a
// node, a slice has `slice_rows` rows, and a slot has one spring of each row. Every spring is here
// twice, once for each end, so that a row sums its own forces and nothing is scattered. Rows with
// fewer springs are filled with springs of stiffness zero. This is the format SELL-C-sigma
// (Kreutzer, Hager, Wellein, Fehske, Bishop, SIAM J. Sci. Comput. 36 (2014) C401-C423) with two
// kinds of slots. Some slots gather their neighbours; others, as most inside a grid, have one
// shift.
struct NeighbourSlices {
  // The node of each row, -1 for rows that fill up the last slice. Places are numbered by rows
  // first and then by the extra points.
  std::vector<int> node;
  int places = 0;
  std::vector<Slice> slices;  // and the end
  std::vector<int> shifts;    // of a slot: its rows' neighbours are at the rows' places plus this
  std::vector<int> gathers;   // of a slot: `slice_rows` places
  // The stiffnesses of a slot's springs. The rest lengths follow if any spring of the network has
  // one, then the quartic stiffnesses likewise. Each slice has its slots of one shift first, then
  // its slots that gather.
  Vec laws;
  int law_vectors = 1;
  std::vector<char> gathered;  // of a slice: whether any slot gathers from its places

  int rows() const { return static_cast<int>(node.size()); }
  int count() const { return static_cast<int>(slices.size()) - 1; }
};

// neighbours[i]: those of node i < N; points N, ..., N + extras - 1 are no nodes. Rows are in the
// nodes' order, or sorted by number of springs within windows if that leaves fewer slots.
NeighbourSlices slice_neighbours(const std::vector<std::vector<Neighbour>>& neighbours, int extras);

}  // namespace qddot::kernels
