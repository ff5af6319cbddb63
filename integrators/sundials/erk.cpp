// ARKODE's adaptive explicit Runge-Kutta methods of order 2 to 8. With y = (q, v),
// F(y) = (v, M^-1 f(q)) and the coefficients a_ij and b_i of the named table:
//   Y_i     = y_n + h sum_{j<i} a_ij F(Y_j),   i = 1 ... s
//   y_{n+1} = y_n + h sum_{i<=s} b_i F(Y_i)
// Other weights of the same table estimate the error, and the next step size follows from it.
//
// If the system has a K, steps are held to h <= c/w_max, with the table's own stability limit c
// on vibrations. The error test alone would miss vibrations that grow but are still small.
#include <fmt/format.h>

#include "integrators/sundials/explicit_tables.hpp"
#include "integrators/sundials/imaginary_stability.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

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
