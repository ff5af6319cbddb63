#pragma once

#include "qddot/model/kernels/vectors/points.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

[[gnu::always_inline]] inline double* coordinate(const Positions& positions, int a, int place) {
  return positions.coordinates + a * positions.stride + place;
}

// A vector's rows of a slice: part * lanes and the following.
constexpr int parts_of_slice = slice_rows / lanes;

// Calls add(slot, d, l2, law) for every slot of a part of a slice, with d = x_j - x_i and l2 =
// |d|^2 of its rows and what NeighbourSlices::laws has for it; the slots of one shift come first.
template <int D, int law_vectors, class Add>
[[gnu::always_inline]] inline void for_slots(const SpringTable& springs, int slice, int part,
                                             const Positions& positions, const Add& add) {
  const int row = slice * slice_rows + part * lanes;
  const Slice begin = springs.slices[slice], end = springs.slices[slice + 1];
  const double* law = springs.laws + begin.law + part * lanes;
  Lanes x[D], d[D];
  for (int a = 0; a < D; ++a) x[a] = load(coordinate(positions, a, row));
  int slot = 0;
  const auto add_slot = [&]() __attribute__((always_inline)) {
    Lanes l2 = d[0] * d[0];
    for (int a = 1; a < D; ++a) l2 += d[a] * d[a];
    add(slot++, d, l2, law);
    law += law_vectors * slice_rows;
  };
  for (int s = begin.shift; s < end.shift; ++s) {
    const int shifted = row + springs.shifts[s];
    for (int a = 0; a < D; ++a) d[a] = load(coordinate(positions, a, shifted)) - x[a];
    add_slot();
  }
  for (int s = begin.gather; s < end.gather; s += slice_rows) {
    gather<D>(positions.points, springs.gathers + s + part * lanes, d);
    for (int a = 0; a < D; ++a) d[a] -= x[a];
    add_slot();
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
