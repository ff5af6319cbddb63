#include "qddot/model/kernels/force_kernel.hpp"

namespace qddot::kernels {
namespace {

// tau/l of one slot's springs, whose squared lengths are l2; 0 where l = 0, as in spring.hpp.
template <int law_vectors>
[[gnu::always_inline]] inline Lanes tension_by_length(Lanes l2, const double* law) {
  const Lanes stiffness = load(law);
  if constexpr (law_vectors == 1) {
    return stiffness;
  } else {
    const Lanes l = square_root(l2), s = l - load(law + lanes);
    Lanes tension = s * stiffness;
    if constexpr (law_vectors == 3) tension = s * (stiffness + load(law + 2 * lanes) * (s * s));
    const Lanes ratio = tension / l;
    return l > 0 ? ratio : Lanes{};
  }
}

// The force of one slot's springs on a line: there l is |d|, and neither root nor division is
// needed; 0 where d = 0, as in spring.hpp.
template <int law_vectors>
[[gnu::always_inline]] inline Lanes force_on_line(Lanes d, const double* law) {
  const Lanes stiffness = load(law);
  if constexpr (law_vectors == 1) {
    return stiffness * d;
  } else {
    const Lanes rest_length = load(law + lanes);
    const Lanes s = d - (d > 0 ? rest_length : -rest_length);
    Lanes force = s * stiffness;
    if constexpr (law_vectors == 3) force = s * (stiffness + load(law + 2 * lanes) * (s * s));
    return d != 0 ? force : Lanes{};
  }
}

// f = offset + sum of a slice's rows.
template <int D>
[[gnu::always_inline]] inline void put(const SpringsByNode<D>& springs, int slice,
                                       const Lanes (&sum)[D], const Vec& offset, Vec& f) {
  using Order = typename SpringsByNode<D>::Order;
  const int row = slice * lanes;
  const Order order = springs.order(slice);
  if (order == Order::by_slice) {
    const int first = springs.unknowns(row)[0];
    return interleave<D>(sum, offset.data() + first, f.data() + first);
  }
  double sums[D][lanes];
  for (int a = 0; a < D; ++a) store(sums[a], sum[a]);
  for (int t = 0; t < lanes; ++t) {
    const auto& unknowns = springs.unknowns(row + t);
    for (int a = 0; a < D; ++a) {
      const int unknown = order == Order::by_row ? unknowns[0] + a : unknowns[a];
      if (unknown >= 0) f[unknown] = offset[unknown] + sums[a][t];
    }
  }
}

template <int D, int law_vectors>
void sum_forces_of(const SpringsByNode<D>& springs, const Vec& q, const Vec& offset, Vec& f) {
  springs.for_slices(q, [&](int slice, const auto& positions) {
    Lanes sum[D] = {};
    springs.template for_slots<law_vectors>(
        slice, positions, [&](int, const Lanes(&d)[D], Lanes l2, const double* law) {
          if constexpr (D == 1) {
            sum[0] += force_on_line<law_vectors>(d[0], law);
          } else {
            const Lanes ratio = tension_by_length<law_vectors>(l2, law);
            for (int a = 0; a < D; ++a) sum[a] += ratio * d[a];
          }
        });
    put(springs, slice, sum, offset, f);
  });
}

}  // namespace

template <int D>
void sum_forces(const SpringsByNode<D>& springs, const Vec& q, const Vec& offset, Vec& f) {
  switch (springs.slices().law_vectors) {
    case 1:
      return sum_forces_of<D, 1>(springs, q, offset, f);
    case 2:
      return sum_forces_of<D, 2>(springs, q, offset, f);
    default:
      return sum_forces_of<D, 3>(springs, q, offset, f);
  }
}

template void sum_forces<1>(const SpringsByNode<1>&, const Vec&, const Vec&, Vec&);
template void sum_forces<2>(const SpringsByNode<2>&, const Vec&, const Vec&, Vec&);
template void sum_forces<3>(const SpringsByNode<3>&, const Vec&, const Vec&, Vec&);

}  // namespace qddot::kernels
