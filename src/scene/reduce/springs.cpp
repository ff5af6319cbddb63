#include "src/scene/reduce/springs.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace qddot {
namespace {

// Springs with the same key may be added.
auto key(const Spring& spring) {
  const auto [low, high] = std::minmax(spring.nodes[0], spring.nodes[1]);
  return std::tuple(low, high, spring.law.rest_length, spring.holds);
}

}  // namespace

std::vector<Spring> merged_springs(const std::vector<Spring>& springs) {
  std::vector<std::size_t> order(springs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(springs[a]) < key(springs[b]); });

  std::vector<SpringLaw> sums(springs.size());  // at the first spring of each key, else zero
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (i == 0 || key(springs[order[i]]) != key(springs[order[first]])) first = i;
    SpringLaw& sum = sums[order[first]];
    const SpringLaw& law = springs[order[i]].law;
    sum.rest_length = law.rest_length;
    sum.stiffness += law.stiffness;
    sum.quartic += law.quartic;
  }

  std::vector<Spring> merged;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (sums[i].stiffness > 0 || sums[i].quartic > 0)
      merged.push_back({springs[i].nodes, sums[i], springs[i].holds});
  }
  return merged;
}

}  // namespace qddot
