// Pairs of runs that a forecast chooses, where runs with error control would take long.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::inline measure {
namespace {

// The fraction of the accuracy that a run is chosen to have as its expected error. The forecast is
// right to a factor of about two.
constexpr double aim = 0.4;
// A run checks another one if its expected error is smaller by at least this factor.
constexpr double finer = 2.4;
// The bound of an error over its distance to a check.
constexpr double margin = 2;
// Two runs at this distance or more have nothing in common.
constexpr double lost = 0.1;
// A run that gains this energy, over the kinetic one, has at least a tenth of that as its error.
constexpr double witness = 0.1;

// w_max [rad/s] at the start to some percent, at a cost that is small beside the run.
double frequency_at_start(const ReducedScene& model, double steps, double bound) {
  const System& system = model.system();
  const Vec& q = model.initial().q;
  // Thirty products with K cost as much as about a hundred forces. They give a value that is some
  // percent too small.
  constexpr Index small = 300;
  constexpr double worth_searching = 600, from_below = 1.02;
  if (system.size() <= small) return largest_frequency(system, q);
  if (steps < worth_searching) return bound;
  return std::min(bound, from_below * frequency_at_least(system, q));
}

// The factor by which w_max grows over the path, from the growth of its bound.
double growth_of_frequency(const ReducedScene& model, const std::vector<State>& path,
                           double bound) {
  if (model.system().stiffness_is_constant() || !(bound > 0)) return 1;
  // A bound costs as much as about 17 forces.
  constexpr std::size_t looks = 8;
  double most = bound;
  for (std::size_t i = 1; i <= looks; ++i)
    most = std::max(most, frequency_bound(model.system(), path[i * path.size() / looks - 1].q));
  return most / bound;
}

}  // namespace

// The first run: Verlet's method near its stability limit, with shorter steps if it fails or its
// energy grows.
const Trial* Search::survey() {
  constexpr double below_limit = 0.9, shorter = 0.6, grows = 2;
  constexpr int most_attempts = 10;
  const ReducedScene& model = stage_.model();
  const Method* method = find_method("verlet");
  // Forces that push away from the start bring no frequency; the motion is as fast as the bound.
  constexpr double hardly_vibrates = 0.1;
  w_start_ = frequency_at_start(model, steps_of_verlet(), bound_of_w_);
  if (w_start_ < hardly_vibrates * bound_of_w_) w_start_ = bound_of_w_;
  double steps = std::max(8.0, std::ceil(stage_.until() * w_start_ / (2 * below_limit)));
  for (int attempt = 0; attempt < most_attempts; ++attempt, steps = std::ceil(steps / shorter)) {
    const Trial& trial = run(*method, stage_.until() / steps, {});
    if (trial.reached_end() && trial.summary.energy_growth < grows) return &trial;
    const Outcome outcome = trial.summary.outcome;
    if (outcome == Outcome::over_budget || outcome == Outcome::went_slack) return nullptr;
  }
  return nullptr;
}

void Search::begin_forecast(const std::vector<State>& path, double w) {
  const ReducedScene& model = stage_.model();
  constexpr int bursts = 12;
  forecast_.emplace(stage_, own_frequencies(model, path, w, bursts), w, seconds_of_force(model));
}

// Whether there is a forecast; begins one along the trial if its motion vibrates.
bool Search::may_forecast(const Trial& trial) {
  if (forecast_) return true;
  double w = bound_of_w_;
  for (const State& state : trial.path)
    w = std::max(w, frequency_bound(stage_.model().system(), state.q));
  if (!(w > 0) || !std::isfinite(w)) return false;
  begin_forecast(trial.path, w);
  return true;
}

