// ARKODE's additive Runge-Kutta methods for scenes that name their stiff springs: with
// y' = g(y) + e(y),
//   g = (v, M^-1 f_stiff(q)) implicit,   e = (0, M^-1 f_soft(q)) explicit,
// so that Newton's matrix M - gamma^2 K_stiff couples the nodes of stiff springs alone. All of
// q' = v is implicit: it costs nothing where no stiff spring pulls, and a stiff vibration is only
// damped if both of its halves are. (Kennedy and Carpenter, Applied Numerical Mathematics 44 (2003)
// 139-181.) As those of explicit methods, steps are held to what the soft springs allow: the error
// test sees a vibration grow only where it is as large as the tolerance, and then again and again.
#include <fmt/format.h>

#include "integrators/registry.hpp"
#include "integrators/sundials/arkode.hpp"

namespace qddot {
namespace {

using namespace sundials;

struct Pair {
  int order;
  ARKODE_ERKTableID explicit_id;
  ARKODE_DIRKTableID implicit_id;
  const char* name;
  // The largest h w_f at which no vibration q'' = -(w_f^2 + w_s^2) q, w_f explicit, whatever w_s
  // is, grows by more than a thousandth a step; rounded down.
  double limit;
};
constexpr Pair pairs[] = {
    {3, ARKODE_ARK324L2SA_ERK_4_2_3, ARKODE_ARK324L2SA_DIRK_4_2_3, "ARK324L2SA", 0.44},
    {4, ARKODE_ARK436L2SA_ERK_6_3_4, ARKODE_ARK436L2SA_DIRK_6_3_4, "ARK436L2SA", 0.45},
    {5, ARKODE_ARK548L2SA_ERK_8_4_5, ARKODE_ARK548L2SA_DIRK_8_4_5, "ARK548L2SA", 1.17}};

template <int order>
class Imex final : public Arkode {
  static constexpr Pair pair = pairs[order - 3];

 public:
  Imex(const Method& method, const System& system, const Knobs& knobs)
      : Arkode(method, system, knobs,
               {.explicit_table =
                    ButcherTable(check(ARKodeButcherTable_LoadERK(pair.explicit_id))).get(),
                .implicit_table =
                    ButcherTable(check(ARKodeButcherTable_LoadDIRK(pair.implicit_id))).get()},
               soft_rate, stiff_rate, make_structured, stiff_of(system)) {
    limit_steps(soft_of(system), pair.limit);
  }

 private:
  static int soft_rate(double, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<Imex*>(static_cast<Stepper*>(user));
    return self.guarded([&] {
      const bool is_finite = self.set_rate(*self.system().split()->soft, y, rate);
      Halves(rate).q.setZero();
      return is_finite;
    });
  }
  static int stiff_rate(double, N_Vector y, N_Vector rate, void* user) {
    auto& self = *static_cast<Imex*>(static_cast<Stepper*>(user));
    return self.guarded([&] { return self.set_rate(*self.system().split()->stiff, y, rate); });
  }
};

template <int order>
Method imex() {
  static_assert(pairs[order - 3].order == order);
  return {.name = fmt::format("arkode_imex{}", order),
          .summary = fmt::format("SUNDIALS ARKODE, adaptive IMEX of order {}, ARKODE_{}: stiff "
                                 "springs implicit, n x n solves",
                                 order, pairs[order - 3].name),
          .source = "Kennedy and Carpenter, Applied Numerical Mathematics 44 (2003) 139-181",
          .order = order,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .implicit = true,
          .needs_stiffness = true,
          .needs_split = true,
          .make = create<Imex<order>>};
}

}  // namespace

Method arkode_imex3() { return imex<3>(); }
Method arkode_imex4() { return imex<4>(); }
Method arkode_imex5() { return imex<5>(); }

}  // namespace qddot
