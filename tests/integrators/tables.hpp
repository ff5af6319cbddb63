#pragma once

#include <vector>

#include "tests/integrators/runs.hpp"

namespace qddot {
inline namespace tests {

// A method and the coefficients that it steps by.
template <class Table>
struct WithTable {
  std::string name;
  const Table& table;
};

// The registry's methods with such coefficients, a member of Method; but for those with rods.
template <class Table>
std::vector<WithTable<Table>> methods_with_tables(const Table* Method::*coefficients) {
  std::vector<WithTable<Table>> list;
  for (const Method& method : unconstrained_methods()) {
    if (const Table* table = method.*coefficients) list.push_back({method.name, *table});
  }
  BOOST_REQUIRE(!list.empty());
  return list;
}

}  // namespace tests
}  // namespace qddot
