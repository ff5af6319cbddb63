#include "qddot/measure/advice/step_cost.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <mutex>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot::inline measure {

double forces_a_step(const Method& method) {
  static std::mutex mutex;
  static std::map<const Method*, double> known;
  const std::lock_guard lock(mutex);
  const auto [place, is_new] = known.try_emplace(&method, 1);
  if (!is_new) return place->second;
  // One mass and one spring of rest length zero with w = 1, on a line.
  constexpr double step = 0.01;  // [s]
  Network network{.dimension = 1, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, Eigen::Vector3d::Zero(), {.stiffness = 1}}};
  const auto system = make_mass_spring(network);
  const auto integrator = make_integrator(method, *system, {.step_size = step});
  const auto forces = [&](int steps) {
    State state{0, Vec::Ones(1), Vec::Zero(1)};
    return static_cast<double>(integrator->advance(state, steps * step).counts.force_evaluations);
  };
  // A method of several steps has begun after as many steps as its order.
  const int begun = 2 * method.order, more = 4;
  place->second = std::max(1.0, (forces(begun + more) - forces(begun)) / more);
  return place->second;
}

double seconds_of_force(const Model& model) {
  Vec f(model.system().size());
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    least = std::min(least, seconds_of([&] { model.system().force(model.initial(), f); }));
  }
  return least;
}

}  // namespace qddot::inline measure
