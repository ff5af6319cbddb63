#include "qddot/measure/trend/motion_scales.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/kinetic_frequency.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::inline measure {
namespace {

constexpr double resolution = 0.5;  // h w_max
constexpr int most_steps = 20000;
constexpr double fine_rtol = 1e-6;
constexpr double longest_run = 20;  // [s], for scenes too large for studies of 10^6 steps

// Extends the scales by the magnitudes of states of a motion.
class Look {
 public:
  Look(const Model& scene, const Momenta& momenta, MotionScales& scales)
      : scene_(scene), momenta_(momenta), scales_(scales) {}

  void at(const State& state) {
    // Only the integrated motion counts: a fall in closed form has no error.
    const bool is_integrated = scene_.system().size() > 0;
    const double kinetic = is_integrated ? scene_.system().kinetic(state.v) : scene_.kinetic(state);
    const double potential = scene_.energy(state) - kinetic;
    if (!std::isfinite(kinetic + potential)) return;
    scales_.kinetic = std::max(scales_.kinetic, kinetic);
    if (scene_.system().driving())
      scales_.kinetic = std::max(scales_.kinetic, throughput(state.work));
    size_ = std::max(size_, kinetic + std::abs(potential));
    frequency_.see(state);
    if (!momenta_.any_kept()) return;
    const auto nodes = scene_.expand(state);
    scales_.linear = std::max(scales_.linear, momenta_.linear_size(nodes));
    scales_.angular = std::max(scales_.angular, momenta_.angular_size(nodes));
  }

  void finish() {
    scales_.frequency = frequency_.value();
    const double energy = std::abs(scales_.energy);
    if (scales_.kinetic == 0) scales_.kinetic = energy > 0 ? energy : 1;
    if (scales_.linear == 0) scales_.linear = 1;
    if (scales_.angular == 0) scales_.angular = 1;
    scales_.rounding = machine_epsilon * size_ / scales_.kinetic;
  }

 private:
  const Model& scene_;
  const Momenta& momenta_;
  MotionScales& scales_;
  KineticFrequency frequency_{scene_.system()};
  double size_ = 0;
};

}  // namespace

double fastest_frequency(const Model& scene) {
  const System& system = scene.system();
  const Vec& q = scene.initial().q;
  const double w = largest_frequency(system, q);
  if (std::isfinite(w)) return w;
  const Vec squares = highest_modes(system, q, 1).squares;
  return squares.size() > 0 ? std::sqrt(std::max(squares[0], 0.0)) : 0;
}

MotionScales motion_scales(const Model& scene, const Momenta& momenta, double until) {
  MotionScales scales{
      .energy = scene.energy(scene.initial()), .kinetic = 0, .linear = 0, .angular = 0};
  Look look(scene, momenta, scales);
  look.at(scene.initial());

  const bool has_k = scene.system().has_stiffness();
  const double w = has_k ? fastest_frequency(scene) : 0;
  const double h = w > 0 ? std::min(resolution / w, until) : until / most_steps;
  const int steps = static_cast<int>(std::min<double>(most_steps, until / h));
  // At every step: no vibration is in step with that.
  Observer observer{{}, [&](const State& state) { look.at(state); }};
  for (int k = 1; k <= steps; ++k) observer.times.push_back(k * h);
  const bool is_massless = scene.system().has_massless();
  const bool has_dashpots = scene.system().damping() && scene.system().damping()->has_dashpots();
  const Method& method = *find_method(is_constrained(scene.system()) ? "arkode_erk8_rods"
                                      : is_massless  ? (has_dashpots ? "bdf2" : "ida")
                                      : has_dashpots ? "rk4"
                                      : has_k        ? "blanes_moan4"
                                                     : "dprkn8");
  const double knob = method.knob == Knob::rtol ? fine_rtol : h;
  State state = scene.initial();
  const Deadline deadline(longest_run);
  make_integrator(method, scene.system(), options_for(method, knob, scene))
      ->advance(state, steps * h, observer, deadline.token());
  look.finish();
  if (!has_k) return scales;

  const Equilibrium rest = equilibrium_of(scene);
  if (rest.outcome == Equilibrium::Outcome::reached) {
    const State still{0, rest.q, Vec::Zero(rest.q.size())};
    const double excess = (scales.energy - scene.energy(still)) / scales.kinetic;
    if (excess > 0) scales.excess = excess;
  }
  return scales;
}

}  // namespace qddot::inline measure
