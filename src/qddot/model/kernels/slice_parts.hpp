#pragma once

#include <functional>
#include <vector>

#include "qddot/model/kernels/neighbour_slices.hpp"

namespace qddot::kernels {

// The slices in parts that follow one another. Forces are summed part by part: a part's positions
// are placed just before the first part that reads them, so that they still stand in a near cache.
struct SliceParts {
  struct Part {
    int begin, end;  // its slices
    // Parts from `first_read` on are read by this part and all after it, and parts before
    // `read_end` are all that this part and those before it read.
    int first_read, read_end;
  };
  std::vector<Part> parts;

  int count() const { return static_cast<int>(parts.size()); }
};

// `source_of` returns the row whose position stands at a place that is no row, or -1 if that is
// constant. What a slot finds in a ring is of springs whose ends it reads, too.
SliceParts parts_of(const NeighbourSlices& slices, const std::function<int(int)>& source_of);

}  // namespace qddot::kernels
