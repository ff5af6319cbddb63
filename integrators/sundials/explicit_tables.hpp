#pragma once

#include "integrators/sundials/arkode.hpp"
#include "integrators/sundials/prince_dormand.hpp"

namespace qddot::sundials {

// The tables of ARKODE's adaptive explicit Runge-Kutta methods, and the publication of each.
struct ExplicitTable {
  int order;
  ARKODE_ERKTableID id;  // none: prince_dormand_8_7()
  const char* name;
  const char* source;
};
inline constexpr ExplicitTable explicit_tables[] = {
    {2, ARKODE_HEUN_EULER_2_1_2, "ARKODE_HEUN_EULER_2_1_2", "Heun's method with Euler's inside it"},
    {3, ARKODE_BOGACKI_SHAMPINE_4_2_3, "ARKODE_BOGACKI_SHAMPINE_4_2_3",
     "Bogacki and Shampine, Applied Mathematics Letters 2:4 (1989) 321-325"},
    {4, ARKODE_ZONNEVELD_5_3_4, "ARKODE_ZONNEVELD_5_3_4",
     "Zonneveld (1963); Hairer, Norsett and Wanner, Solving ODEs I, table II.4.2"},
    {5, ARKODE_DORMAND_PRINCE_7_4_5, "ARKODE_DORMAND_PRINCE_7_4_5",
     "Dormand and Prince, J. Computational and Applied Mathematics 6 (1980) 19-26"},
    {6, ARKODE_VERNER_8_5_6, "ARKODE_VERNER_8_5_6",
     "Verner, SIAM J. Numerical Analysis 15:4 (1978) 772-790"},
    {8, ARKODE_ERK_NONE, "with the pair RK8(7)13M",
     "Prince and Dormand, J. Computational and Applied Mathematics 7 (1981) 67-75"}};

inline ButcherTable table_of(const ExplicitTable& which) {
  if (which.id == ARKODE_ERK_NONE) return prince_dormand_8_7();
  return ButcherTable(check(ARKodeButcherTable_LoadERK(which.id)));
}

}  // namespace qddot::sundials
