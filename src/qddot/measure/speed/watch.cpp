#include "qddot/measure/speed/watch.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/random_times.hpp"

namespace qddot::inline measure {
namespace {

// Momenta and modes of all nodes cost more than the energy; they are taken at so many of the looks.
constexpr std::size_t fewer_looks = 1000;

std::vector<double> looks(const Method& method, const Options& options, double until,
                          std::int64_t steps) {
  if (method.knob == Knob::step_size && method.order > 0)
    return random_step_times(options.step_size, until, Watch::most_looks);
  // The steps of all parts were counted together, but each part has its own.
  const std::int64_t all = method.is(Trait::interpolates) ? steps : steps / 4;
  return random_times(until, std::clamp<std::int64_t>(all, 1, Watch::most_looks));
}

}  // namespace

Watch::Watch(const Scene& start, const Model& scene, double until, const Reference& reference)
    : scene_(scene), until_(until), reference_(reference), momenta_(start) {
  if (reference.modal_shares.size() > 0) modes_ = ModalShares::at_equilibrium(scene);
}

PathErrors Watch::see(const Method& method, const Options& options, std::int64_t steps,
                      double seconds) const {
  State state = scene_.initial();
  const auto nodes = scene_.expand(state);
  const double scale = reference_.scales.kinetic > 0 ? reference_.scales.kinetic : 1;
  double energy = 0, momentum = 0;
  std::vector<State> path;
  std::size_t seen_before = 0;
  const auto times = looks(method, options, until_, steps);
  const std::size_t stride = (times.size() + fewer_looks - 1) / fewer_looks;
  const Observer observer{
      times, [&](const State& now) {
        energy = std::max(energy, std::abs(scene_.energy(now) - reference_.energy) / scale);
        if (++seen_before % stride != 0 && seen_before < times.size()) return;
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
