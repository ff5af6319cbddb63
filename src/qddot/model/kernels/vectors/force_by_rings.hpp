#pragma once

#include "qddot/model/kernels/vectors/put.hpp"
#include "qddot/model/kernels/vectors/slot_sums.hpp"

// Forces of networks whose slots of one shift share tau/l by rings (see Rings). A block of slices:
//
//   jobs   slice 0: row, shift, law -> ring     r = tau/l of rows [row, row + 8), four jobs at once
//          slice 0: ...                         store(ring at row, r)
//          ...
//   terms  slice 0: shift, ring                 f_i += r (x_j - x_i), r = load(ring at row + from),
//          ...                                  two slices with the same terms at once
namespace qddot::kernels::QDDOT_LEVEL {
namespace {

constexpr int jobs_at_once = 4;

// Springs without dashpots; see Dashpots.
struct NoDashpots {
  static constexpr bool exist = false;
};

// Stores tau/l of jobs [first, end) in their rings.
template <int D, int law_vectors, Roots roots, class Friction>
[[gnu::always_inline]] inline void do_jobs(const SpringTable& springs, const RingTable& rings,
                                           const RingJob* first, const RingJob* end, int part,
                                           const Positions& positions, double* memory, Range& range,
                                           Friction& dashpots) {
  for (; first < end; first += jobs_at_once) {
    const RingJob* job[jobs_at_once];
    Law law[jobs_at_once];
    Lanes d[jobs_at_once][D], l2[jobs_at_once], ratio[jobs_at_once];
    unroll<jobs_at_once>([&]<int i>() __attribute__((always_inline)) {
      // The last job may be done several times.
      job[i] = first + i < end ? first + i : end - 1;
      law[i] = law_of(springs, job[i]->law, part);
      const double* x = positions.coordinates + job[i]->row + part * lanes;
      for (int a = 0; a < D; ++a, x += positions.stride) {
        d[i][a] = load(x + job[i]->shift) - load(x);
      }
      l2[i] = squared_length<D>(d[i]);
    });
    if constexpr (Friction::exist) {
      dashpots.template do_jobs<roots>(springs, rings, job, part, d, l2, law, range, memory, ratio);
    } else {
      tensions_by_length<law_vectors, roots, jobs_at_once>(l2, law, range, ratio);
    }
    unroll<jobs_at_once>([&]<int i>() __attribute__((always_inline)) {
      store(memory + job[i]->at + part * lanes, ratio[i]);
      if (job[i]->copy >= 0) store(memory + job[i]->copy + part * lanes, ratio[i]);
    });
  }
}

// f of `count` slices from one on, which have the same terms.
template <int D, int count, class Friction>
[[gnu::always_inline]] inline void sum_terms(const SpringTable& springs, const RingTerm* term,
                                             const RingTerm* end, int slice, int part,
                                             const Positions& positions, const double* memory,
                                             const Offset& offset, double* f, Friction& dashpots) {
  const int row = slice * slice_rows + part * lanes;
  const double* own = positions.coordinates + row;
  Lanes sum[count][D], x[count][D];
  [[maybe_unused]] Lanes drag[count][D];
  unroll<count>([&]<int i>() __attribute__((always_inline)) {
    for (int a = 0; a < D; ++a) {
      sum[i][a] = Lanes{};
      if constexpr (Friction::exist) drag[i][a] = Lanes{};
      x[i][a] = load(own + a * positions.stride + i * slice_rows);
    }
  });
  for (; term != end; ++term) {
    const double* others = own + term->shift;
    unroll<count>([&]<int i>() __attribute__((always_inline)) {
      const int at = (row + i * slice_rows + term->from) & term->mask;
      const Lanes ratio = load(memory + term->begin + at);
      if constexpr (Friction::exist) {
        const Lanes friction = load(memory + dashpots.table.first_number + term->begin + at);
        for (int a = 0; a < D; ++a) {
          const Lanes d = load(others + a * positions.stride + i * slice_rows) - x[i][a];
          sum[i][a] += ratio * d;
          drag[i][a] += friction * d;
        }
      } else {
        for (int a = 0; a < D; ++a) {
          sum[i][a] += ratio * (load(others + a * positions.stride + i * slice_rows) - x[i][a]);
        }
      }
    });
  }
  unroll<count>([&]<int i>() __attribute__((always_inline)) {
    if constexpr (Friction::exist) {
      dashpots.put_both(springs, slice + i, part, sum[i], drag[i], offset, f);
    } else {
      put<D>(springs, slice + i, part, sum[i], offset, f);
    }
  });
}

// f of a slice with slots that have no ring.
template <int D, int law_vectors, Roots roots>
[[gnu::always_inline]] inline void sum_slice(const SpringTable& springs, const RingTable& rings,
                                             int slice, int part, const Positions& positions,
                                             const double* memory, const Offset& offset,
                                             double* f) {
  const int row = slice * slice_rows + part * lanes;
  Lanes sum[D], x[D];
  for (int a = 0; a < D; ++a) x[a] = load(coordinate(positions, a, row));
  by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
    for (int a = 0; a < D; ++a) sum[a] = Lanes{};
    const SlotLaw* law = springs.slot_laws + springs.slices[slice].slot();
    for (int s = springs.slices[slice].shift; s < springs.slices[slice + 1].shift; ++s, ++law) {
      const int shifted = row + springs.shifts[s];
      const RingUse use = rings.uses[s];
      const auto difference = [&](int, Lanes(&d)[D]) __attribute__((always_inline)) {
        for (int a = 0; a < D; ++a) d[a] = load(coordinate(positions, a, shifted)) - x[a];
      };
      if (use.kind == RingUse::none) {
        add_slots<D, law_vectors, in_use, 1>(springs, law, part, range, sum, difference);
        continue;
      }
      const Ring ring = rings.rings[use.ring];
      const int from = use.kind == RingUse::finds ? shifted : row;
      const Lanes ratio = load(memory + ring.begin + (from & ring.mask));
      Lanes d[D];
      difference(0, d);
      for (int a = 0; a < D; ++a) sum[a] += ratio * d[a];
    }
    add_gathers<D, law_vectors, in_use>(springs, slice, part, positions, range, sum);
  });
  put<D>(springs, slice, part, sum, offset, f);
}

