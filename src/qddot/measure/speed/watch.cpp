#include "qddot/measure/speed/watch.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"

namespace qddot::inline measure {
namespace {

std::vector<double> looks(const Method& method, const Options& options, double until,
                          std::int64_t steps) {
  const bool fixed = method.knob == Knob::step_size && method.order > 0;
  // The steps of all parts were counted together, but each part has its own.
  const double whole =
      fixed ? std::round(until / options.step_size) : std::floor(static_cast<double>(steps) / 4);
  const double count = std::clamp(whole, 1.0, Watch::most_looks);
  std::vector<double> times;
  for (double i = 1; i < count; ++i) {
    times.push_back(fixed ? std::round(i / count * whole) * options.step_size : i / count * until);
  }
  times.push_back(until);
  return times;
}

}  // namespace

Watch::Watch(const Scene& start, const ReducedScene& scene, double until,
             const Reference& reference)
    : scene_(scene), until_(until), reference_(reference), momenta_(start) {
  if (reference.modal_shares.size() > 0) modes_ = ModalShares::at_equilibrium(scene);
}

PathErrors Watch::see(const Method& method, const Options& options, std::int64_t steps,
                      double seconds) const {
  State state = scene_.initial();
  const auto nodes = scene_.expand(state);
  double energy = 0, momentum = 0;
  std::vector<State> path;
  const Observer observer{
      looks(method, options, until_, steps), [&](const State& now) {
        energy = std::max(
            energy, errors_between(scene_, now, now, reference_.energy, reference_.scales).energy);
        if (momenta_.any_kept()) {
          momentum = std::max(
              momentum, momenta_.change(nodes, scene_.expand(now), now.t, reference_.scales.speed));
        }
        if (modes_) path.push_back(now);
      }};
  const auto integrator = make_integrator(method, scene_.system(), options);
  const Deadline deadline(seconds);
  const Summary summary = integrator->advance(state, until_, observer, deadline.token());
  PathErrors seen;
  if (summary.outcome != Outcome::reached_end) return seen;
  seen.energy = energy;
  if (momenta_.any_kept()) seen.momentum = momentum;
  if (modes_) seen.modal_shares = total_variation(modes_->mean(path), reference_.modal_shares);
  return seen;
}

}  // namespace qddot::inline measure
