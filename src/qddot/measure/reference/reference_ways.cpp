#include "qddot/measure/reference/reference_ways.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/numeric/odeint.hpp>
#include <fmt/format.h>

#include "qddot/algebra/multipliers.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/breaks.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/random_times.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

constexpr std::int64_t longest_path = 100;
// The most samples for the scales of a run; a longer list of times costs more than it shows.
constexpr std::int64_t most_looks = 1'000'000;
constexpr double safety = 2;

// Times from `start` to `end` [s], in one piece of forces in time (see At).
struct Piece {
  double start, end;

  double middle() const { return start + (end - start) / 2; }
};

// The pieces from 0 to `until`: one, unless forces in time have corners.
std::vector<Piece> pieces_of(const System& system, double until) {
  std::vector<Piece> pieces;
  double start = 0;
  if (const Driving* driving = system.driving()) {
    for (const Corner& corner : driving->corners()) {
      if (corner.t > start && corner.t < until) pieces.push_back({start, corner.t});
      start = std::max(start, std::min(corner.t, until));
    }
  }
  pieces.push_back({start, until});
  return pieces;
}

// Advances q and v over a piece, with errors in units of `length` [m] and `speed` [m/s], and adds
// the work of friction and driving [J]. Returns false if the deadline passes before.
bool fehlberg_step_by_step(const System& system, Eigen::Ref<Vec> q, Eigen::Ref<Vec> v,
                           const Piece& piece, double tolerance, double length, double speed,
                           Work& work, const Deadline& deadline) {
  namespace odeint = boost::numeric::odeint;
  using Stacked = std::vector<double>;
  const Index n = system.size();
  const Vec start = q, per_mass = system.mass().cwiseInverse();
  const Damping* damping = system.damping();
  const Driving* driving = system.driving();
  const Constraints* constraints = system.constraints();
  Multipliers multipliers(system);
  Vec moving(multipliers.count());
  const double energy = system.mass().sum() * speed * speed;  // unit of work
  const double until = piece.end - piece.start;
  Vec now(n), fast(n), f(n), friction(n);

  const auto rate = [&](const Stacked& y, Stacked& dy, double s) {
    const Eigen::Map<const Vec> u(y.data(), n), w(y.data() + n, n);
    now = start + length * u;
    fast = speed * w;
    const auto in_piece = [&](At at) {
      at.within = piece.middle();
      return at;
    };
    const double now_t = piece.start + s;
    system.force(in_piece({now_t, now}), f);
    if (damping) {
      damping->friction(in_piece({now_t, now, fast}), friction);
      f += friction;
      dy[2 * n] = -friction.dot(fast) / energy;
    }
    if (driving) {
      const Work power = driving->driving_power(in_piece({now_t, now, fast}));
      dy[2 * n] = ((damping ? -friction.dot(fast) : 0) + power.dissipated) / energy;
      dy[2 * n + 1] = power.driven / energy;
    }
    if (constraints) {
      // The forces that keep constraints, as functions of places and velocities (index 1).
      const At at = in_piece({now_t, now, fast});
      multipliers.take_gradients(at);
      multipliers.factorize();
      const Vec& lambda = multipliers.forces_at(at, f);
      f -= multipliers.gradients().transpose() * lambda;
      if (driving) {
        constraints->constraint_rates(at, moving);
        dy[2 * n + 1] += lambda.dot(moving) / energy;
      }
    }
    Eigen::Map<Vec>(dy.data(), n) = (speed / length) * w;
    Eigen::Map<Vec>(dy.data() + n, n) = per_mass.cwiseProduct(f) / speed;
  };
  Stacked y(2 * n + (driving ? 2 : damping ? 1 : 0), 0.0), end(y.size());
  Eigen::Map<Vec>(y.data() + n, n) = v / speed;

  auto stepper =
      odeint::make_controlled<odeint::runge_kutta_fehlberg78<Stacked>>(tolerance, tolerance);
  // The time t and its rounding error `rest`: the sum of thousands of steps must be the end.
  double t = 0, rest = 0, dt = until / 1000;
  for (bool is_over = until == 0; !is_over;) {
    if (deadline.passed() || t + dt == t) return false;
    const double left = (until - t) - rest;
    const bool is_last = dt >= left;
    if (is_last) dt = left;
    const double taken = dt;
    double unused = t;
    if (stepper.try_step(rate, y, unused, end, dt) != odeint::success) continue;
    // An error that is no number does not fail a step: that of a step too long for numbers.
    if (!Eigen::Map<const Vec>(end.data(), 2 * n).allFinite()) {
      dt = taken / 2;
      continue;
    }
    y.swap(end);
    const double more = taken + rest, next = t + more;
    rest = more - (next - t);
    t = next;
    is_over = is_last;
  }
  q = start + length * Eigen::Map<const Vec>(y.data(), n);
  v = speed * Eigen::Map<const Vec>(y.data() + n, n);
  if (driving || damping) work.dissipated += energy * y[2 * n];
  if (driving) work.driven += energy * y.back();
  return true;
}

}  // namespace

