#include "qddot/model/kernels/vectors/roots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {

bool roots_and_quotients(Roots roots, const double* a, const double* t, double* root,
                         double* quotient, std::ptrdiff_t n);
bool roots_and_quotients(Roots roots, const double* a, const double* t, double* root,
                         double* quotient, std::ptrdiff_t n) {
  if (roots != Roots::processor && !has_estimates) return false;
  for (std::ptrdiff_t i = 0; i < n; i += lanes) {
    if (roots == Roots::processor) {
      const Lanes l = square_root(load(a + i));
      store(root + i, l);
      store(quotient + i, load(t + i) / l);
    } else {
      const Lanes number[] = {load(a + i)};
      Lanes roots_of[1], half_inverses[1];
      estimated_roots(number, roots_of, half_inverses);
      const Lanes l = roots_of[0], half_inverse = half_inverses[0];
      store(root + i, l);
      store(quotient + i, roots == Roots::estimated
                              ? estimated_quotient(load(t + i), l, half_inverse)
                              : load(t + i) / l);
    }
  }
  return true;
}

}  // namespace qddot::kernels::QDDOT_LEVEL
