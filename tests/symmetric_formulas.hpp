#pragma once

#include <vector>

#include "integrators/methods/tables.hpp"

namespace qddot {
inline namespace tests {

// The registry's symmetric formulas, and where their spurious roots are to be.
struct NamedFormula {
  const char* name;
  const SymmetricFormula& formula;
  std::vector<double> cosines;
};
inline const std::vector<NamedFormula>& symmetric_formulas() {
  static const std::vector<NamedFormula> all = {
      {"symmetric4", registered::symmetric4_formula(), {0.25}},
      {"symmetric6", registered::symmetric6_formula(), {0.05, -0.5}},
      {"symmetric8", registered::symmetric8_formula(), {0.5, 0, -0.5}},
      {"symmetric10", registered::symmetric10_formula(), {0.65, 0.4, -0.2, -0.5}}};
  return all;
}

}  // namespace tests
}  // namespace qddot
