#pragma once

#include <memory>
#include <stop_token>
#include <string_view>
#include <vector>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/model.hpp"

namespace qddot {

// The method of that name. Throws std::invalid_argument, which names all methods, if there is none.
const Method& method(std::string_view name);

// The smallest system of a scene for a method, as in the programs. All of `reductions` that the
// method can use are applied. The scene is at its equilibrium if it starts there. Throws
// InvalidInput if the scene is wrong or has no equilibrium.
Model reduced_for(const Method& method, const Scene& scene, const Reductions& reductions = {});

// The motion of a scene, or of a system of the caller's own, by one method. As in the programs, it
// uses the scene's smallest model and its sizes for absolute tolerances (with_tolerance_scales).
class Simulation {
 public:
  // Throws InvalidInput for a wrong scene and std::invalid_argument for options or a system that
  // the method cannot take.
  Simulation(const Scene& scene, const Method& method, const Options& options,
             const Reductions& reductions = {});
  // Runs a model that others may share.
  Simulation(std::shared_ptr<const Model> model, const Method& method, const Options& options);
  // Runs a system of the caller's own; unknowns are ordered by nodes, `dimension` for each.
  Simulation(std::shared_ptr<const System> system, State start, int dimension, const Method& method,
             const Options& options);

  // Continues to t_end [s]; see Integrator::advance. Each call is a run of its own from the end of
  // the last one.
  Summary advance(double t_end, const Observer& observer = {}, std::stop_token stop = {});

  // The present unknowns, nodes of the whole scene [m, m/s], and total energy of the scene [J].
  const State& state() const { return state_; }
  std::vector<Node> nodes() const { return model_->expand(state_); }
  double energy() const { return model_->energy(state_); }
  const Model& model() const { return *model_; }
  // The time [s] that advance() has reached, while it runs on another thread.
  double reached() const { return integrator_->reached(); }
  // The options that the method was given, tolerance scales included.
  const Options& options() const { return options_; }

 private:
  std::shared_ptr<const Model> model_;
  Options options_;
  std::unique_ptr<Integrator> integrator_;
  State state_;
};

}  // namespace qddot
