// Implicit Runge-Kutta methods of constant step by ARKODE, from tables written down here. So
// SUNDIALS' run of a formula can be laid over a hand-written one. With y = (q, v) and
// F(y) = (v, M^-1 f(q)):
//   Y_i     = y_n + h sum_{j<=i} a_ij F(Y_j),   i = 1 ... s
//   y_{n+1} = y_n + h sum_{i<=s} b_i F(Y_i)
// The tables have c_i on the left, a_ij on the right and b_i below:
//   implicit Euler   1 | 1          implicit midpoint   1/2 | 1/2
//                      | 1                                  | 1
//   SDIRK, g = 1 - 1/sqrt 2         TR-BDF2, g = 2 - sqrt 2, w = sqrt 2 / 4
//   g | g                           0 | 0
//   1 | 1-g  g                      g | g/2  g/2
//     | 1-g  g                      1 | w    w    g/2
//                                     | w    w    g/2
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "integrators/sundials/arkode.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

// The full rows of A; b is the last row unless another is given.
ButcherTable table_of(int order, std::vector<double> c, std::vector<double> a,
                      std::vector<double> b) {
  return ButcherTable(check(ARKodeButcherTable_Create(static_cast<int>(b.size()), order, 0,
                                                      c.data(), a.data(), b.data(), nullptr)));
}

ButcherTable implicit_euler_table() { return table_of(1, {1}, {1}, {1}); }
ButcherTable implicit_midpoint_table() { return table_of(2, {0.5}, {0.5}, {1}); }
ButcherTable sdirk2_table() {
  const double g = 1 - 1 / std::sqrt(2.0);
  return table_of(2, {g, 1}, {g, 0, 1 - g, g}, {1 - g, g});
}
ButcherTable trbdf2_table() {
  const double g = 2 - std::sqrt(2.0), w = std::sqrt(2.0) / 4;
  return table_of(2, {0, g, 1}, {0, 0, 0, g / 2, g / 2, 0, w, w, g / 2}, {w, w, g / 2});
}

template <ButcherTable (*make_table)()>
class FixedTable final : public Arkode {
 public:
  explicit FixedTable(SystemRun& run)
      : Arkode(run, {.implicit_table = make_table().get()}, nullptr, right_hand_side,
               make_structured, run.system()) {}
};

template <ButcherTable (*make_table)()>
Method fixed(const char* name, int order, const char* what, const char* source) {
  return {.name = name,
          .summary = fmt::format("SUNDIALS ARKODE, {} of constant step, n x n solves", what),
          .source = source,
          .order = order,
          .family = Family::sundials,
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::stiffness},
          .takes = {Option::solver},
          .damped = Damped::by_any,
          .make = create_steps<FixedTable<make_table>>};
}

}  // namespace

Method arkode_implicit_euler() {
  return fixed<implicit_euler_table>("arkode_implicit_euler", 1, "backward Euler",
                                     "Hairer and Wanner, Solving ODEs II, section IV.1");
}

Method arkode_implicit_midpoint() {
  Method method = fixed<implicit_midpoint_table>(
      "arkode_implicit_midpoint", 2, "the implicit midpoint rule",
      "Hairer, Lubich and Wanner, Geometric Numerical Integration, section I.1.2");
  method.traits = method.traits.with(Trait::symplectic).with(Trait::reversible);
  return method;
}

Method arkode_sdirk2() {
  return fixed<sdirk2_table>("arkode_sdirk2", 2, "Alexander's L-stable SDIRK",
                             "Alexander, SIAM J. Numerical Analysis 14:6 (1977) 1006-1021");
}

Method arkode_trbdf2() {
  return fixed<trbdf2_table>("arkode_trbdf2", 2, "TR-BDF2",
                             "Hosea and Shampine, Applied Numerical Mathematics 20 (1996) 21-37");
}

}  // namespace qddot::registered
