#include "qddot/model/kernels/rings.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>

namespace qddot::kernels {
namespace {

constexpr int block_rows = slice_rows * slices_of_block;
// The share of slots that must read.
constexpr double worth_rings = 0.1;

// The slots of one shift of all slices.
class ShiftSlots {
 public:
  explicit ShiftSlots(const NeighbourSlices& slices) : slices_(slices) {}

  // The only slot of the slice with this shift; -1 if there is none or more than one.
  int find(int slice, int shift) const {
    const auto begin = slices_.shifts.begin() + slices_.slices[slice].shift,
               end = slices_.shifts.begin() + slices_.slices[slice + 1].shift;
    const auto found = std::find(begin, end, shift);
    if (found == end || std::find(found + 1, end, shift) != end) return -1;
    return static_cast<int>(found - slices_.shifts.begin());
  }

  // Whether the slots of the opposite shift contain the springs of a slot of negative shift.
  bool has_opposites(int slice, int s) const {
    const int shift = slices_.shifts[s], first = slice * slice_rows + shift;
    if (shift >= 0 || first < 0 || find(slice, shift) != s) return false;
    for (const int other : {first / slice_rows, (first + slice_rows - 1) / slice_rows}) {
      const int opposite = find(other, -shift);
      if (opposite < 0) return false;
      // Row r of this slice is row r + first - row of the other.
      const int row = other * slice_rows;
      const int from = std::max(row - first, 0),
                end = std::min(row + slice_rows - first, slice_rows);
      for (int t = from; t < end; ++t) {
        if (!is_same(slice, s, t, other, opposite, first + t - row)) return false;
      }
    }
    return true;
  }

  std::size_t slot_of(int slice, int s) const {
    const Slice& begin = slices_.slices[slice];
    return static_cast<std::size_t>(begin.slot() + s - begin.shift);
  }
  const SlotLaw& law_of(int slice, int s) const { return slices_.slot_laws[slot_of(slice, s)]; }

 private:
  bool is_same(int slice, int s, int t, int other_slice, int opposite, int other_t) const {
    const SlotLaw &law = law_of(slice, s), &other = law_of(other_slice, opposite);
    const auto have_same = [&](int place, int other_place) {
      return slices_.laws[place + t] == slices_.laws[other_place + other_t];
    };
    const int vectors = slices_.law_vectors;
    const std::vector<int>& dashpots = slices_.slot_dashpots;
    return have_same(law.stiffness, other.stiffness) &&
           (dashpots.empty() ||
            have_same(dashpots[slot_of(slice, s)], dashpots[slot_of(other_slice, opposite)])) &&
           (vectors < 2 || have_same(law.rest_length, other.rest_length)) &&
           (vectors < 3 || have_same(law.quartic, other.quartic));
  }

  const NeighbourSlices& slices_;
};

// Decides which slots store and which read.
void share(const NeighbourSlices& slices, const ShiftSlots& slots, Rings& result) {
  result.uses.assign(slices.shifts.size(), {RingUse::none, 0});
  std::map<int, int> ring_of;  // by the opposite shift
  for (int slice = 0; slice < slices.count(); ++slice) {
    for (int s = slices.slices[slice].shift; s < slices.slices[slice + 1].shift; ++s) {
      if (!slots.has_opposites(slice, s)) continue;
      const int opposite = -slices.shifts[s];
      const auto [found, is_new] = ring_of.try_emplace(opposite, std::ssize(result.rings));
      if (is_new) {
        // The ring spans the rows of a block and the rows before it that are found with it.
        const auto rows =
            static_cast<int>(std::bit_ceil(static_cast<unsigned>(opposite + block_rows)));
        result.rings.push_back({result.numbers, rows - 1});
        result.numbers += rows + slice_rows;
      }
      result.uses[s] = {RingUse::finds, found->second};
      const int first = slice * slice_rows - opposite;
      for (const int other : {first / slice_rows, (first + slice_rows - 1) / slice_rows}) {
        result.uses[slots.find(other, opposite)] = {RingUse::keeps, found->second};
      }
    }
  }
}

// Lists the slots that store, slice after slice.
void list_jobs(const NeighbourSlices& slices, const ShiftSlots& slots, Rings& result) {
  for (int slice = 0; slice < slices.count(); ++slice) {
    result.first_job.push_back(static_cast<int>(result.jobs.size()));
    for (int s = slices.slices[slice].shift; s < slices.slices[slice + 1].shift; ++s) {
      if (result.uses[s].kind != RingUse::keeps) continue;
      const Ring& ring = result.rings[result.uses[s].ring];
      const int row = slice * slice_rows, at = row & ring.mask;
      const int copy = at < slice_rows ? ring.begin + ring.mask + 1 + at : -1;
      result.jobs.push_back({row, slices.shifts[s], slots.law_of(slice, s), ring.begin + at, copy});
      if (slices.slot_dashpots.empty()) continue;
      result.job_dashpots.push_back(slices.slot_dashpots[slots.slot_of(slice, s)]);
    }
  }
  result.first_job.push_back(static_cast<int>(result.jobs.size()));
}

// Lists the terms of each slice; slices with the same terms share them, as most of a grid do.
void list_terms(const NeighbourSlices& slices, Rings& result) {
  std::map<std::vector<std::array<int, 2>>, int> known;  // by shift and use
  std::vector<std::array<int, 2>> terms;
  for (int slice = 0; slice < slices.count(); ++slice) {
    const Slice &begin = slices.slices[slice], &end = slices.slices[slice + 1];
    int own = -1;
    terms.clear();
    bool has_all = begin.gather == end.gather && begin.shift < end.shift;
    for (int s = begin.shift; s < end.shift; ++s) {
      has_all &= result.uses[s].kind != RingUse::none;
      terms.push_back({slices.shifts[s], result.uses[s].kind});
      if (result.uses[s].kind == RingUse::finds) {
        const int rows = -slices.shifts[s];
        result.reach = std::max(result.reach, (rows + slice_rows - 1) / slice_rows);
      }
    }
    if (has_all) {
      const auto [found, is_new] = known.try_emplace(terms, std::ssize(result.terms));
      own = found->second;
      for (int s = begin.shift; is_new && s < end.shift; ++s) {
        const auto [kind, number] = result.uses[s];
        const Ring& ring = result.rings[number];
        const int shift = slices.shifts[s];
        result.terms.push_back({shift, kind == RingUse::finds ? shift : 0, ring.mask, ring.begin});
      }
    }
    result.first_term.push_back(own);
  }
}

}  // namespace

Rings rings_of(const NeighbourSlices& slices) {
  Rings result;
  if (slices.law_vectors == 1) return result;  // tau/l is the stiffness
  const ShiftSlots slots(slices);
  share(slices, slots, result);
  // Rings cost time if few slots read: several slots side by side are faster then.
  const auto reads = std::ranges::count(result.uses, RingUse::finds, &RingUse::kind);
  if (reads < worth_rings * static_cast<double>(slices.slot_laws.size())) return {};
  list_jobs(slices, slots, result);
  list_terms(slices, result);
  return result;
}

}  // namespace qddot::kernels
