#include "experiments/reference.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "experiments/modal_shares.hpp"
#include "experiments/reference_ways.hpp"
#include "src/analysis/frequency_bound.hpp"
#include "src/analysis/linear_motion.hpp"

namespace qddot {
namespace {

constexpr int most_refinements = 20;
constexpr int most_lost_levels = 3;
constexpr Index largest_modal_size = 2000;  // a dense eigenproblem of a few seconds

double difference(const ReducedScene& scene, const State& a, const State& b, const Scales& scales) {
  const Errors errors = errors_between(scene, a, b, 0, scales);
  return std::max(errors.position, errors.velocity);
}

// Refines a way of solving until the change stops shrinking: then rounding is all that is left. Of
// a chaotic motion, changes may be as large as the motion for some levels before they begin to
// shrink. `solve(level)` returns nothing where it did not reach the end.
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
      if (new_change > change / 2 && (new_change < apart || level >= most_lost_levels)) break;
      change = new_change;
    }
    if (next) best = next;
    if (change == 0 || seconds_since(start) + 2 * seconds_since(begin) > seconds) break;
  }
  if (!best) throw NoReference("no reference: the high-accuracy methods did not reach the end");
  return *best;
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

Solution best_fehlberg(const ReducedScene& scene, double until, const Scales& scales,
                       double seconds) {
  return refine(scene, seconds, [&](int level) -> std::optional<Solution> {
    const double tolerance = std::pow(10.0, -9 - level);
    if (tolerance < 5e-16) return {};
    return fehlberg(scene, until, tolerance, scales, seconds);
  });
}

// The largest coordinate of a node at the start [m].
double extent(const ReducedScene& scene) {
  double largest = 0;
  for (const Node& node : scene.expand(scene.initial())) {
    largest = std::max(largest, node.position.lpNorm<Eigen::Infinity>());
  }
  return largest;
}

// The start with each unknown moved by up to `distance` [m], at random.
State displaced_start(const ReducedScene& scene, double distance) {
  State start = scene.initial();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(-1, 1);
  for (double& x : start.q) x += distance * part(random);
  return start;
}

// Repeats the composition from a start that is one rounding away.
void measure_rounding(Reference& reference, const ReducedScene& scene, const Solution& composed,
                      double until, double seconds) {
  const double rounding = std::numeric_limits<double>::epsilon() * extent(scene);
  if (scene.system().size() == 0 || rounding == 0) return;
  const State start = displaced_start(scene, rounding);
  const auto moved = composition(scene, start, until, composed.knob, seconds);
  if (!moved) return;
  const Vec difference = moved->end.q - composed.end.q;
  reference.perturbation_growth = difference.lpNorm<Eigen::Infinity>() / rounding;
  reference.rounding_effect =
      errors_between(scene, moved->end, composed.end, 0, composed.scales).position;

  std::vector<double> times, differences;
  const auto compare = [&](const State& one, const State& other) {
    times.push_back(one.t);
    differences.push_back(errors_between(scene, one, other, 0, composed.scales).position);
  };
  compare(scene.initial(), start);
  for (std::size_t i = 0; i < moved->path.size(); ++i) compare(composed.path[i], moved->path[i]);
  const Divergence parting = divergence(times, differences);
  reference.horizon = parting.horizon;
  reference.lyapunov = parting.lyapunov;
}

// Repeats it from a start that is known to half as many digits. As differences grow exponentially,
// that is apart in half the time: during all of the later half of a run beyond the horizon, in
// which the two have nothing in common but what every such motion has.
void measure_shares(Reference& reference, const ReducedScene& scene, const Solution& composed,
                    double until, double seconds) {
  const auto modes = ModalShares::at_equilibrium(scene);
  if (!modes) return;
  const double distance = std::sqrt(std::numeric_limits<double>::epsilon()) * extent(scene);
  const auto other =
      composition(scene, displaced_start(scene, distance), until, composed.knob, seconds);
  if (!other) return;
  reference.modal_shares = modes->mean(composed.path);
  reference.modal_shares_floor = total_variation(reference.modal_shares, modes->mean(other->path));
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
  if (reference.is_beyond_horizon()) measure_shares(reference, scene, composed, until, seconds);
  reference.seconds = seconds_since(start);
  return reference;
}

}  // namespace qddot
