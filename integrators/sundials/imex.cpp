// ARKODE's adaptive additive Runge-Kutta methods for scenes that name their stiff springs. With
// y = (q, v), y' = g(y) + e(y) and the two tables a and a* of the named pair:
//   g = (v, M^-1 f_stiff(q)) implicit,   e = (0, M^-1 f_soft(q)) explicit
//   Y_i     = y_n + h sum_{j<=i} a_ij g(Y_j) + h sum_{j<i} a*_ij e(Y_j),   i = 1 ... s
//   y_{n+1} = y_n + h sum_{i<=s} b_i (g(Y_i) + e(Y_i))
// Other weights of the same pair estimate the error, and the next step size follows from it.
//
// Newton's matrix M - (h a_ii)^2 K_stiff couples the nodes of stiff springs alone. All of q' = v is
// implicit. That costs nothing where no stiff spring pulls, and a stiff vibration is only damped if
// both of its halves are implicit.
//
// As those of explicit methods, steps are held to what the soft springs allow. The error test sees
// a growing vibration only when it is as large as the tolerance, and then again and again.
#include <fmt/format.h>

#include "integrators/sundials/additive_tables.hpp"
#include "integrators/sundials/arkode.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

template <int order>
class Imex final : public Arkode {
  static constexpr AdditiveTable table = additive_tables[order - 3];

 public:
  explicit Imex(SystemRun& run)
      : Arkode(run,
               {.explicit_table =
                    ButcherTable(check(ARKodeButcherTable_LoadERK(table.explicit_id))).get(),
                .implicit_table =
                    ButcherTable(check(ARKodeButcherTable_LoadDIRK(table.implicit_id))).get()},
               soft_rate, stiff_rate, make_structured, stiff_of(run.system())),
        stiff_(stiff_of(run.system())),
        soft_(soft_of(run.system())) {
    limit_steps(soft_, table.limit);
  }

 private:
  static int soft_rate(double t, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<Imex*>(static_cast<Library*>(user));
    return self.guarded([&] {
      const bool is_finite = self.set_rate(self.soft_, t, y, rate);
      Halves(rate).q.setZero();
      return is_finite;
    });
  }
  static int stiff_rate(double t, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<Imex*>(static_cast<Library*>(user));
    return self.guarded([&] { return self.set_rate(self.stiff_, t, y, rate); });
  }

  const System &stiff_, &soft_;
};

template <int order>
Method imex() {
  static_assert(additive_tables[order - 3].order == order);
  return {.name = fmt::format("arkode_imex{}", order),
          .summary = fmt::format("SUNDIALS ARKODE, adaptive IMEX of order {}, ARKODE_{}: stiff "
                                 "springs implicit, n x n solves",
                                 order, additive_tables[order - 3].name),
          .source = "Kennedy and Carpenter, Applied Numerical Mathematics 44 (2003) 139-181",
          .order = order,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::stiffness, Need::split_forces},
          .takes = {Option::solver},
          .why_not_damped = "its explicit half has no place for dashpots",
          .make = create_steps<Imex<order>>};
}

}  // namespace

Method arkode_imex3() { return imex<3>(); }
Method arkode_imex4() { return imex<4>(); }
Method arkode_imex5() { return imex<5>(); }

}  // namespace qddot::registered
