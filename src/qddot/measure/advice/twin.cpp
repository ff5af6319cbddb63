#include "qddot/measure/advice/twin.hpp"

#include "qddot/measure/reference/reference_rounding.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {

std::optional<Divergence> parting_of_twins(const Stage& stage, const Trial& trial, double seconds) {
  const State pushed = displaced_start(stage.model(), stage.scales(), machine_epsilon);
  const Trial twin = stage.run_from(pushed, *trial.method, trial.value, seconds);
  if (!twin.reached_end()) return {};
  const std::vector<double> seen = stage.distances(trial, twin);
  if (seen.empty()) return {};
  std::vector<double> times{0}, distances{machine_epsilon};
  times.insert(times.end(), stage.times().begin(), stage.times().end());
  distances.insert(distances.end(), seen.begin(), seen.end());
  return divergence(times, distances);
}

}  // namespace qddot::inline measure
