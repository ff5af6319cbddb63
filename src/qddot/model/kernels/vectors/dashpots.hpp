#pragma once

#include "qddot/model/kernels/vectors/force.hpp"

// Dashpots along the springs. One between x_i and x_j with the constant c adds to f_i
//   c (d.w)/|d|^2 d,   d = x_j - x_i,   w = v_j - v_i,
// which needs no root; or c w on a line, for a spring of rest length zero, and at length zero.
namespace qddot::kernels::QDDOT_LEVEL {
namespace {

// d.w
template <int D>
[[gnu::always_inline]] inline Lanes along(const Lanes (&d)[D], const Lanes (&w)[D]) {
  Lanes product = d[0] * w[0];
  for (int a = 1; a < D; ++a) product = add_product(d[a], w[a], product);
  return product;
}

// Adds the forces of one slot's dashpots, given 1/|d|^2.
template <int D, int law_vectors>
[[gnu::always_inline]] inline void add_friction(Lanes c, const Lanes (&d)[D], const Lanes (&w)[D],
                                                Lanes l2, Lanes inverse, const Law& law,
                                                Lanes (&sum)[D]) {
  if constexpr (D == 1 || law_vectors == 1) {
    for (int a = 0; a < D; ++a) sum[a] += c * w[a];
  } else {
    const Lanes directed = load(law.rest_length) > 0 ? l2 : Lanes{};
    const Lanes quotient = c * along<D>(d, w) * inverse;
    const Lanes lengthwise = directed > 0 ? quotient : Lanes{};
    const Lanes around = directed > 0 ? Lanes{} : c;
    for (int a = 0; a < D; ++a) sum[a] += lengthwise * d[a] + around * w[a];
  }
}

// tau/l and 1/l^2 of several springs, whose squared lengths are l2; tau/l is 0 where l = 0. As the
// dashpot divides by l^2, tau/l is tau l/l^2: a root and one division for both.
template <int law_vectors, Roots roots, int count>
[[gnu::always_inline]] inline void tensions_and_inverses(const Lanes (&l2)[count],
                                                         const Law (&law)[count], Range& range,
                                                         Lanes (&ratio)[count],
                                                         Lanes (&inverse)[count]) {
  unroll<count>([&]<int i>() __attribute__((always_inline)) { inverse[i] = 1 / l2[i]; });
  if constexpr (law_vectors == 1) {
    for (int i = 0; i < count; ++i) ratio[i] = load(law[i].stiffness);
  } else {
    Lanes l[count];
    if constexpr (roots == Roots::processor) {
      unroll<count>([&]<int i>() __attribute__((always_inline)) { l[i] = square_root(l2[i]); });
    } else {
      Lanes half_inverse[count];
      unroll<count>([&]<int i>() __attribute__((always_inline)) { range.add(l2[i]); });
      estimated_roots(l2, l, half_inverse);
    }
    unroll<count>([&]<int i>() __attribute__((always_inline)) {
      const Lanes quotient = tension<law_vectors>(l[i], law[i]) * l[i] * inverse[i];
      ratio[i] = l2[i] > 0 ? quotient : Lanes{};
    });
  }
}

template <int D, int law_vectors>
void sum_frictions(const SpringTable& springs, const DashpotTable& dashpots,
                   const Positions& positions, const Positions& velocities, const Offset& offset,
                   double* friction, int from, int end) {
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    const int slice = i / parts_of_slice, part = i % parts_of_slice;
    Lanes sum[D];
    for (int a = 0; a < D; ++a) sum[a] = Lanes{};
    for_slots_of_two<D>(
        springs, slice, part, positions, velocities,
        [&](int slot, const Lanes(&d)[D], const Lanes(&w)[D], const Law& law)
            __attribute__((always_inline)) {
              const Lanes c = load(springs.laws + part * lanes + dashpots.slots[slot]);
              const Lanes l2 = squared_length<D>(d);
              add_friction<D, law_vectors>(c, d, w, l2, 1 / l2, law, sum);
            });
    put<D>(springs, slice, part, sum, offset, friction);
  }
}

template <int D>
void friction(const SpringTable& springs, const DashpotTable& dashpots, const Positions& positions,
              const Positions& velocities, const Offset& offset, double* f, int from, int end) {
  if (springs.law_vectors == 1) {
    return sum_frictions<D, 1>(springs, dashpots, positions, velocities, offset, f, from, end);
  }
  return sum_frictions<D, 2>(springs, dashpots, positions, velocities, offset, f, from, end);
}

// The dashpots beside the springs, see sum_forces_by_rings: a ring beside each ring of tau/l keeps
// c (d.w)/|d|^2. A spring of length zero has none; then all is summed once more, apart.
template <int D, int law_vectors, Roots roots>
struct Dashpots {
  static constexpr bool exist = true;

  const DashpotTable& table;
  const Positions& velocities;
  const Offset& offset;
  double* friction;
  LaneNumbers no_length = {};

