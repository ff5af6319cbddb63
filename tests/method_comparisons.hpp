#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace qddot {
inline namespace tests {

// The results of comparing methods with known motions, and the orders that halved steps show.
struct MethodComparisons {
  using Lists = std::map<std::string, std::vector<double>>;  // by method

  std::int64_t runs = 0, refused = 0;
  std::vector<std::string> disagreements{};  // a sentence each
  Lists orders{};
  // Errors of methods that choose their steps, in tolerances times growths.
  Lists tolerances{};
  // The largest errors of rods' lengths and rates, on scenes with rods.
  Lists stretches{};

  MethodComparisons& operator+=(const MethodComparisons& more) {
    runs += more.runs;
    refused += more.refused;
    disagreements.insert(disagreements.end(), more.disagreements.begin(), more.disagreements.end());
    add(more.orders, orders);
    add(more.tolerances, tolerances);
    add(more.stretches, stretches);
    return *this;
  }

 private:
  static void add(const Lists& more, Lists& all) {
    for (const auto& [name, own] : more) all[name].insert(all[name].end(), own.begin(), own.end());
  }
};

}  // namespace tests
}  // namespace qddot
