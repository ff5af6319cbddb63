#pragma once

#include <cstdint>
#include <vector>

namespace qddot::inline measure {

// A sampled step, and the number of steps that it stands for.
struct SampledStep {
  std::int64_t step = 0;
  double weight = 1;
};

// The number of samples in an octave of a run. `few_cells` is for methods that must end a step at
// each sample, so that samples disturb the first steps only.
constexpr int many_cells = 4096, few_cells = 256;

// Samples the steps 1 ... count, equally many in each octave (count/2, count], (count/4, count/2],
// ... An octave is divided into `cells` of equal length, with one step drawn at random from each.
// Octaves with no more steps than cells are taken whole. So a run that ends early is sampled as
// well as a whole one. No oscillation can be in phase with the samples, as it could be at equal
// distances, and every cell sees slow ones. The result is ascending and deterministic. cells >= 1.
std::vector<SampledStep> sample_steps(std::int64_t count, std::int64_t cells);

}  // namespace qddot::inline measure
