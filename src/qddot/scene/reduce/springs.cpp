#include "qddot/scene/reduce/springs.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>

namespace qddot::reduce {
namespace {

// Springs with the same key may be added.
auto key(const Spring& spring) {
  const auto [low, high] = std::minmax(spring.nodes[0], spring.nodes[1]);
  return std::tuple(low, high, spring.law.rest_length, spring.holds);
}

// Whether two springs have the same two nodes, without an order of all springs.
bool any_share_both_nodes(const std::vector<Spring>& springs) {
  std::size_t nodes = 0;
  for (const Spring& spring : springs)
    nodes = std::max({nodes, spring.nodes[0] + 1, spring.nodes[1] + 1});
  std::vector<std::size_t> begin(nodes + 1, 0);
  const auto ends = [](const Spring& spring) {
    return std::minmax(spring.nodes[0], spring.nodes[1]);
  };
  for (const Spring& spring : springs) ++begin[ends(spring).first + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::size_t> high(springs.size()), place(begin.begin(), begin.end() - 1);
  for (const Spring& spring : springs) high[place[ends(spring).first]++] = ends(spring).second;
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto from = high.begin() + static_cast<std::ptrdiff_t>(begin[i]),
               end = high.begin() + static_cast<std::ptrdiff_t>(begin[i + 1]);
    std::sort(from, end);
    if (std::adjacent_find(from, end) != end) return true;
  }
  return false;
}

}  // namespace

std::vector<Spring> merged_springs(const std::vector<Spring>& springs) {
  const auto acts = [](const SpringLaw& law) { return law.stiffness > 0 || law.quartic > 0; };
  if (!any_share_both_nodes(springs)) {
    std::vector<Spring> all;
    all.reserve(springs.size());
    std::ranges::copy_if(springs, std::back_inserter(all), acts, &Spring::law);
    return all;
  }
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
    if (acts(sums[i].law))
      merged.push_back({springs[i].nodes, sums[i].law, springs[i].holds, sums[i].stiff});
  }
  return merged;
}

}  // namespace qddot::reduce
