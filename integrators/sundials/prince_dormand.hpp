#pragma once

#include <algorithm>
#include <vector>

#include "integrators/sundials/arkode.hpp"
#include "qddot/integrators/base/prince_dormand_pair.hpp"

namespace qddot::sundials {

// The pair of Prince and Dormand as a table of ARKODE. ARKODE's own pair of that order, Fehlberg's,
// has the error estimate 41/840 h (k_1 + k_11 - k_12 - k_13) with c_1 = c_12 and c_11 = c_13. That
// is zero for y' = F(t), whatever F is (Hairer, Norsett and Wanner, Solving ODEs I, section II.5).
// The force on a mass that flies fast past another is such a function of time.
inline ButcherTable prince_dormand_8_7() {
  constexpr int s = 13;
  ExplicitPair pair = prince_dormand_pair();
  std::vector<double> a(s * s);
  for (auto at = a.begin(); const auto& row : pair.a) {
    std::ranges::copy(row, at);
    at += s;
  }
  return ButcherTable(check(ARKodeButcherTable_Create(s, 8, 7, pair.c.data(), a.data(),
                                                      pair.b.data(), pair.lower.data())));
}

}  // namespace qddot::sundials