std::optional<Solution> seen_run(const Model& scene, const Method& method, const Options& options,
                                 const State& initial, const std::vector<double>& times,
                                 double seconds) {
  const auto integrator = make_integrator(method, scene.system(), options);
  Solution solution{.end = initial};
  const Deadline deadline(seconds);
  const auto looks = static_cast<double>(times.size());
  const auto kept = random_step_times(1, looks, longest_path);  // looks, counted from one
  double seen = 0;
  const Observer each{times, [&](const State& state) {
                        extend(solution.scales, scene, state);
                        if (++seen == kept[solution.path.size()]) solution.path.push_back(state);
                      }};
  extend(solution.scales, scene, solution.end);
  const Summary summary = integrator->advance(solution.end, times.back(), each, deadline.token());
  stop_if_interrupted();
  if (summary.outcome != Outcome::reached_end) return {};
  solution.breaks = summary.breaks;
  return solution;
}

const Method& resolving_method(const System& system) {
  if (is_constrained(system)) return *find_method("rattle8");
  const Method& composed = *find_method("kahan_li8");
  return applies_to(composed, system) ? composed : *find_method("rk8");
}

std::optional<Solution> composition(const Model& scene, const State& initial, double until,
                                    double h, double seconds) {
  const Method& method = resolving_method(scene.system());
  auto solution = seen_run(scene, method, {.step_size = h}, initial,
                           random_step_times(h, until, most_looks), seconds);
  if (!solution) return {};
  solution->knob = h;
  solution->made_by = fmt::format("{} at h = {:.6g} s", method.name, h);
  return solution;
}

// The same by a method that lands its steps on the moments at which springs go slack or break.
std::optional<Solution> by_error_control(const Model& scene, double until, double tolerance,
                                         double seconds) {
  const double rtol = std::max(tolerance, least_rtol);
  const Method& method = *find_method("arkode_erk8");
  auto solution = seen_run(scene, method, with_tolerance_scales({.rtol = rtol}, scene),
                           scene.initial(), {until}, seconds);
  if (!solution) return solution;
  solution->knob = tolerance;
  solution->made_by = fmt::format("{} at rtol = {:.0e}", method.name, rtol);
  return solution;
}

std::optional<Solution> fehlberg(const Model& scene, double until, double tolerance,
                                 const Scales& scales, double seconds) {
  const System& system = scene.system();
  if (system.switching()) return by_error_control(scene, until, tolerance, seconds);
  const auto parts = system.blocks();
  Solution solution{.end = scene.initial(), .scales = scales, .knob = tolerance};
  solution.end.t = until;
  const Deadline deadline(seconds);
  const bool has_scales = scales.parts.size() == std::max<std::size_t>(parts.size(), 1);
  Index at = 0;
  for (std::size_t i = 0; i < std::max<std::size_t>(parts.size(), 1); ++i) {
    const System& part = parts.empty() ? system : *parts[i];
    auto q = solution.end.q.segment(at, part.size()), v = solution.end.v.segment(at, part.size());
    const double length =
                     has_scales ? scales.displacement_of(scales.parts[i]) : scales.displacement,
                 speed = has_scales ? scales.speed_of(scales.parts[i]) : scales.speed;
    for (const Piece& piece : pieces_of(part, until)) {
      if (fehlberg_step_by_step(part, q, v, piece, tolerance, length > 0 ? length : 1,
                                speed > 0 ? speed : 1, solution.end.work, deadline))
        continue;
      stop_if_interrupted();
      return {};
    }
    at += part.size();
  }
  solution.made_by = fmt::format("Boost.odeint Fehlberg 7(8) at tolerance {:.0e}", tolerance);
  return solution;
}

namespace {

// Throws NoReference unless both solutions break the same springs, in an order that is beyond their
// errors.
void require_same_breaks(const Model& scene, const Solution& one, const Solution& other) {
  std::vector<double> errors;
  for (const Break& own : one.breaks) {
    const auto same = std::ranges::find(other.breaks, own.number, &Break::number);
    const double apart = same == other.breaks.end() ? std::numeric_limits<double>::infinity()
                                                    : std::abs(same->t - own.t);
    errors.push_back(safety * apart + rounding_of_moment(own.t));
  }
  const bool are_same = one.breaks.size() == other.breaks.size() &&
                        std::ranges::none_of(errors, [](double e) { return std::isinf(e); });
  std::string why = unclear_order(one.breaks, errors, scene.general_springs());
  if (!are_same) why = "other springs break by the two methods";
  if (!why.empty())
    throw NoReference(fmt::format("no reference: {}: ask for an earlier end (--until)", why));
}

}  // namespace

Reference joined(const Model& scene, const Solution& one, const Solution& other,
                 const Errors& rounding_effect) {
  require_same_breaks(scene, one, other);
  const double energy = scene.energy(scene.initial());
  Errors certified = errors_between(scene, one.end, other.end, scene.energy(other.end), one.scales);
  certified = larger(certified, larger(rounding_effect, larger(one.change, other.change)));
  const Errors drift = errors_between(scene, one.end, one.end, energy, one.scales);
  certified.energy = std::max(certified.energy, drift.energy);
  for (double* part : {&certified.position, &certified.velocity, &certified.energy})
    *part = std::max(safety * *part, machine_epsilon);
  // Two roundings of one number may agree by chance.
  for (const PartScale& part : one.scales.parts) {
    const double displacement = one.scales.displacement_of(part);
    certified.position = std::max(
        certified.position, machine_epsilon * part.extent / (displacement > 0 ? displacement : 1));
  }
  Reference reference{.end = one.end,
                      .energy = energy,
                      .scales = one.scales,
                      .certified = certified,
                      .made_by = fmt::format("{}; {}", one.made_by, other.made_by)};
  return reference;
}

}  // namespace qddot::inline measure
