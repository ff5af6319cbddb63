#pragma once

#include "qddot/model/kernels/vectors/roots.hpp"
#include "qddot/model/kernels/vectors/slots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// tau of one slot's springs of lengths l.
template <int law_vectors>
[[gnu::always_inline]] inline Lanes tension(Lanes l, const Law& law) {
  const Lanes s = l - load(law.rest_length);
  if constexpr (law_vectors == 2) return s * load(law.stiffness);
  return s * (load(law.stiffness) + load(law.quartic) * (s * s));
}

// tau/l of the springs of several slots, whose squared lengths are l2; 0 where l = 0, as in
// spring.hpp. Each operation is done for all slots before the next: so a processor that sees few
// instructions at a time still finds some that do not wait for each other.
template <int law_vectors, Roots roots, int count>
[[gnu::always_inline]] inline void tensions_by_length(const Lanes (&l2)[count],
                                                      const Law (&law)[count], Range& range,
                                                      Lanes (&ratio)[count]) {
  if constexpr (law_vectors == 1) {
    for (int i = 0; i < count; ++i) ratio[i] = load(law[i].stiffness);
  } else if constexpr (roots == Roots::processor) {
    unroll<count>([&]<int i>() __attribute__((always_inline)) {
      const Lanes l = square_root(l2[i]), quotient = tension<law_vectors>(l, law[i]) / l;
      ratio[i] = l > 0 ? quotient : Lanes{};
    });
  } else {
    Lanes l[count], half_inverse[count];
    unroll<count>([&]<int i>() __attribute__((always_inline)) { range.add(l2[i]); });
    estimated_roots(l2, l, half_inverse);
    unroll<count>([&]<int i>() __attribute__((always_inline)) {
      const Lanes t = tension<law_vectors>(l[i], law[i]);
      // The processor divides three of four and is busy with them, so one quotient is estimated.
      constexpr bool divides = roots == Roots::estimated_root && (i > 0 || count < 4);
      ratio[i] = divides ? t / l[i] : estimated_quotient(t, l[i], half_inverse[i]);
    });
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
