#include "qddot/scene/reduce/springs.hpp"

#include <algorithm>
#include <tuple>

#include "qddot/model/grouped.hpp"

namespace qddot::reduce {
namespace {

std::size_t low(const Spring& spring) { return std::min(spring.nodes[0], spring.nodes[1]); }
std::size_t high(const Spring& spring) { return std::max(spring.nodes[0], spring.nodes[1]); }

bool acts(const Spring& spring) {
  return spring.law.stiffness > 0 || spring.law.quartic > 0 || spring.law.damping > 0 ||
         !spring.law.is_plain();
}

// Springs with the same lower node and the same key may be added.
auto key(const Spring& spring) {
  return std::tuple(high(spring), spring.law.rest_length, spring.holds);
}

// For each spring that is the first of its key, the sum; else a spring without stiffness.
std::vector<Spring> sums_of(const std::vector<Spring>& springs, const Grouped& by_low) {
  std::vector<Spring> sums = springs;
  for (Spring& sum : sums) {
    if (sum.law.is_plain()) sum.law.stiffness = sum.law.quartic = sum.law.damping = 0;
  }
  std::vector<int> order;
  for (int node = 0; node < by_low.groups(); ++node) {
    order.assign(by_low[node].begin(), by_low[node].end());
    const auto spring = [&](int e) -> const Spring& {
      return springs[static_cast<std::size_t>(e)];
    };
    std::erase_if(order, [&](int e) { return !spring(e).law.is_plain(); });
    std::ranges::stable_sort(order, {}, [&](int e) { return key(spring(e)); });
    for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
      if (key(spring(order[i])) != key(spring(order[first]))) first = i;
      Spring& sum = sums[static_cast<std::size_t>(order[first])];
      const Spring& next = spring(order[i]);
      sum.law.stiffness += next.law.stiffness;
      sum.law.quartic += next.law.quartic;
      sum.law.damping += next.law.damping;
      sum.stiff = sum.stiff || next.stiff;
    }
  }
  return sums;
}

}  // namespace

std::optional<std::vector<Spring>> merged_springs(const std::vector<Spring>& springs,
                                                  std::size_t nodes) {
  const auto low_of = [&](int e) {
    return static_cast<int>(low(springs[static_cast<std::size_t>(e)]));
  };
  const auto high_of = [&](int e) {
    return static_cast<int>(high(springs[static_cast<std::size_t>(e)]));
  };
  const Grouped by_low(static_cast<int>(nodes), static_cast<int>(springs.size()), low_of);
  const bool has_equal = any_share_both_ends(by_low, high_of);
  if (!has_equal && std::ranges::all_of(springs, acts)) return {};
  std::vector<Spring> merged = has_equal ? sums_of(springs, by_low) : springs;
  std::erase_if(merged, [](const Spring& spring) { return !acts(spring); });
  if (merged.size() == springs.size()) return {};  // other lengths, so that none were added
  return merged;
}

}  // namespace qddot::reduce
