#pragma once

#include "qddot/model/kernels/vectors/slots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

template <int D>
[[gnu::always_inline]] inline void place_slice(const SpringTable& springs, const double* q,
                                               int slice, const Positions& positions) {
  const int row = slice * slice_rows;
  const int* unknowns = springs.unknowns + D * row;
  if (springs.orders[slice] == Order::by_slice) {
    for (int t = 0; t < slice_rows; t += lanes) {
      Lanes x[D];
      deinterleave<D>(q + unknowns[0] + D * t, x);
      for (int a = 0; a < D; ++a) store(coordinate(positions, a, row + t), x[a]);
    }
  } else if (springs.orders[slice] == Order::by_row) {
    for (int t = 0; t < slice_rows; ++t) {
      const double* x = q + unknowns[D * t];
      for (int a = 0; a < D; ++a) *coordinate(positions, a, row + t) = x[a];
    }
  } else {
    for (int t = 0; t < slice_rows; ++t) {
      for (int a = 0; a < D; ++a) {
        const int unknown = unknowns[D * t + a];
        *coordinate(positions, a, row + t) = unknown >= 0 ? q[unknown] : -1 - unknown;
      }
    }
  }
  if (D == 1 || !springs.gathered[slice]) return;
  for (int t = 0; t < slice_rows; ++t) {
    double* point = positions.points + point_stride<D> * std::ptrdiff_t{row + t};
    for (int a = 0; a < D; ++a) point[a] = *coordinate(positions, a, row + t);
  }
}

template <int D>
void place(const SpringTable& springs, const double* q, const Positions& positions, int from,
           int end) {
  for (int slice = from; slice < end; ++slice) place_slice<D>(springs, q, slice, positions);
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
