#include "experiments/reference_ways.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <boost/numeric/odeint.hpp>
#include <fmt/format.h>

#include "experiments/deadline.hpp"
#include "integrators/registry.hpp"

namespace qddot {
namespace {

constexpr std::int64_t longest_path = 100;

}  // namespace

std::optional<Solution> seen_run(const ReducedScene& scene, const Method& method,
                                 const Knobs& knobs, const State& initial, double until,
                                 std::int64_t samples, double seconds) {
  const auto integrator = make_integrator(method, scene.system(), knobs);
  Solution solution{.end = initial};
  const Deadline deadline(seconds);
  const std::int64_t stride = (samples + longest_path - 1) / longest_path;
  std::int64_t seen = 0;
  Observer each{{}, [&](const State& state) {
                  extend(solution.scales, scene, state);
                  if (++seen % stride == 0 || seen == samples) solution.path.push_back(state);
                }};
  for (std::int64_t i = 1; i < samples; ++i) {
    each.times.push_back(until * static_cast<double>(i) / static_cast<double>(samples));
  }
  each.times.push_back(until);
  extend(solution.scales, scene, solution.end);
  const Summary summary = integrator->advance(solution.end, until, each, deadline.token());
  if (summary.outcome != Outcome::reached_end) return {};
  return solution;
}

std::optional<Solution> composition(const ReducedScene& scene, const State& initial, double until,
                                    double h, double seconds) {
  const auto steps = static_cast<std::int64_t>(std::round(until / h));
  auto solution =
      seen_run(scene, *find_method("kahan_li8"), {.step_size = h}, initial, until, steps, seconds);
  if (!solution) return {};
  solution->knob = h;
  solution->made_by = fmt::format("kahan_li8 at h = {:.6g} s", h);
  return solution;
}

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

}  // namespace qddot
