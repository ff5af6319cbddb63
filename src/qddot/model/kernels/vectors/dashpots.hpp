#pragma once

#include "qddot/model/kernels/vectors/put.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// f = offset + the forces of the rows' dashpots. One between x_i and x_j with the constant c, which
// stands in the place of a spring's stiffness, adds
//   c (d.w)/|d|^2 d,   w = v_j - v_i,
// which needs no root; or c w on a line, for a spring of rest length zero, and at length zero.
template <int D, int law_vectors>
void sum_dashpots(const SpringTable& springs, const Positions& positions,
                  const Positions& velocities, const Offset& offset, double* f, int from, int end) {
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice;
    Lanes sum[D];
    for (int a = 0; a < D; ++a) sum[a] = Lanes{};
    for_slots_of_two<D>(
        springs, slice, part, positions, velocities,
        [&](const Lanes(&d)[D], const Lanes(&w)[D], const Law& law) __attribute__((always_inline)) {
          const Lanes c = load(law.stiffness);
          if constexpr (D == 1 || law_vectors == 1) {
            for (int a = 0; a < D; ++a) sum[a] += c * w[a];
          } else {
            const Lanes square = squared_length<D>(d), rest_length = load(law.rest_length);
            Lanes product = d[0] * w[0];
            for (int a = 1; a < D; ++a) product += d[a] * w[a];
            const Lanes quotient = c * product / square;
            const Lanes directed = rest_length > 0 ? square : Lanes{};
            const Lanes along = directed > 0 ? quotient : Lanes{};
            const Lanes around = directed > 0 ? Lanes{} : c;
            for (int a = 0; a < D; ++a) sum[a] += along * d[a] + around * w[a];
          }
        });
    put<D>(springs, slice, part, sum, offset, f);
  }
}

template <int D>
void dashpots(const SpringTable& springs, const Positions& positions, const Positions& velocities,
              const Offset& offset, double* f, int from, int end) {
  if (springs.law_vectors == 1) {
    return sum_dashpots<D, 1>(springs, positions, velocities, offset, f, from, end);
  }
  return sum_dashpots<D, 2>(springs, positions, velocities, offset, f, from, end);
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
