#include "qddot/model/kernels/slice_parts.hpp"

#include <algorithm>

namespace qddot::kernels {
namespace {

constexpr int slices_of_part = 8 * slices_of_block;
// So a part has the nodes of as many numbers that follow one another.
static_assert(slices_of_part * slice_rows % sorted_rows == 0);
// Fewer slices are one part, as they are of one thread.
constexpr int fewest_for_parts = 512;

int size_of_part(int slices) { return slices < fewest_for_parts ? slices : slices_of_part; }

}  // namespace

SliceParts parts_of(const NeighbourSlices& slices, const std::function<int(int)>& source_of) {
  SliceParts result;
  const int count = slices.count(), size = std::max(size_of_part(count), 1);
  for (int begin = 0; begin < count; begin += size) {
    const int own = result.count();
    int first = own, last = own;
    const auto read = [&](int place) {
      const int row = place < slices.rows() ? place : source_of(place);
      if (row < 0) return;
      const int part = row / slice_rows / size;
      first = std::min(first, part);
      last = std::max(last, part);
    };
    const int end = std::min(begin + size, count);
    for (int slice = begin; slice < end; ++slice) {
      const Slice &from = slices.slices[slice], &to = slices.slices[slice + 1];
      for (int s = from.shift; s < to.shift; ++s) {
        const int place = slice * slice_rows + slices.shifts[s];
        for (int t = 0; t < slice_rows; ++t) read(place + t);
      }
      for (int g = from.gather; g < to.gather; ++g) read(slices.gathers[g]);
    }
    result.parts.push_back({begin, end, first, last + 1});
  }
  std::vector<SliceParts::Part>& parts = result.parts;
  for (int p = 1; p < result.count(); ++p) {
    parts[p].read_end = std::max(parts[p].read_end, parts[p - 1].read_end);
  }
  for (int p = result.count() - 2; p >= 0; --p) {
    parts[p].first_read = std::min(parts[p].first_read, parts[p + 1].first_read);
  }
  return result;
}

}  // namespace qddot::kernels
