#pragma once

#include "qddot/model/kernels/vectors/tensions.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// So many slots are computed side by side, as measured: few where the processor's own divider is
// busy anyway, and as many as the registers allow where estimates wait for each other.
template <Roots roots>
constexpr int slots_at_once = lanes == 8 && roots != Roots::processor ? 4 : 2;

// Adds tau/l d of `count` slots, of which the first has the law *law; set_difference(i, d) sets the
// d = x_j - x_i of slot i.
template <int D, int law_vectors, Roots roots, int count, class SetDifference>
[[gnu::always_inline]] inline void add_slots(const SpringTable& springs, const SlotLaw* law,
                                             int part, Range& range, Lanes (&sum)[D],
                                             const SetDifference& set_difference) {
  Lanes d[count][D], l2[count], ratio[count];
  Law laws[count];
  unroll<count>([&]<int i>() __attribute__((always_inline)) {
    set_difference(i, d[i]);
    laws[i] = law_of(springs, law[i], part);
    l2[i] = squared_length<D>(d[i]);
  });
  tensions_by_length<law_vectors, roots, count>(l2, laws, range, ratio);
  unroll<count>([&]<int i>() __attribute__((always_inline)) {
    for (int a = 0; a < D; ++a) sum[a] += ratio[i] * d[i][a];
  });
}

// Adds the forces of a slice's slots of one shift, and of those that gather.
template <int D, int law_vectors, Roots roots>
[[gnu::always_inline]] inline void add_shifts(const SpringTable& springs, int slice, int part,
                                              const Positions& positions, Range& range,
                                              Lanes (&sum)[D]) {
  const int row = slice * slice_rows + part * lanes;
  const int *shift = springs.shifts + springs.slices[slice].shift,
            *end = springs.shifts + springs.slices[slice + 1].shift;
  const SlotLaw* law = springs.slot_laws + springs.slices[slice].slot();
  Lanes x[D];
  for (int a = 0; a < D; ++a) x[a] = load(coordinate(positions, a, row));
  const auto difference = [&](int i, Lanes(&d)[D]) __attribute__((always_inline)) {
    for (int a = 0; a < D; ++a) d[a] = load(coordinate(positions, a, row + shift[i])) - x[a];
  };
  constexpr int many = slots_at_once<roots>;
  for (; end - shift >= many; shift += many, law += many) {
    add_slots<D, law_vectors, roots, many>(springs, law, part, range, sum, difference);
  }
  for (; shift < end; ++shift, ++law) {
    add_slots<D, law_vectors, roots, 1>(springs, law, part, range, sum, difference);
  }
}
template <int D, int law_vectors, Roots roots>
[[gnu::always_inline]] inline void add_gathers(const SpringTable& springs, int slice, int part,
                                               const Positions& positions, Range& range,
                                               Lanes (&sum)[D]) {
  const int row = slice * slice_rows + part * lanes;
  const Slice begin = springs.slices[slice];
  const int *places = springs.gathers + begin.gather + part * lanes,
            *end = springs.gathers + springs.slices[slice + 1].gather;
  const SlotLaw* law =
      springs.slot_laws + springs.slices[slice + 1].shift + begin.gather / slice_rows;
  Lanes x[D];
  for (int a = 0; a < D; ++a) x[a] = load(coordinate(positions, a, row));
  const auto difference = [&](int i, Lanes(&d)[D]) __attribute__((always_inline)) {
    gather<D>(positions.points, places + i * slice_rows, d);
    for (int a = 0; a < D; ++a) d[a] -= x[a];
  };
  constexpr int many = slots_at_once<roots>;
  for (; end - places > (many - 1) * slice_rows; places += many * slice_rows, law += many) {
    add_slots<D, law_vectors, roots, many>(springs, law, part, range, sum, difference);
  }
  for (; places < end; places += slice_rows, ++law) {
    add_slots<D, law_vectors, roots, 1>(springs, law, part, range, sum, difference);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
