// The first phase of a search: a run from which all forecasts follow, or one that already answers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"

namespace qddot::inline measure {
namespace {

double seconds_of_force(const ReducedScene& model) {
  Vec f(model.system().size());
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    least = std::min(least, seconds_of([&] { model.system().force(model.initial().q, f); }));
  }
  return least;
}

// w_max [rad/s] at the start to some percent, at a cost that is small beside the run.
double frequency_at_start(const ReducedScene& model, double until, double bound) {
  const System& system = model.system();
  const Vec& q = model.initial().q;
  constexpr Index small = 300;
  // Thirty products with K cost as much as about a hundred forces. They give a value that is some
  // percent too small.
  constexpr double worth_searching = 600, from_below = 1.02;
  if (system.size() <= small) return largest_frequency(system, q);
  if (until * bound < 2 * worth_searching) return bound;
  return std::min(bound, from_below * frequency_at_least(system, q));
}

// The factor by which w_max grows over the path, from the growth of its bound.
double growth_of_frequency(const ReducedScene& model, const std::vector<State>& path, double bound,
                           double steps) {
  if (model.system().stiffness_is_constant() || bound == 0) return 1;
  // A bound costs as much as about 17 forces.
  const std::size_t seen =
      std::min(path.size(), static_cast<std::size_t>(std::clamp(steps / 400, 1.0, 12.0)));
  double most = bound;
  for (std::size_t i = 1; i <= seen; ++i)
    most = std::max(most, frequency_bound(model.system(), path[i * path.size() / seen - 1].q));
  return most / bound;
}

// A burst costs as much as about 25 forces.
int number_of_bursts(double steps, double seconds) {
  constexpr double no_time = 1e-3;
  return static_cast<int>(std::clamp(steps / (seconds < no_time ? 80 : 250), 2.0, 16.0));
}

}  // namespace

bool Search::survey(double accuracy) {
  const ReducedScene& model = stage_.model();
  const double until = stage_.until();
  if (model.system().has_massless()) return true;
  // If the forces at the start mainly push away from it, w_max is far below its bound. The motion
  // is then as fast as the bound, and nothing vibrates.
  constexpr double hardly_vibrates = 0.1;
  w_start_ = frequency_at_start(model, until, bound_of_w_);
  if (w_start_ < hardly_vibrates * bound_of_w_) w_start_ = bound_of_w_;
  // An eigenproblem of a few unknowns takes less time [s] than any search.
  constexpr double not_worth_a_search = 1e-4;
  const double exactly = seconds_of_exact(model);
  if (exactly < std::max(not_worth_a_search, 1.5 * steps_of_verlet() * seconds_of_force(model))) {
    Trial& exact = run(*find_method("exact"), until, limit_);
    if (exact.reached_end()) measure_by(exact);
    return exact.reached_end();
  }
  return by_refinement(accuracy) || survey_by_verlet();
}

bool Search::survey_by_verlet() {
  const ReducedScene& model = stage_.model();
  const double until = stage_.until();
  constexpr double below_limit = 0.9, shorter = 0.75, much_shorter = 0.5;
  // More attempts are made if no run reaches the end, as when the motion becomes much faster than
  // its start.
  constexpr int most_attempts = 6, most_of_all = 16;
  const double looks = static_cast<double>(stage_.times().size());
  double steps = std::max(8.0, std::ceil(until * w_start_ / (2 * below_limit)));
  Trial* first = nullptr;
  for (int attempt = 0; attempt < most_of_all; ++attempt) {
    if (attempt > 0) steps /= attempt < most_attempts ? shorter : much_shorter;
    steps = looks * std::ceil(steps / looks);
    first = &run(*find_method("verlet"), until / steps, limit_);
    // After `long_enough` seconds a run is accepted although its energy grows: shorter steps do not
    // remove chaos.
    constexpr double grows = 10, long_enough = 0.3;
    const Outcome outcome = first->summary.outcome;
    if (outcome == Outcome::over_budget || outcome == Outcome::went_slack) return false;
    const bool is_long = seconds_since(begin_) > long_enough;
    if (first->reached_end()
            ? first->summary.energy_growth < grows || is_long || attempt + 1 >= most_attempts
            : is_long && attempt + 1 >= most_attempts)
      break;
  }
  if (!first->reached_end()) return false;
  // The bound of w_max may grow more than w_max does. The run was stable, so that its h w_max was
  // hardly above 2.
  constexpr double hardly_beyond = 1.02;
  const double w = std::min(w_start_ * growth_of_frequency(model, first->path, bound_of_w_, steps),
                            hardly_beyond * 2 * steps / until);
  forecast_.emplace(stage_,
                    own_frequencies(model, first->path, w, number_of_bursts(steps, first->seconds)),
                    w, first->seconds / steps);
  first_seconds_ = first->seconds;
  surveyed_by_ = first;
  for (const Trial& trial : trials_) {
    if (trial.reached_end()) forecast_->learn_seconds(trial);
  }
  learn();
  return true;
}

