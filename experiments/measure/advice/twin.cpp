#include "qddot/measure/advice/twin.hpp"

#include "qddot/measure/reference/reference_rounding.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::measure {

std::optional<Divergence> parting_of_twins(const Stage& stage, const Trial& trial, double seconds) {
  const State pushed = displaced_start(stage.model(), stage.scales(), machine_epsilon);
  const Trial twin = stage.run_from(pushed, *trial.method, trial.value, seconds);
  if (!twin.reached_end()) return {};
  std::vector<double> times{0}, distances{machine_epsilon};
  for (std::size_t i = 0; i < stage.times().size(); ++i) {
    times.push_back(stage.times()[i]);
    distances.push_back(stage.distance_at(trial, twin, i));
  }
  return divergence(times, distances);
}

}  // namespace qddot::measure
