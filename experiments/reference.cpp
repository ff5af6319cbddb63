#include "experiments/reference.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>

#include <boost/numeric/odeint.hpp>
#include <fmt/format.h>

#include "experiments/deadline.hpp"
#include "integrators/registry.hpp"
#include "src/analysis/frequency_bound.hpp"
#include "src/analysis/linear_motion.hpp"

namespace qddot {
namespace {

constexpr int most_refinements = 20;
constexpr Index largest_modal_size = 2000;  // a dense eigenproblem of a few seconds

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The end of a motion computed in one way.
struct Solution {
  State end;
  Scales scales;
  double knob;
  std::string made_by;
};

double difference(const ReducedScene& scene, const State& a, const State& b, const Scales& scales) {
  const Errors errors = errors_between(scene, a, b, 0, scales);
  return std::max(errors.position, errors.velocity);
}

// Refines a way of solving until the change stops shrinking: then rounding is all that is left.
// `solve(level)` returns nothing where it did not reach the end.
template <class Solve>
Solution refine(const ReducedScene& scene, double seconds, const Solve& solve) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<Solution> best;
  double change = std::numeric_limits<double>::infinity();
  for (int level = 0; level < most_refinements; ++level) {
    const auto begin = std::chrono::steady_clock::now();
    const std::optional<Solution> next = solve(level);
    if (next && best) {
      const double new_change = difference(scene, next->end, best->end, next->scales);
      if (new_change > change / 2) break;
      change = new_change;
    }
    if (next) best = next;
    if (change == 0 || seconds_since(start) + 2 * seconds_since(begin) > seconds) break;
  }
  if (!best) throw NoReference("no reference: the high-accuracy methods did not reach the end");
  return *best;
}

std::optional<Solution> composition(const ReducedScene& scene, const State& initial, double until,
                                    double h, double seconds) {
  const Method& method = *find_method("kahan_li8");
  const auto integrator = make_integrator(method, scene.system(), {.step_size = h});
  Solution solution{initial, {}, h, fmt::format("kahan_li8 at h = {:.6g} s", h)};
  Deadline deadline(seconds);
  Observer each_step{{}, [&](const State& state) { extend(solution.scales, scene, state); }};
  const auto steps = static_cast<std::int64_t>(std::round(until / h));
  for (std::int64_t i = 1; i < steps; ++i) {
    each_step.times.push_back(until * static_cast<double>(i) / static_cast<double>(steps));
  }
  each_step.times.push_back(until);
  extend(solution.scales, scene, solution.end);
  const Summary summary = integrator->advance(solution.end, until, each_step, deadline.token());
  if (summary.outcome != Outcome::reached_end) return {};
  return solution;
}

// Steps that resolve the fastest frequency at the start: h w = 2, 1, 1/2, ...
Solution best_composition(const ReducedScene& scene, double until, double seconds) {
  const double bound = frequency_bound(scene.system(), scene.initial().q);
  const double coarsest = std::max(16.0, std::ceil(until * bound / 2));
  return refine(scene, seconds, [&](int level) {
    return composition(scene, scene.initial(), until, until / (coarsest * std::exp2(level)),
                       seconds);
  });
}

// Fehlberg 7(8) in the variables (q - q0) / displacement and v / speed, all of order one.
std::optional<Solution> fehlberg(const ReducedScene& scene, double until, double tolerance,
                                 const Scales& scales, double seconds) {
  namespace odeint = boost::numeric::odeint;
  using Stacked = std::vector<double>;
  const System& system = scene.system();
  const State& initial = scene.initial();
  const Index n = system.size();
  const double length = scales.displacement > 0 ? scales.displacement : 1;
  const double speed = scales.speed > 0 ? scales.speed : 1;
  const Vec per_mass = system.mass().cwiseInverse();
  Vec q(n), f(n);

  const auto rate = [&](const Stacked& y, Stacked& dy, double) {
    const Eigen::Map<const Vec> u(y.data(), n), w(y.data() + n, n);
    q = initial.q + length * u;
    system.force(q, f);
    Eigen::Map<Vec>(dy.data(), n) = (speed / length) * w;
    Eigen::Map<Vec>(dy.data() + n, n) = per_mass.cwiseProduct(f) / speed;
  };
  Stacked y(2 * n, 0.0);
  Eigen::Map<Vec>(y.data() + n, n) = initial.v / speed;

  auto stepper =
      odeint::make_controlled<odeint::runge_kutta_fehlberg78<Stacked>>(tolerance, tolerance);
  const Deadline deadline(seconds);
  double t = 0, dt = until / 1000;
  while (t < until) {
    if (deadline.passed() || t + dt == t) return {};
    if (t + dt > until) dt = until - t;
    const bool is_last = t + dt >= until;
    if (stepper.try_step(rate, y, t, dt) == odeint::success && is_last) break;
  }
  return Solution{{until, initial.q + length * Eigen::Map<const Vec>(y.data(), n),
                   speed * Eigen::Map<const Vec>(y.data() + n, n)},
                  scales,
                  tolerance,
                  fmt::format("Boost.odeint Fehlberg 7(8) at tolerance {:.0e}", tolerance)};
}

Solution best_fehlberg(const ReducedScene& scene, double until, const Scales& scales,
                       double seconds) {
  return refine(scene, seconds, [&](int level) -> std::optional<Solution> {
    const double tolerance = std::pow(10.0, -9 - level);
    if (tolerance < 5e-16) return {};
    return fehlberg(scene, until, tolerance, scales, seconds);
  });
}

Reference joined(const ReducedScene& scene, const Solution& one, const Solution& other) {
  const double energy = scene.energy(scene.initial());
  Errors certified = errors_between(scene, one.end, other.end, scene.energy(other.end), one.scales);
  const Errors drift = errors_between(scene, one.end, one.end, energy, one.scales);
  certified.energy = std::max(certified.energy, drift.energy);
  // Two roundings of the same number may agree by chance.
  for (double* part : {&certified.position, &certified.velocity, &certified.energy}) {
    *part = std::max(*part, std::numeric_limits<double>::epsilon());
  }
  Reference reference{.end = one.end,
                      .energy = energy,
                      .scales = one.scales,
                      .certified = certified,
                      .made_by = fmt::format("{}; {}", one.made_by, other.made_by)};
  return reference;
}

// Repeats the composition from a start that is one rounding away.
void measure_rounding(Reference& reference, const ReducedScene& scene, const Solution& composed,
                      double until, double seconds) {
  State start = scene.initial();
  if (start.q.size() == 0) return;
  double extent = 0;
  for (const Node& node : scene.expand(start)) {
    extent = std::max(extent, node.position.lpNorm<Eigen::Infinity>());
  }
  const double rounding = std::numeric_limits<double>::epsilon() * extent;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(-1, 1);
  for (double& x : start.q) x += rounding * part(random);
  const auto moved = composition(scene, start, until, composed.knob, seconds);
  if (!moved || rounding == 0) return;
  const Vec difference = moved->end.q - composed.end.q;
  reference.perturbation_growth = difference.lpNorm<Eigen::Infinity>() / rounding;
  reference.rounding_effect =
      errors_between(scene, moved->end, composed.end, 0, composed.scales).position;
}

}  // namespace

Reference make_reference(const ReducedScene& scene, double until, double seconds) {
  const auto start = std::chrono::steady_clock::now();
  Solution composed = best_composition(scene, until, 0.6 * seconds);
  Reference reference;
  if (scene.system().stiffness_is_constant() && scene.system().size() <= largest_modal_size) {
    const Solution modal{LinearMotion(scene.system()).after(scene.initial(), until),
                         composed.scales, 0, "modal, exact"};
    reference = joined(scene, modal, composed);
  } else {
    reference =
        joined(scene, composed, best_fehlberg(scene, until, composed.scales, 0.4 * seconds));
  }
  measure_rounding(reference, scene, composed, until, seconds);
  reference.seconds = seconds_since(start);
  return reference;
}

}  // namespace qddot
