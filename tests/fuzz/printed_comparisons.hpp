#pragma once

#include <algorithm>

#include <fmt/format.h>

#include "qddot/integrators/registry.hpp"
#include "tests/method_comparisons.hpp"

namespace qddot {
inline namespace tests {

// Prints the orders of all methods. Returns how many methods show another order than their own with
// halved steps, in the middle of all scenes.
inline std::int64_t print_orders(const MethodComparisons& all) {
  std::int64_t wrong = 0;
  for (auto [name, orders] : all.orders) {
    std::ranges::sort(orders);
    const double middle = orders[orders.size() / 2], low = orders[orders.size() / 10];
    const int order = find_method(name)->order;
    // Few scenes have no middle; errors of high orders are soon near rounding.
    const bool is_wrong = orders.size() > 20 && middle < order - (order > 4 ? 1.5 : 0.5);
    wrong += is_wrong;
    fmt::print(
        "{:<20} order {:>2}: {:>5.2f} in the middle, {:>5.2f} of the lowest tenth, {} runs{}\n",
        name, order, middle, low, orders.size(), is_wrong ? "  WRONG" : "");
  }
  return wrong;
}

// Prints the middle, the highest tenth and the largest of numbers by method.
inline void print_sizes(const MethodComparisons::Lists& all, const char* sentence) {
  for (auto [name, sizes] : all) {
    std::ranges::sort(sizes);
    fmt::print(
        "{:<20} {} {:.2g} in the middle, {:.2g} of the highest tenth, {:.2g} at most, {} runs\n",
        name, sentence, sizes[sizes.size() / 2], sizes[sizes.size() - 1 - sizes.size() / 10],
        sizes.back(), sizes.size());
  }
}

}  // namespace tests
}  // namespace qddot
