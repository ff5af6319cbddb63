#include "qddot/measure/trend/sample_steps.hpp"

#include <algorithm>
#include <random>

namespace qddot::inline measure {

std::vector<SampledStep> sample_steps(std::int64_t count, std::int64_t cells) {
  std::mt19937_64 random(1);
  std::vector<SampledStep> sampled;  // backwards
  std::int64_t high = count;
  for (; high > 2 * cells; high /= 2) {
    const std::int64_t low = high / 2, steps = high - low;
    for (std::int64_t cell = cells; cell-- > 0;) {
      const std::int64_t first = low + 1 + steps * cell / cells;
      const std::int64_t last = low + steps * (cell + 1) / cells;
      // In the last cell the last step is taken: a run is looked at there anyway.
      const std::int64_t drawn = std::uniform_int_distribution(first, last)(random);
      sampled.push_back({last == count ? count : drawn, static_cast<double>(last - first + 1)});
    }
  }
  for (; high > 0; --high) sampled.push_back({high, 1});
  std::ranges::reverse(sampled);
  return sampled;
}

}  // namespace qddot::inline measure
