#pragma once

#include <utility>
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

// The registry's methods whose integrators are of the class Stepper, with their coefficients.
template <class Stepper>
auto methods_with_tables() {
  using Table = std::remove_cvref_t<decltype(std::declval<const Stepper&>().table())>;
  const auto system = make_mass_spring(Oscillator{}.problem().network);
  std::vector<WithTable<Table>> list;
  for (const Method& method : methods()) {
    const auto integrator = make_integrator(method, *system, options_of(method, 1e-3, 1e-3));
    if (const auto* stepper = dynamic_cast<const Stepper*>(integrator.get()))
      list.push_back({method.name, stepper->table()});
  }
  BOOST_REQUIRE(!list.empty());
  return list;
}

}  // namespace tests
}  // namespace qddot