// Repeats the bursts along the most accurate run. Steps near the stability limit make vibrations of
// their own, which bursts along the first run mistake for those of the motion.
void Search::survey_again() {
  const Trial* best = most_accurate(true);
  if (!best || !forecast_ || best == surveyed_by_) return;
  surveyed_by_ = best;
  const double steps = steps_of_verlet();
  forecast_->learn_frequencies(own_frequencies(stage_.model(), best->path, forecast_->w_motion(),
                                               number_of_bursts(steps, first_seconds_)));
  truncations_.clear();
  learn();
}

// Doubles the number of steps until the error of the last run but one is known to be at most the
// accuracy. The error of the finest run is smaller, as errors fall by the order. Stops if they do
// not fall so, or if the next run would exceed `seconds` in all or `longest` by itself. An implicit
// step that does not resolve a vibration turns it by half a turn. So the numbers of steps are odd
// and even in turn: runs that agree have missed no vibration.
bool Search::refine(const Method& method, double steps, double accuracy, double seconds,
                    double longest) {
  const double fall = std::pow(2, method.order), end = seconds_since(begin_) + seconds;
  const Trial* last = nullptr;
  constexpr double somewhat = 1.5;
  int more_attempts = 2;
  const auto more = [&](double n) {
    return 2 * n + (method.is(Trait::implicit) && std::fmod(n, 2) == 0 ? 1 : 0);
  };
  for (double before = 0; seconds_since(begin_) < end;) {
    Trial& trial = run(method, stage_.until() / steps, end - seconds_since(begin_));
    if (!trial.reached_end()) {
      // The diverged steps resolve the soft forces but may be in resonance with the stiff ones;
      // slightly shorter ones may hold.
      const bool may_hold = !last && method.asks(Need::split_forces) &&
                            trial.summary.outcome == Outcome::diverged && more_attempts-- > 0;
      if (!may_hold) return false;
      steps = std::ceil(somewhat * steps);
      continue;
    }
    measure_by(trial);
    if (last) {
      const double gap = distance(*last, trial);
      // An error far below the accuracy need not fall by the order.
      constexpr double far_within = 0.1;
      const bool is_asymptotic =
          (before > gap && before < 2 * fall * gap) || gap < far_within * accuracy;
      if (is_asymptotic && is_known(*last, accuracy)) return true;
      const double to_come =
          trial.seconds * std::pow(std::max(1.0, gap / accuracy), 1.0 / method.order);
      if (to_come > longest || 2 * trial.seconds > end - seconds_since(begin_)) return false;
      before = gap;
    }
    last = &trial;
    steps = more(steps);
  }
  return false;
}

bool Search::by_refinement(double accuracy) {
  if (of_ == AccuracyOf::energy) return false;
  const ReducedScene& model = stage_.model();
  const System& system = model.system();
  const double force = seconds_of_force(model), explicitly = steps_of_verlet() * force;
  // Outer steps do not refine the inner ones, so the soft forces must be much slower than w_max.
  constexpr double much_softer = 0.05, share = 0.4;
  constexpr double no_time = 0.05, unnoticed = 4e-3;
  // The forecast time of the first implicit step is uncertain, and mostly too long.
  constexpr double first_step = 12e-3, as_long = 5e-3;
  for (const char* name : {"linear_midpoint", "multirate_adams4", "multirate_adams2"}) {
    const Method& method = *find_method(name);
    if (!applies_to(method, system)) continue;
    double steps = 1, seconds = share * explicitly;
    if (method.asks(Need::split_forces)) {
      const double soft = resolved_frequency(method, system, model.initial().q);
      if (soft > much_softer * w_start_ || accuracy < least_of_split) continue;
      steps = std::max(few_steps(accuracy), std::ceil(stage_.until() * soft / 2));
    } else {
      seconds = std::max(no_time * explicitly, unnoticed);
      if ((1 + steps_to_begin(method, system)) * usual_step_cost(method, system) * force >
          std::max(seconds, std::min(first_step, as_long * as_long / explicitly)))
        continue;
    }
    if (refine(method, steps, accuracy, seconds, 2 * explicitly)) return true;
  }
  return false;
}

const Trial* Search::by_tolerance(double accuracy) {
  const Trial* before = nullptr;
  for (double rtol = std::min(0.1 * accuracy, 1e-3); rtol >= least_rtol && seconds_left() > 0;
       rtol /= 10) {
    const Trial& trial = run(*find_method("ida"), rtol, limit_);
    if (!trial.reached_end()) return nullptr;
    measure_by(trial);
    if (before && is_known(*before, accuracy)) return before;
    before = &trial;
  }
  return nullptr;
}

}  // namespace qddot::inline measure