// f of slices [from, end), and the friction where dashpots exist. Jobs begin where the rings' first
// readers need them.
template <int D, int law_vectors, Roots roots, class Friction>
void sum_forces_by_rings(const SpringTable& springs, const RingTable& rings,
                         const Positions& positions, double* memory, bool continues,
                         const Offset& offset, double* f, int from, int end, Friction& dashpots) {
  const int first_of_jobs = continues ? from : from > rings.reach ? from - rings.reach : 0;
  for (int begin = first_of_jobs; begin < end; begin += slices_of_block) {
    const int block_end = begin + slices_of_block < end ? begin + slices_of_block : end;
    const RingJob *jobs = rings.jobs + rings.first_job[begin],
                  *jobs_end = rings.jobs + rings.first_job[block_end];
    by_roots<roots>([&]<Roots in_use>(Range & range) __attribute__((always_inline)) {
      for (int part = 0; part < parts_of_slice; ++part) {
        do_jobs<D, law_vectors, in_use>(springs, rings, jobs, jobs_end, part, positions, memory,
                                        range, dashpots);
      }
    });
    for (int slice = begin > from ? begin : from; slice < block_end;) {
      const int first = rings.first_term[slice];
      if (first < 0) {
        for (int part = 0; part < parts_of_slice; ++part) {
          if constexpr (Friction::exist) {
            dashpots.sum_slice(springs, slice, part, positions, offset, f);
          } else {
            sum_slice<D, law_vectors, roots>(springs, rings, slice, part, positions, memory, offset,
                                             f);
          }
        }
        ++slice;
        continue;
      }
      const int count = springs.slices[slice + 1].shift - springs.slices[slice].shift;
      const RingTerm *terms = rings.terms + first, *terms_end = terms + count;
      const bool has_twin = slice + 1 < block_end && rings.first_term[slice + 1] == first;
      for (int part = 0; part < parts_of_slice; ++part) {
        if (has_twin) {
          sum_terms<D, 2>(springs, terms, terms_end, slice, part, positions, memory, offset, f,
                          dashpots);
        } else {
          sum_terms<D, 1>(springs, terms, terms_end, slice, part, positions, memory, offset, f,
                          dashpots);
        }
      }
      slice += has_twin ? 2 : 1;
    }
  }
}

}  // namespace
}  // namespace qddot::kernels::QDDOT_LEVEL
