#pragma once

#include <memory>
#include <stop_token>
#include <string_view>
#include <vector>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot {

// The method of that name; throws std::invalid_argument, naming all there are, where there is none.
const Method& method(std::string_view name);

// The smallest system of a scene as the programs make it for a method: at its equilibrium where the
// scene starts there, and with all of `reductions` that the method can use. Throws InvalidInput
// where the scene is wrong or has no equilibrium.
ReducedScene reduced_for(const Method& method, const Scene& scene,
                         const Reductions& reductions = {});

// The motion of a scene, or of a system of the caller's own, by one method: as the programs run it,
// with the scene's smallest model and its sizes for absolute tolerances (with_tolerance_scales).
class Simulation {
 public:
  // Throws InvalidInput for a wrong scene and std::invalid_argument for options or a system that
  // the method cannot take.
  Simulation(const Scene& scene, const Method& method, const Options& options,
             const Reductions& reductions = {});
  // Runs a model that others may use as well.
  Simulation(std::shared_ptr<const ReducedScene> model, const Method& method,
             const Options& options);
  // Runs an own system, node after node with `dimension` unknowns.
  Simulation(std::shared_ptr<const System> system, State start, int dimension, const Method& method,
             const Options& options);

  // Runs on to t_end [s]; see Integrator::advance. Each call is a run of its own, which begins
  // where the last one ended.
  Summary advance(double t_end, const Observer& observer = {}, std::stop_token stop = {});

  // The unknowns now; all nodes of the scene now [m, m/s]; all energy of the scene now [J].
  const State& state() const { return state_; }
  std::vector<Node> nodes() const { return model_->expand(state_); }
  double energy() const { return model_->energy(state_); }
  const ReducedScene& model() const { return *model_; }
  // The options as the method has them, tolerance scales included.
  const Options& options() const { return options_; }

 private:
  std::shared_ptr<const ReducedScene> model_;
  Options options_;
  std::unique_ptr<Integrator> integrator_;
  State state_;
};

}  // namespace qddot
