#include "qddot/scene/reduce/springs.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace qddot::reduce {
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

  std::vector<Spring> sums(springs.size());  // at the first spring of each key, else without law
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (i == 0 || key(springs[order[i]]) != key(springs[order[first]])) first = i;
    Spring& sum = sums[order[first]];
    const Spring& next = springs[order[i]];
    sum.law.rest_length = next.law.rest_length;
    sum.law.stiffness += next.law.stiffness;
    sum.law.quartic += next.law.quartic;
    sum.stiff = sum.stiff || next.stiff;
  }

  std::vector<Spring> merged;
  merged.reserve(springs.size());
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const auto& law = sums[i].law;
    if (law.stiffness > 0 || law.quartic > 0)
      merged.push_back({springs[i].nodes, law, springs[i].holds, sums[i].stiff});
  }
  return merged;
}

}  // namespace qddot::reduce
