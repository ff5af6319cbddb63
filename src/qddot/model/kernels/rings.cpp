#include "qddot/model/kernels/rings.hpp"

#include <algorithm>
#include <bit>
#include <map>

namespace qddot::kernels {
namespace {

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
    const int shift = slices_.shifts[s];
    if (shift > -slice_rows || find(slice, shift) != s) return false;
    for (int t = 0; t < slice_rows; ++t) {
      const int other = slice * slice_rows + t + shift, other_slice = other / slice_rows;
      const int opposite = other < 0 ? -1 : find(other_slice, -shift);
      if (opposite < 0 || !is_same(slice, s, t, other_slice, opposite, other % slice_rows)) {
        return false;
      }
    }
    return true;
  }

 private:
  bool is_same(int slice, int s, int t, int other_slice, int opposite, int other_t) const {
    const double *law = law_of(slice, s) + t, *other = law_of(other_slice, opposite) + other_t;
    for (int v = 0; v < slices_.law_vectors; ++v) {
      if (law[v * slice_rows] != other[v * slice_rows]) return false;
    }
    return true;
  }
  const double* law_of(int slice, int s) const {
    const Slice& begin = slices_.slices[slice];
    return slices_.laws.data() + begin.law +
           Index{s - begin.shift} * slices_.law_vectors * slice_rows;
  }

  const NeighbourSlices& slices_;
};

}  // namespace

Rings rings_of(const NeighbourSlices& slices) {
  Rings result;
  result.uses.assign(slices.shifts.size(), {RingUse::none, 0});
  const ShiftSlots slots(slices);
  std::map<int, int> ring_of;  // by the opposite shift
  for (int slice = 0; slice < slices.count(); ++slice) {
    for (int s = slices.slices[slice].shift; s < slices.slices[slice + 1].shift; ++s) {
      if (!slots.has_opposites(slice, s)) continue;
      const int opposite = -slices.shifts[s];
      const auto [found, is_new] = ring_of.try_emplace(opposite, std::ssize(result.rings));
      if (is_new) {
        // The ring spans the rows from a slice's first row to the last row found with it.
        const int rows =
            static_cast<int>(std::bit_ceil(static_cast<unsigned>(opposite + slice_rows)));
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
  return result;
}

}  // namespace qddot::kernels
