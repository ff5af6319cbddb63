#pragma once

#include <vector>

#include "qddot/model/kernels/neighbours.hpp"
#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/model/system.hpp"

namespace qddot::kernels {

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
  // The laws of a slot's springs: places of `slice_rows` stiffnesses, of their rest lengths if any
  // spring of the network has one, and of their quartic stiffnesses likewise. Equal vectors stand
  // there once: those of a grid are few and stay in the nearest cache. Each slice has its slots of
  // one shift first, then its slots that gather.
  std::vector<SlotLaw> slot_laws;
  // The constants of a slot's dashpots: places of `slice_rows` numbers likewise; empty if there are
  // none.
  std::vector<int> slot_dashpots;
  Vec laws;
  int law_vectors = 1;
  std::vector<char> gathered;  // of a slice: whether any slot gathers from its places

  int rows() const { return static_cast<int>(node.size()); }
  int count() const { return static_cast<int>(slices.size()) - 1; }
};

// Rows are sorted within windows of this size; across more, positions are far apart in memory.
constexpr int sorted_rows = 256;

// N nodes; points N, ..., N + extras - 1 are no nodes. Rows are in the nodes' order, or sorted by
// number of springs within windows if that leaves fewer slots.
NeighbourSlices slice_neighbours(const Neighbours& neighbours, int extras);

}  // namespace qddot::kernels
