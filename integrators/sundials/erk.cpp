// ARKODE's adaptive explicit Runge-Kutta methods of order 2 to 8. With y = (q, v),
// F(y) = (v, M^-1 f(q)) and the coefficients a_ij and b_i of the named table:
//   Y_i     = y_n + h sum_{j<i} a_ij F(Y_j),   i = 1 ... s
//   y_{n+1} = y_n + h sum_{i<=s} b_i F(Y_i)
// Other weights of the same table estimate the error, and the next step size follows from it.
//
// If the system has a K, steps are held to h <= c/w_max, with the table's own stability limit c
// on vibrations. The error test alone would miss vibrations that grow but are still small.
#include <fmt/format.h>

#include "integrators/sundials/arkode.hpp"
#include "integrators/sundials/imaginary_stability.hpp"
#include "integrators/sundials/prince_dormand.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

struct ExplicitTable {
  int order;
  ARKODE_ERKTableID id;  // none: prince_dormand_8_7()
  const char* name;
  const char* source;
};
constexpr ExplicitTable explicit_tables[] = {
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

ButcherTable table_of(const ExplicitTable& which) {
  if (which.id == ARKODE_ERK_NONE) return prince_dormand_8_7();
  return ButcherTable(check(ARKodeButcherTable_LoadERK(which.id)));
}

template <int which>
class Erk final : public Arkode {
 public:
  explicit Erk(SystemRun& run) : Erk(run, table_of(explicit_tables[which])) {}

 private:
  Erk(SystemRun& run, ButcherTable table)
      : Arkode(run, {.explicit_table = table.get()}, right_hand_side, nullptr, nullptr,
               run.system()) {
    limit_steps(system(), imaginary_stability(*table));
  }
};

template <int which>
Method erk() {
  const ExplicitTable& table = explicit_tables[which];
  return {.name = fmt::format("arkode_erk{}", table.order),
          .summary = fmt::format("SUNDIALS ARKODE, adaptive explicit of order {}, {}, "
                                 "steps held to 1/w_max",
                                 table.order, table.name),
          .source = table.source,
          .order = table.order,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::bounds_steps},
          .make = create_steps<Erk<which>>};
}

}  // namespace

Method arkode_erk2() { return erk<0>(); }
Method arkode_erk3() { return erk<1>(); }
Method arkode_erk4() { return erk<2>(); }
Method arkode_erk5() { return erk<3>(); }
Method arkode_erk6() { return erk<4>(); }
Method arkode_erk8() { return erk<5>(); }

}  // namespace qddot::registered
