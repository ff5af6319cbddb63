#include "qddot/measure/motion/simulation.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/integrators/misfit_words.hpp"
#include "qddot/integrators/nearest_name.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot {

const Method& method(std::string_view name) {
  if (const Method* found = find_method(name)) return *found;
  if (const std::string why = why_not_built(name); !why.empty()) throw std::invalid_argument(why);
  std::vector<std::string> all;
  for (const Method& other : methods()) all.push_back(other.name);
  const std::string nearest = nearest_name(name, all);
  throw std::invalid_argument(fmt::format("{} is no method{}; there are {}", name,
                                          nearest.empty() ? "" : ", the nearest is " + nearest,
                                          fmt::join(all, ", ")));
}

Model reduced_for(const Method& method, const Scene& scene, const Reductions& reductions) {
  const std::optional<Scene> settled = settled_if_asked(scene, scene.name);
  const Scene& start = settled ? *settled : scene;
  // Springs in series equal one spring in tension only. Methods that accept massless nodes run
  // without this reduction.
  return Model(start, method.is(Trait::accepts_massless) ? reductions.without(Reduction::massless)
                                                         : reductions);
}

Simulation::Simulation(const Scene& scene, const Method& method, const Options& options,
                       const Reductions& reductions)
    : Simulation(std::make_shared<const Model>(reduced_for(method, scene, reductions)), method,
                 options) {}

Simulation::Simulation(std::shared_ptr<const System> system, State start, int dimension,
                       const Method& method, const Options& options)
    : Simulation(std::make_shared<const Model>(std::move(system), std::move(start), dimension),
                 method, options) {}

Simulation::Simulation(std::shared_ptr<const Model> model, const Method& method,
                       const Options& options)
    : model_(std::move(model)),
      options_(measure::with_tolerance_scales(options, *model_)),
      state_(model_->initial()) {
  if (const auto why = misfit(method, model_->system()))
    throw std::invalid_argument(fmt::format("{}: {}", method.name, misfit_words(method, *why)));
  integrator_ = make_integrator(method, model_->system(), options_);
}

Summary Simulation::advance(double t_end, const Observer& observer, std::stop_token stop) {
  return integrator_->advance(state_, t_end, observer, std::move(stop));
}

}  // namespace qddot