// Corrects the forecast by the distances of runs to the best judge, else to the run that is
// expected to be the most accurate.
void Search::learn() {
  const Trial* by = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [judge, judged] : judges_) {
    if (judged.error < least) {
      least = judged.error;
      by = judge;
    }
  }
  const auto expected = [&](const Trial& trial) {
    return forecast_->error(*trial.method, trial.value);
  };
  if (!by) {
    for (const Trial& trial : trials_) {
      if (!trial.reached_end() || !(expected(trial) < least)) continue;
      least = expected(trial);
      by = &trial;
    }
  }
  if (!by) return;
  for (const Trial& trial : trials_) {
    if (!trial.reached_end() || trial.is_pushed || &trial == by) continue;
    const double error =
        stage_.of() == AccuracyOf::energy ? stage_.energy_error(trial) : distance(trial, *by);
    // An error near that of the other run says nothing.
    if (error > 2 * least) forecast_->learn(trial, error);
  }
}

// A run chosen to have a part of the accuracy as its error, and a run that checks it; the check
// begins one rounding away. Each distance corrects the forecast for the next pair.
bool Search::judge_by_forecast(double accuracy) {
  const Trial* first = survey();
  if (!first) return false;
  measure_by(*first);
  const double steps = stage_.until() / first->value;
  const double growth = growth_of_frequency(stage_.model(), first->path, bound_of_w_);
  // The bound of w_max may grow more than w_max does. The run was stable, so that its h w_max was
  // hardly above 2.
  constexpr double hardly_above = 2.04;
  begin_forecast(first->path, std::min(w_start_ * growth, hardly_above * steps / stage_.until()));
  constexpr int most_rounds = 4;
  const Trial* tried = first;
  for (int round = 0; round < most_rounds && seconds_left() > 0; ++round) {
    // Explicit runs of fixed steps alone: their errors fall by their order from the first run on.
    const auto explicit_run = [&](double error, const Method* checked) {
      std::optional<Candidate> best;
      for (const Candidate& c : forecast_->candidates(error)) {
        if (!is_forecast_by_frequency(*c.method) || was_tried(*c.method, c.value)) continue;
        const double doubt = checked ? forecast_->doubt(*c.method, *checked) : 1;
        std::optional<Candidate> own =
            doubt > 1 ? forecast_->candidate(*c.method, error / doubt) : c;
        if (own && own->error <= 1.01 * error / doubt && (!best || own->seconds < best->seconds))
          best = own;
      }
      return best;
    };
    double error = forecast_->error(*tried->method, tried->value);
    if (!(error <= aim * accuracy)) {
      const auto next = explicit_run(aim * accuracy, nullptr);
      if (!next) return false;
      const Trial& trial = run(*next->method, next->value, {});
      if (!trial.reached_end()) continue;
      tried = &trial;
      learn();
      error = next->error;
    }
    const auto check = explicit_run(error / finer, tried->method);
    if (!check) return false;
    const Trial& checked = run(*check->method, check->value, {}, true);
    if (!checked.reached_end()) continue;
    measure_by(checked);
    const double between = distance_on_the_way(*tried, checked);
    // The energy that a run gains bounds its error from below, as the motion keeps it.
    const double scale = stage_.scales().kinetic;
    const double gained = scale > 0 ? checked.energy_gain / scale : 0;
    judges_[tried] = {margin * between / (1 - 1 / finer), &checked, false};
    judges_[&checked] = {std::max(margin * between / (finer - 1), witness * gained), tried, true};
    learn();
    forecast_->learn(*tried, between / (1 - 1 / finer));
    if (is_known(*tried, accuracy)) {
      conditioning_ = Conditioning{};  // the check's distance has it
      condition_symmetry(*first);
      return is_known(*tried, accuracy);
    }
    // Runs that should be near each other and are not: rounding may be the reason. The first run
    // tells cheaply whether it leaves nothing known.
    if (!conditioning_ && between > lost) condition(*first);
    if (conditioning_ && conditioning_->effect < lost) conditioning_.reset();
    if (round > 0 && !conditioning_) condition(*tried);
    if (is_hopeless(accuracy)) return false;
  }
  return false;
}

}  // namespace qddot::inline measure
