#pragma once

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

// tau' of one slot's springs, and tau/l as it counts in B: counted(tau/l, l0). On a line B is tau'
// alone, which is K's to the last bit at every q where tau' is constant.
struct Slopes {
  Lanes along, across, inverse_length;
};
template <int D, int law_vectors, class Counted>
[[gnu::always_inline]] inline Slopes slopes(Lanes l2, const double* law, const Counted& counted) {
  const Lanes stiffness = load(law);
  if constexpr (law_vectors == 1 || (D == 1 && law_vectors == 2)) {
    return {stiffness, stiffness, Lanes{}};
  } else {
    const Lanes l = square_root(l2), rest_length = load(law + lanes), s = l - rest_length;
    Lanes along = stiffness, tension = s * stiffness;
    if constexpr (law_vectors == 3) {
      const Lanes quartic = load(law + 2 * lanes) * (s * s);
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

// With tau/l as counted(tau/l, l0).
template <int D, int law_vectors, class Counted>
void write(const SpringTable& springs, const Positions& positions, const StiffnessTable& table,
           const Counted& counted, double* values, int from, int end) {
  for (int slice = from; slice < end; ++slice) {
    const int first = springs.slices[slice].shift + springs.slices[slice].gather / lanes;
    const int* columns = table.columns + D * slice * lanes;
    Lanes own[triangle<D>] = {};
    const auto add = [&](int slot, const Lanes(&d)[D], Lanes l2, const double* law)
        __attribute__((always_inline)) {
      const Slopes slope = slopes<D, law_vectors>(l2, law, counted);
      Lanes block[triangle<D>];
      for (int b = 0; b < D; ++b) {
        const Lanes n = d[b] * slope.inverse_length;
        for (int a = b; a < D; ++a) {
          Lanes& entry_ab = block[entry<D>(a, b)];
          entry_ab = (slope.along - slope.across) * n * (d[a] * slope.inverse_length);
          if (a == b) entry_ab = D == 1 ? slope.along : entry_ab + slope.across;
        }
      }
      for (int e = 0; e < triangle<D>; ++e) own[e] -= block[e];
      const int at = table.slot_targets[first + slot];
      if (at >= 0) put_blocks<D>(block, table.targets + at, columns, values);
    };
    for_slots<D, law_vectors>(springs, slice, positions, add);
    put_own<D>(own, columns, values);
  }
}

template <int D, class Counted>
void write(const SpringTable& springs, const Positions& positions, const StiffnessTable& table,
           const Counted& counted, double* values, int from, int end) {
  switch (springs.law_vectors) {
    case 1:
      return write<D, 1>(springs, positions, table, counted, values, from, end);
    case 2:
      return write<D, 2>(springs, positions, table, counted, values, from, end);
    default:
      return write<D, 3>(springs, positions, table, counted, values, from, end);
  }
}

template <int D>
void stiffness(const SpringTable& springs, const Positions& positions, const StiffnessTable& table,
               TensionPart part, double* values, int from, int end) {
  const auto softened = [part](Lanes across, Lanes) __attribute__((always_inline)) {
    return across < 0 ? across * part.compression : across;
  };
  const auto material = [](Lanes across, Lanes rest_length) __attribute__((always_inline)) {
    return rest_length > 0 ? Lanes{} : across;
  };
  if (part.is_material) {
    write<D>(springs, positions, table, material, values, from, end);
  } else {
    write<D>(springs, positions, table, softened, values, from, end);
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
