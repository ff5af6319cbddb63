#pragma once

#include <cstdint>
#include <vector>

namespace qddot::measure {

// A step to look at, and how many it stands for.
struct SampledStep {
  std::int64_t step = 0;
  double weight = 1;
};

// Samples in an octave of a run; and of methods whose steps have to end where they are looked at,
// which would disturb them: so few that it matters to none but their first steps.
constexpr int many_cells = 4096, few_cells = 256;

// Some of the steps 1 ... count, as many in each octave (count/2, count], (count/4, count/2], ...:
// `cells` of equal length, of each of which one step is drawn at random, until there are no more
// steps than cells, which are all taken. So a run that ends early has been seen as well as a whole
// one; and no oscillation is in step with the samples, as it could be with equal distances, while
// slow ones are seen by every cell. The same for the same arguments. cells >= 1; ascending.
std::vector<SampledStep> sample_steps(std::int64_t count, std::int64_t cells);

}  // namespace qddot::measure
