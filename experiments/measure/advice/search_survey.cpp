// How a search begins: the first run and what it tells, or what makes it needless.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "qddot/analysis/frequency_bound.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/motion/resolved_frequency.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::measure {
namespace {

double seconds_of_force(const ReducedScene& model) {
  Vec f(model.system().size());
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    least = std::min(least, seconds_of([&] { model.system().force(model.initial().q, f); }));
  }
  return least;
}

// w_max at the start, to some percent for no more than the run is worth.
double frequency_at_start(const ReducedScene& model, double until, double bound) {
  const System& system = model.system();
  const Vec& q = model.initial().q;
  constexpr Index small = 300;
  // Thirty products with K cost as much as about a hundred forces, and come within some percent
  // from below.
  constexpr double worth_searching = 600, from_below = 1.02;
  if (system.size() <= small) return largest_frequency(system, q);
  if (until * bound < 2 * worth_searching) return bound;
  return std::min(bound, from_below * frequency_at_least(system, q));
}

// By what factor w_max grows over the path, as its bound does.
double growth_of_frequency(const ReducedScene& model, const std::vector<State>& path, double bound,
                           double steps) {
  if (model.system().stiffness_is_constant() || bound == 0) return 1;
  const std::size_t seen =
      std::min(path.size(), static_cast<std::size_t>(std::clamp(steps / 100, 1.0, 12.0)));
  double most = bound;
  for (std::size_t i = 1; i <= seen; ++i)
    most = std::max(most, frequency_bound(model.system(), path[i * path.size() / seen - 1].q));
  return most / bound;
}

}  // namespace

bool Search::survey(double accuracy) {
  const ReducedScene& model = stage_.model();
  const double until = stage_.until();
  if (model.system().has_massless()) return true;
  w_start_ = frequency_at_start(model, until, frequency_bound(model.system(), model.initial().q));
  // An eigenproblem of a few unknowns takes no time.
  constexpr double not_worth_a_search = 1e-4;
  const double exactly = seconds_of_exact(model);
  if (exactly <
      std::max(not_worth_a_search, 1.5 * steps_of_verlet(model, until) * seconds_of_force(model))) {
    Trial& exact = run(*find_method("exact"), until, limit_);
    if (exact.reached_end()) stage_.measure_by(exact);
    return exact.reached_end();
  }
  return by_refinement(accuracy) || survey_by_verlet();
}

bool Search::survey_by_verlet() {
  const ReducedScene& model = stage_.model();
  const System& system = model.system();
  const double until = stage_.until(), bound = frequency_bound(system, model.initial().q);
  constexpr double below_limit = 0.9, shorter = 0.75;
  constexpr int most_attempts = 6;
  const double looks = static_cast<double>(stage_.times().size());
  double steps = std::max(8.0, std::ceil(until * w_start_ / (2 * below_limit)));
  Trial* first = nullptr;
  for (int attempt = 0; attempt < most_attempts; ++attempt, steps = steps / shorter) {
    steps = looks * std::ceil(steps / looks);
    first = &run(*find_method("verlet"), until / steps, limit_);
    constexpr double grows = 10;
    const Outcome outcome = first->summary.outcome;
    if (outcome == Outcome::over_budget || outcome == Outcome::went_slack) return false;
    if (first->reached_end() && first->summary.energy_growth < grows) break;
  }
  if (!first->reached_end()) return false;
  const double w = w_start_ * growth_of_frequency(model, first->path, bound, steps);
  const int bursts = static_cast<int>(std::clamp(steps / 80, 2.0, 16.0));
  forecast_.emplace(stage_, own_frequencies(model, first->path, w, bursts), w,
                    first->seconds / steps);
  first_seconds_ = first->seconds;
  forecast_->learn_seconds(*first);
  learn();
  return true;
}

// Doubles the number of steps until the error of all but the finest run is known to be at most the
// accuracy, which that of the finest is then as well: it falls as the order says. Ends early where
// it does not, or where that would take more seconds. Steps without damping that do not resolve a
// vibration turn it by another angle with each number of steps, so that runs that agree have
// missed none.
bool Search::refine(const Method& method, double steps, double accuracy, double seconds) {
  const double fall = std::pow(2, method.order), end = seconds_since(begin_) + seconds;
  const Trial* last = nullptr;
  for (double before = 0; seconds_since(begin_) < end; steps *= 2) {
    Trial& trial = run(method, stage_.until() / steps, end - seconds_since(begin_));
    if (!trial.reached_end()) return false;
    stage_.measure_by(trial);
    if (last) {
      const double distance = stage_.distance(*last, trial);
      // Far within the accuracy, the order does not matter.
      constexpr double far_within = 0.1;
      const bool is_asymptotic =
          (before > distance && before < 2 * fall * distance) || distance < far_within * accuracy;
      if (is_asymptotic && bound(*last).value_or(1) <= accuracy) return true;
      // Two more runs are to come, if it goes on as it should.
      const double needed =
          std::sqrt(std::max(1.0, std::pow(distance / accuracy, 2.0 / method.order)));
      if (trial.seconds * needed * 2 > end - seconds_since(begin_)) return false;
      before = distance;
    }
    last = &trial;
  }
  return false;
}

bool Search::by_refinement(double accuracy) {
  if (of_ == AccuracyOf::energy) return false;
  const ReducedScene& model = stage_.model();
  const System& system = model.system();
  const double explicitly = steps_of_verlet(model, stage_.until()) * seconds_of_force(model);
  constexpr double much_softer = 0.05, share = 0.4, no_time = 0.05;
  // Where little accuracy is asked for, a few implicit steps may do.
  std::vector<const char*> names = {"multirate_adams4", "multirate_adams2", "linear_midpoint"};
  if (few_steps(accuracy) == 2) std::ranges::reverse(names);
  for (const char* name : names) {
    const Method& method = *find_method(name);
    if (!applies_to(method, system)) continue;
    double steps = few_steps(accuracy);
    if (method.asks(Need::split_forces)) {
      const double soft = resolved_frequency(method, system, model.initial().q);
      // What such a method does within a step is not refined with it.
      if (soft > much_softer * w_start_ || accuracy < least_of_split) continue;
      steps = std::max(steps, std::ceil(stage_.until() * soft / 2));
    } else if ((steps + steps_to_analyse(system.size())) * usual_step_cost(method, system.size()) >
               no_time * steps_of_verlet(model, stage_.until())) {
      continue;
    }
    if (refine(method, steps, accuracy, share * explicitly)) return true;
  }
  return false;
}

const Trial* Search::by_tolerance(double accuracy) {
  const Trial* before = nullptr;
  for (double rtol = std::min(0.1 * accuracy, 1e-3); rtol >= least_rtol && seconds_left() > 0;
       rtol /= 10) {
    const Trial& trial = run(*find_method("ida"), rtol, limit_);
    if (!trial.reached_end()) return nullptr;
    stage_.measure_by(trial);
    if (before && bound(*before).value_or(1) <= accuracy) return before;
    before = &trial;
  }
  return nullptr;
}

}  // namespace qddot::measure
