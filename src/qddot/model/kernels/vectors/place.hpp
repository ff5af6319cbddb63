#pragma once

#include "qddot/model/kernels/vectors/slots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// Copies the coordinates of a slice whose nodes' unknowns follow one another by nodes alone.
template <int D>
[[gnu::always_inline]] inline void place_by_row(const double* q, const int* unknowns, int row,
                                                bool is_gathered, const Positions& positions) {
#ifdef __AVX512F__
  if constexpr (D > 1) {
    // No number behind a node's last is read.
    __m256d x[slice_rows];
    unroll<slice_rows>([&]<int t>() __attribute__((always_inline)) {
      x[t] = _mm256_maskz_loadu_pd((1 << D) - 1, q + unknowns[D * t]);
    });
    if (is_gathered) {
      double* points = positions.points + point_stride<D> * std::ptrdiff_t{row};
      unroll<slice_rows>([&]<int t>() __attribute__((always_inline)) {
        _mm256_storeu_pd(points + point_stride<D> * t, x[t]);
      });
    }
    Lanes rows[4], coordinates[D];
    unroll<4>([&]<int t>() __attribute__((always_inline)) {
      constexpr int first = point_of_row(t);
      rows[t] = _mm512_insertf64x4(_mm512_castpd256_pd512(x[first]), x[first + 2], 1);
    });
    transpose<D>(rows, coordinates);
    for (int a = 0; a < D; ++a) store(coordinate(positions, a, row), coordinates[a]);
    return;
  }
#endif
  for (int t = 0; t < slice_rows; ++t) {
    const double* x = q + unknowns[D * t];
    double* point = positions.points + point_stride<D> * std::ptrdiff_t{row + t};
    for (int a = 0; a < D; ++a) {
      *coordinate(positions, a, row + t) = x[a];
      if (is_gathered) point[a] = x[a];
    }
  }
}

template <int D>
[[gnu::always_inline]] inline void place_slice(const SpringTable& springs, const double* q,
                                               int slice, const Positions& positions) {
  const int row = slice * slice_rows;
  const int* unknowns = springs.unknowns + D * row;
  const auto [order, first] = springs.slice_unknowns[slice];
  const bool is_gathered = D > 1 && springs.gathered[slice];
  // Vectors of eight lanes write points faster by rows.
  if (order != Order::none && (order == Order::by_row || (lanes == 8 && is_gathered))) {
    return place_by_row<D>(q, unknowns, row, is_gathered, positions);
  }
  if (order == Order::by_slice) {
    for (int t = 0; t < slice_rows; t += lanes) {
      Lanes x[D];
      deinterleave<D>(q + first + D * t, x);
      for (int a = 0; a < D; ++a) store(coordinate(positions, a, row + t), x[a]);
    }
  } else {
    for (int t = 0; t < slice_rows; ++t) {
      for (int a = 0; a < D; ++a) {
        const int unknown = unknowns[D * t + a];
        *coordinate(positions, a, row + t) = unknown >= 0 ? q[unknown] : -1 - unknown;
      }
    }
  }
  if (!is_gathered) return;
  for (int t = 0; t < slice_rows; ++t) {
    double* point = positions.points + point_stride<D> * std::ptrdiff_t{row + t};
    for (int a = 0; a < D; ++a) point[a] = *coordinate(positions, a, row + t);
  }
}

// Tables are copied, as in force.hpp.
template <int D>
void place(const SpringTable& table, const double* q, const Positions& places, int from, int end) {
  const SpringTable springs = table;
  const Positions positions = places;
  for (int slice = from; slice < end; ++slice) place_slice<D>(springs, q, slice, positions);
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