  // Finds tau/l of some jobs, and stores what the dashpots' rings keep.
  template <Roots in_use>
  [[gnu::always_inline]] void do_jobs(const SpringTable& springs, const RingTable& rings,
                                      const RingJob* const (&job)[jobs_at_once], int part,
                                      const Lanes (&d)[jobs_at_once][D],
                                      const Lanes (&l2)[jobs_at_once],
                                      const Law (&law)[jobs_at_once], Range& range, double* memory,
                                      Lanes (&ratio)[jobs_at_once]) {
    Lanes inverse[jobs_at_once];
    tensions_and_inverses<law_vectors, in_use, jobs_at_once>(l2, law, range, ratio, inverse);
    unroll<jobs_at_once>([&]<int i>() __attribute__((always_inline)) {
      const Lanes c = load(springs.laws + part * lanes + table.jobs[job[i] - rings.jobs]);
      const double* u = velocities.coordinates + job[i]->row + part * lanes;
      Lanes w[D];
      for (int a = 0; a < D; ++a, u += velocities.stride) w[a] = load(u + job[i]->shift) - load(u);
      const Lanes quotient = c * along<D>(d[i], w) * inverse[i];
      const Lanes kept = l2[i] > 0 ? quotient : Lanes{};
      no_length |= (c > 0) & (l2[i] == 0);
      store(memory + table.first_number + job[i]->at + part * lanes, kept);
      if (job[i]->copy >= 0) store(memory + table.first_number + job[i]->copy + part * lanes, kept);
    });
  }

  // Writes f and the friction of a part of a slice whose sums are known.
  [[gnu::always_inline]] void put_both(const SpringTable& springs, int slice, int part,
                                       Lanes (&sum)[D], const Lanes (&drag)[D],
                                       const Offset& offset_of_f, double* f) const {
    put<D>(springs, slice, part, drag, offset, friction);
    for (int a = 0; a < D; ++a) sum[a] += drag[a];
    put<D>(springs, slice, part, sum, offset_of_f, f);
  }

  // f and the friction of a part of a slice, with every spring computed here.
  [[gnu::always_inline]] void sum_slice(const SpringTable& springs, int slice, int part,
                                        const Positions& positions, const Offset& offset_of_f,
                                        double* f) const {
    constexpr Roots chosen = D == 1 || law_vectors == 1 ? Roots::processor : roots;
    Lanes sum[D], drag[D];
    by_roots<chosen>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
      for (int a = 0; a < D; ++a) sum[a] = drag[a] = Lanes{};
      for_slots_of_two<D>(
          springs, slice, part, positions, velocities,
          [&](int slot, const Lanes(&d)[D], const Lanes(&w)[D], const Law& law)
              __attribute__((always_inline)) {
                const Lanes c = load(springs.laws + part * lanes + table.slots[slot]);
                const Lanes l2[] = {squared_length<D>(d)};
                const Law laws[] = {law};
                Lanes ratio[1] = {}, inverse[1] = {};
                if constexpr (D > 1) {
                  tensions_and_inverses<law_vectors, in_use, 1>(l2, laws, range, ratio, inverse);
                  for (int a = 0; a < D; ++a) sum[a] += ratio[0] * d[a];
                } else {
                  sum[0] += force_on_line<law_vectors>(d[0], law);
                }
                add_friction<D, law_vectors>(c, d, w, l2[0], inverse[0], law, drag);
              });
    });
    put_both(springs, slice, part, sum, drag, offset_of_f, f);
  }
};

// Tables are copied, as in force.hpp.
template <int D, int law_vectors, Roots roots>
void sum_damped_forces(SpringTable springs, DashpotTable table, Positions positions,
                       Positions velocities, double* memory, bool continues, bool& met_no_length,
                       Offset offset_of_f, double* f, Offset offset, double* friction, int from,
                       int end) {
  Dashpots<D, law_vectors, roots> dashpots{table, velocities, offset, friction};
  if constexpr (D > 1 && law_vectors > 1) {
    if (springs.rings && table.are_directed && !met_no_length) {
      const RingTable rings = *springs.rings;
      sum_forces_by_rings<D, law_vectors, roots>(springs, rings, positions, memory, continues,
                                                 offset_of_f, f, from, end, dashpots);
      for (int t = 0; t < lanes; ++t) met_no_length |= dashpots.no_length[t] != 0;
      if (!met_no_length) return;
      // Rows whose unknowns do not follow one another read their offset where they write.
      for (int slice = from; slice < end; ++slice) {
        if (springs.slice_unknowns[slice].order == Order::by_slice) continue;
        const int* unknown = springs.unknowns + D * slice_rows * slice;
        for (int e = 0; e < D * slice_rows; ++e) {
          if (unknown[e] >= 0) friction[unknown[e]] = 0;
        }
      }
    }
  }
  for (int i = from * parts_of_slice; i < end * parts_of_slice; ++i) {
    dashpots.sum_slice(springs, i / parts_of_slice, i % parts_of_slice, positions, offset_of_f, f);
  }
}

template <int D, Roots roots>
void damped_force(const SpringTable& springs, const DashpotTable& dashpots,
                  const Positions& positions, const Positions& velocities, double* rings,
                  bool continues, bool& met_no_length, const Offset& offset_of_f, double* f,
                  const Offset& offset, double* friction, int from, int end) {
  const auto sum = [&]<int law_vectors>() {
    sum_damped_forces<D, law_vectors, roots>(springs, dashpots, positions, velocities, rings,
                                             continues, met_no_length, offset_of_f, f, offset,
                                             friction, from, end);
  };
  switch (springs.law_vectors) {
    case 1:
      return sum.template operator()<1>();
    case 2:
      return sum.template operator()<2>();
    default:
      return sum.template operator()<3>();
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
