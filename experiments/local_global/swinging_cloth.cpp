#include "experiments/local_global/swinging_cloth.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::local_global {
namespace {

constexpr double share_of_limit = 0.5;  // h w of the true motion's steps
constexpr double most_steps = 1e7;

Scene draw(int nodes, double stiffness) {
  return generate(*find_generator("cloth"),
                  {{"nodes", nodes},
                   {"mass", 1},
                   {"structural_stiffness", stiffness},
                   {"shear_stiffness", stiffness / 2},
                   {"bending_stiffness", stiffness / 10}},
                  "--nodes");
}

// The motion over `duration` by a quarter of the longest stable step of Verlet's.
State moved(const char* method, const System& system, State state, double duration) {
  const double h = share_of_limit / frequency_bound(system, state.q);
  const Summary summary = make_integrator(*find_method(method), system, {.step_size = h})
                              ->advance(state, state.t + duration, {}, interruption());
  stop_if_interrupted();
  if (summary.outcome != Outcome::reached_end) {
    throw NoReference(fmt::format("the cloth's own motion ends at {:.4g} s: {}", summary.t_reached,
                                  summary.message));
  }
  return state;
}

}  // namespace

void require_swing(double t, const std::string& option) {
  if (std::isfinite(t) && t >= 0) return;
  throw InvalidInput(
      fmt::format("{} {} is not allowed; it is a time in s, finite and at least 0", option, t));
}

void require_reachable(int nodes, double stiffness, double duration, const std::string& option) {
  // Gershgorin's bound at a node within: 4 k, 4 k/2 and 4 k/10 pull at it, as much at its
  // neighbours, and its mass is 1/nodes^2.
  const double w = nodes * std::sqrt(2 * (4 + 2 + 0.4) * stiffness);
  const double longest = most_steps * share_of_limit / w;
  if (duration <= longest) return;
  throw InvalidInput(
      fmt::format("{} {:g} is not allowed; it is at most {:.3g} s, after which the motion of a "
                  "cloth of {} x {} "
                  "nodes and {:g} N/m takes more than {:g} steps",
                  option, duration, longest, nodes, nodes, stiffness, most_steps));
}

SwingingCloth::SwingingCloth(int nodes, double stiffness, double swing)
    : drawn(draw(nodes, stiffness)),
      scene(drawn, Reductions().without(Reduction::mirror)),
      start(swing > 0 ? moved("verlet", system(), scene.initial(), swing) : scene.initial()) {}

State SwingingCloth::truth(const State& state, double duration) const {
  return moved("kahan_li8", system(), state, duration);
}

double SwingingCloth::distance(const State& a, const State& b) const {
  const auto x = scene.expand(a), y = scene.expand(b);
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    largest = std::max(largest, (x[i].position - y[i].position).norm());
  }
  return largest;
}

void require_affordable(int nodes, double stiffness, double h, double until) {
  constexpr double allowed_steps = 1e6;
  if (const double steps = until / h; !(steps <= allowed_steps)) {
    throw InvalidInput(fmt::format(
        "--step-size {:g}: the runs of {:g} s (--until) are {:.3g} steps; allowed are up to {:g}",
        h, until, steps, allowed_steps));
  }
  require_reachable(nodes, stiffness, h, "--step-size");
  require_reachable(nodes, stiffness, until, "--until");
}

}  // namespace qddot::local_global
