#pragma once

#include "qddot/model/kernels/vectors/roots.hpp"
#include "qddot/model/kernels/vectors/slots.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// The lower triangle of a symmetric D x D block, column by column.
template <int D>
constexpr int triangle = D*(D + 1) / 2;

// The entry of that triangle at row a, column b.
template <int D>
constexpr int entry(int a, int b) {
  const int row = a > b ? a : b, column = a > b ? b : a;
  return column * D - column * (column - 1) / 2 + row - column;
}

// tau' of one slot's springs, and tau/l as it counts in B: counted(tau/l, l0). B is tau' alone on a
// line, so K is the same to the last bit at every q if tau' is constant.
struct Slopes {
  Lanes along, across, inverse_length;
};
template <int D, int law_vectors, Roots roots, class Counted>
[[gnu::always_inline]] inline Slopes slopes(Lanes l2, const Law& law, const Counted& counted,
                                            Range& range) {
  const Lanes stiffness = load(law.stiffness);
  if constexpr (law_vectors == 1 || (D == 1 && law_vectors == 2)) {
    return {stiffness, stiffness, Lanes{}};
  } else {
    if constexpr (roots != Roots::processor) range.add(l2);
    const Lanes l = root_of<roots>(l2), rest_length = load(law.rest_length), s = l - rest_length;
    Lanes along = stiffness, tension = s * stiffness;
    if constexpr (law_vectors == 3) {
      const Lanes quartic = load(law.quartic) * (s * s);
      along = stiffness + 3 * quartic;
      tension = s * (stiffness + quartic);
    }
    if constexpr (D == 1) return {along, along, Lanes{}};
    const Lanes one_by_l = 1 / l, inverse_length = l > 0 ? one_by_l : Lanes{};
    const Lanes across = l > 0 ? counted(tension * inverse_length, rest_length) : along;
    return {along, across, inverse_length};
  }
}

// K_ji = B of each row that has a target.
template <int D>
[[gnu::always_inline]] inline void put_blocks(const Lanes (&block)[triangle<D>], const int* target,
                                              const int* columns, double* values) {
  double entries[triangle<D>][lanes];
  for (int e = 0; e < triangle<D>; ++e) store(entries[e], block[e]);
  for (int t = 0; t < lanes; ++t) {
    if (target[t] < 0) continue;
    for (int b = 0; b < D; ++b) {
      // The node's own block takes one row less in each column.
      double* column = values + target[t] + columns[D * t + b] - columns[D * t] - b;
      for (int a = 0; a < D; ++a) column[a] = entries[entry<D>(a, b)][t];
    }
  }
}

// K_ii of each row, without the coordinates that are no unknowns.
template <int D>
[[gnu::always_inline]] inline void put_own(const Lanes (&own)[triangle<D>], const int* columns,
                                           double* values) {
  double entries[triangle<D>][lanes];
  for (int e = 0; e < triangle<D>; ++e) store(entries[e], own[e]);
  for (int t = 0; t < lanes; ++t) {
    for (int b = 0; b < D; ++b) {
      if (columns[D * t + b] < 0) continue;
      double* value = values + columns[D * t + b];
      for (int a = b; a < D; ++a) {
        if (columns[D * t + a] >= 0) *value++ = entries[entry<D>(a, b)][t];
      }
    }
  }
}

// The blocks of one slot's springs.
template <int D>
[[gnu::always_inline]] inline void set_blocks(const Lanes (&d)[D], const Slopes& slope,
                                              Lanes (&block)[triangle<D>]) {
  for (int b = 0; b < D; ++b) {
    const Lanes n = d[b] * slope.inverse_length;
    for (int a = b; a < D; ++a) {
      Lanes& entry_ab = block[entry<D>(a, b)];
      entry_ab = (slope.along - slope.across) * n * (d[a] * slope.inverse_length);
      if (a == b) entry_ab = D == 1 ? slope.along : entry_ab + slope.across;
    }
  }
}

// Writes the rows' columns of K, with tau/l as counted(tau/l, l0).
template <int D, int law_vectors, Roots chosen, class Counted>
void write(const SpringTable& springs, const Positions& positions, const StiffnessTable& table,
           const Counted& counted, double* values, int from, int end) {
  constexpr Roots roots = D == 1 || law_vectors == 1 ? Roots::processor : chosen;
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice;
    const int first = springs.slices[slice].slot();
    const int* columns = table.columns + D * (slice * slice_rows + part * lanes);
    Lanes own[triangle<D>];
    by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
      // A range-for would lose the attribute that vectors may be unaligned.
      for (int e = 0; e < triangle<D>; ++e) own[e] = Lanes{};
      const auto add = [&](int slot, const Lanes(&d)[D], const Law& law)
          __attribute__((always_inline)) {
        Lanes block[triangle<D>];
        const Lanes l2 = squared_length<D>(d);
        set_blocks<D>(d, slopes<D, law_vectors, in_use>(l2, law, counted, range), block);
        for (int e = 0; e < triangle<D>; ++e) own[e] -= block[e];
        const int at = table.slot_targets[first + slot];
        if (at < 0) return;
        put_blocks<D>(block, table.targets + at + part * lanes, columns, values);
      };
      for_slots<D>(
          springs, slice, part, positions,
          [&](int, int slot, const Lanes(&d)[D], const Law& law)
              __attribute__((always_inline)) { add(slot, d, law); },
          add);
    });
    put_own<D>(own, columns, values);
  }
}

template <int D, Roots roots, class Counted>
void write(const SpringTable& springs, const Positions& positions, const StiffnessTable& table,
           const Counted& counted, double* values, int from, int end) {
  switch (springs.law_vectors) {
    case 1:
      return write<D, 1, roots>(springs, positions, table, counted, values, from, end);
    case 2:
      return write<D, 2, roots>(springs, positions, table, counted, values, from, end);
    default:
      return write<D, 3, roots>(springs, positions, table, counted, values, from, end);
  }
}

// Inverse lengths are the processor's own quotients: estimated ones may be next to the nearest
// number.
template <int D, Roots roots>
void stiffness(const SpringTable& springs, const Positions& positions, const StiffnessTable& table,
               TensionPart part, double* values, int from, int end) {
  const auto softened = [part](Lanes across, Lanes) __attribute__((always_inline)) {
    return across < 0 ? across * part.compression : across;
  };
  const auto material = [](Lanes across, Lanes rest_length) __attribute__((always_inline)) {
    return rest_length > 0 ? Lanes{} : across;
  };
  if (part.is_material) {
    write<D, roots>(springs, positions, table, material, values, from, end);
  } else {
    write<D, roots>(springs, positions, table, softened, values, from, end);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
