#pragma once

#include <cstdio>  // missing in the headers of ARKODE 6

#include <arkode/arkode_butcher_dirk.h>
#include <arkode/arkode_butcher_erk.h>

namespace qddot::sundials {

// ARKODE's pairs of tables of order 3, 4 and 5 that treat one part of y' explicitly and the other
// implicitly. (Kennedy and Carpenter, Applied Numerical Mathematics 44 (2003) 139-181.)
struct AdditiveTable {
  int order;
  ARKODE_ERKTableID explicit_id;
  ARKODE_DIRKTableID implicit_id;
  const char* name;
  // The largest h w_f at which no vibration q'' = -(w_f^2 + w_s^2) q grows by more than a
  // thousandth a step, w_f explicit, any w_s. It is rounded down to hundredths.
  double limit;
};
inline constexpr AdditiveTable additive_tables[] = {
    {3, ARKODE_ARK324L2SA_ERK_4_2_3, ARKODE_ARK324L2SA_DIRK_4_2_3, "ARK324L2SA", 0.44},
    {4, ARKODE_ARK436L2SA_ERK_6_3_4, ARKODE_ARK436L2SA_DIRK_6_3_4, "ARK436L2SA", 0.45},
    {5, ARKODE_ARK548L2SA_ERK_8_4_5, ARKODE_ARK548L2SA_DIRK_8_4_5, "ARK548L2SA", 1.17}};

}  // namespace qddot::sundials
