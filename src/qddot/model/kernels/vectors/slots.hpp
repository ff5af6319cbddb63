#pragma once

#include "qddot/model/kernels/vectors/points.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

[[gnu::always_inline]] inline double* coordinate(const Positions& positions, int a, int place) {
  return positions.coordinates + a * positions.stride + place;
}

// A part of a slice has the rows of one vector: part * lanes and the following.
constexpr int parts_of_slice = slice_rows / lanes;

// The numbers of one slot's laws, for a part of a slice.
struct Law {
  const double *stiffness, *rest_length, *quartic;
};
[[gnu::always_inline]] inline Law law_of(const SpringTable& springs, const SlotLaw& law, int part) {
  const double* numbers = springs.laws + part * lanes;
  return {numbers + law.stiffness, numbers + law.rest_length, numbers + law.quartic};
}

// |d|^2 of a vector's rows.
template <int D>
[[gnu::always_inline]] inline Lanes squared_length(const Lanes (&d)[D]) {
  Lanes l2 = d[0] * d[0];
  for (int a = 1; a < D; ++a) l2 += d[a] * d[a];
  return l2;
}

// Visits the slots of a part of a slice: add_shift(s, slot, d, law) for every slot s of one shift,
// then add_gather(slot, d, law) for all others. d = x_j - x_i of the part's rows; slots are
// numbered within the slice.
template <int D, class AddShift, class AddGather>
[[gnu::always_inline]] inline void for_slots(const SpringTable& springs, int slice, int part,
                                             const Positions& positions, const AddShift& add_shift,
                                             const AddGather& add_gather) {
  const int row = slice * slice_rows + part * lanes;
  const Slice begin = springs.slices[slice], end = springs.slices[slice + 1];
  const SlotLaw* law = springs.slot_laws + begin.slot();
  Lanes x[D], d[D];
  for (int a = 0; a < D; ++a) x[a] = load(coordinate(positions, a, row));
  int slot = 0;
  for (int s = begin.shift; s < end.shift; ++s) {
    const int shifted = row + springs.shifts[s];
    for (int a = 0; a < D; ++a) d[a] = load(coordinate(positions, a, shifted)) - x[a];
    add_shift(s, slot++, d, law_of(springs, *law++, part));
  }
  for (int s = begin.gather; s < end.gather; s += slice_rows) {
    gather<D>(positions.points, springs.gathers + s + part * lanes, d);
    for (int a = 0; a < D; ++a) d[a] -= x[a];
    add_gather(slot++, d, law_of(springs, *law++, part));
  }
}

// Calls add(slot, d0, d1, law) for every slot of a part of a slice, with the d of two positions;
// likewise, but slots have their numbers among all.
template <int D, class Add>
[[gnu::always_inline]] inline void for_slots_of_two(const SpringTable& springs, int slice, int part,
                                                    const Positions& before, const Positions& after,
                                                    const Add& add) {
  const int row = slice * slice_rows + part * lanes;
  const Slice begin = springs.slices[slice], end = springs.slices[slice + 1];
  int slot = begin.slot();
  Lanes x0[D], x1[D], d0[D], d1[D];
  for (int a = 0; a < D; ++a) {
    x0[a] = load(coordinate(before, a, row));
    x1[a] = load(coordinate(after, a, row));
  }
  for (int s = begin.shift; s < end.shift; ++s) {
    const int shifted = row + springs.shifts[s];
    for (int a = 0; a < D; ++a) {
      d0[a] = load(coordinate(before, a, shifted)) - x0[a];
      d1[a] = load(coordinate(after, a, shifted)) - x1[a];
    }
    add(slot, d0, d1, law_of(springs, springs.slot_laws[slot], part));
    ++slot;
  }
  for (int s = begin.gather; s < end.gather; s += slice_rows) {
    const int* places = springs.gathers + s + part * lanes;
    gather<D>(before.points, places, d0);
    gather<D>(after.points, places, d1);
    for (int a = 0; a < D; ++a) {
      d0[a] -= x0[a];
      d1[a] -= x1[a];
    }
    add(slot, d0, d1, law_of(springs, springs.slot_laws[slot], part));
    ++slot;
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
