#include "qddot/measure/advice/step_cost.hpp"

#include <algorithm>
#include <limits>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline measure {

double forces_a_step(const Method& method, const ReducedScene& model, double h) {
  const auto integrator = make_integrator(method, model.system(), options_for(method, h, model));
  const auto forces = [&](double steps) {
    State state = model.initial();
    return static_cast<double>(
        integrator->advance(state, steps * h).counts.force_evaluations);
  };
  // A method of several steps has begun after as many steps as its order.
  const double begun = method.order + 1, more = 2;
  const double parts = std::max<double>(1, static_cast<double>(model.unknowns_by_part().size()));
  return std::max(1.0, (forces(begun + more) - forces(begun)) / more / parts);
}

double seconds_of_force(const ReducedScene& model) {
  Vec f(model.system().size());
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    least = std::min(least, seconds_of([&] { model.system().force(model.initial().q, f); }));
  }
  return least;
}

}  // namespace qddot::inline measure
