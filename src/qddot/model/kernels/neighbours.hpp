#pragma once

#include <numeric>
#include <vector>

#include "qddot/model/repeated_values.hpp"
#include "qddot/model/spring.hpp"

namespace qddot::kernels {

// One end of a spring as seen from its node: the other end, and the number of its law.
struct Neighbour {
  int point;  // a node, or an extra point; see slice_neighbours
  int law;
};

// The neighbours of all nodes: those of node i are ends[first[i]], ..., ends[first[i + 1] - 1], in
// the order in which they were seen.
struct Neighbours {
  std::vector<int> first;  // of each node, and the end
  std::vector<Neighbour> ends;
  RepeatedValues<PlainLaw> laws;

  int nodes() const { return static_cast<int>(first.size()) - 1; }
  int count(int node) const { return first[node + 1] - first[node]; }
};

// Sorts ends of springs by their nodes, by counting. for_each_end(see) calls see(node, point, law)
// for all ends, twice in the same order. It should visit both ends of a spring in a row: that reads
// each law once, and stores those that differ once.
template <class ForEachEnd>
Neighbours neighbours_of(int nodes, const ForEachEnd& for_each_end) {
  Neighbours result;
  result.first.assign(static_cast<std::size_t>(nodes) + 1, 0);
  for_each_end([&](int node, int, const PlainLaw&) { ++result.first[node + 1]; });
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.ends.resize(static_cast<std::size_t>(result.first.back()));
  std::vector<int> next(result.first.begin(), result.first.end() - 1);
  for_each_end([&](int node, int point, const PlainLaw& law) {
    result.ends[next[node]++] = {point, result.laws.number(law)};
  });
  return result;
}

}  // namespace qddot::kernels
