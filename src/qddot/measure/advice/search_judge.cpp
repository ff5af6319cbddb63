// The runs whose errors a search knows, and by which it knows those of others.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

// A judge's own error is at most this part of the accuracy, so that the bounds of others are tight.
constexpr double part_of_judge = 0.2;
// Runs draw together if the finer two of three differ by this part of what the outer two do. In the
// study's table, the error of the coarsest was then within twice its distance in 1126 of 1127.
constexpr double drawn_together = 1.0 / 3;
// Work [evaluations of f, times unknowns and what a call costs beside them]. Runs with error
// control judge a motion if they take about this: 20 ms.
constexpr double little_work = 5e6;
// The same for the last attempts, before an accuracy is refused.
constexpr double much_work = 1e8;
// Tolerances below this are lost in the rounding of a step.
constexpr double least_tolerance = 1e-14;
// A call of f costs about as much as so many unknowns.
constexpr double call = 20;

}  // namespace

std::int64_t Search::forces_within(double work) const {
  return static_cast<std::int64_t>(
      std::max(100.0, work / (call + static_cast<double>(stage_.model().system().size()))));
}

// Repeats the judge from a start one rounding away, in all that was drawn. The distance that the
// judge's own error explains is in its bound already.
void Search::condition(const Trial& judge) {
  const Trial& twin = run(*judge.method, judge.value, {}, true);
  if (!twin.reached_end()) return;
  conditioning_ = Conditioning{.effect = beyond_own_error(judge, distance(judge, twin)),
                               .differences = stage_.distances(judge, twin)};
  condition_symmetry(judge);
}

double Search::beyond_own_error(const Trial& trial, double apart_by) const {
  const auto judged = judges_.find(&trial);
  return judged == judges_.end() ? apart_by : std::max(0.0, apart_by - judged->second.error);
}

void Search::condition_symmetry(const Trial& judge) {
  if (!stage_.is_reduced_by_symmetry()) return;
  const auto left = stage_.distances_out_of_symmetry(
      judge, {.seconds = seconds_left(), .forces = forces_within(much_work)});
  if (left.empty()) return;
  if (!conditioning_) conditioning_.emplace();
  conditioning_->leaves_by = beyond_own_error(
      judge, stage_.of() == AccuracyOf::path ? std::ranges::max(left) : left.back());
  conditioning_->differences_left = left;
}

// Three runs of one method with error control, at tolerances that fall by tens. If they draw
// together, the finest is within the distance of the finer two.
bool Search::judge_by_tolerance(const Method& method, double accuracy, std::int64_t& forces_left) {
  constexpr double by_tens = 10, largest_tolerance = 1e-2;
  // Errors of implicit methods follow their tolerances less closely.
  const double within = method.is(Trait::implicit) ? 4 : 2;
  std::vector<const Trial*> runs;
  for (double rtol = std::min(accuracy, largest_tolerance); rtol >= least_tolerance;
       rtol /= by_tens) {
    if (seconds_left() <= 0 || forces_left <= 0) break;
    const Trial& trial = run(method, rtol, {.forces = forces_left});
    forces_left -= trial.summary.counts.force_evaluations;
    if (!trial.path.empty()) measure_by(trial);
    if (stage_.rounding() > accuracy) {
      // The motion is too small beside the positions' own rounding.
      conditioning_ = Conditioning{.effect = stage_.rounding()};
      return false;
    }
    if (!trial.reached_end()) {
      if (trial.summary.outcome == Outcome::over_budget || !runs.empty()) break;
      continue;
    }
    if (!runs.empty() && distance_on_the_way(*runs.back(), trial) == 0)
      runs.pop_back();  // the same steps, which judge nothing
    runs.push_back(&trial);
    if (runs.size() < 3) continue;
    const Trial &c = *runs.back(), &b = *runs[runs.size() - 2], &a = *runs[runs.size() - 3];
    const double outer = distance_on_the_way(a, c), inner = distance_on_the_way(b, c);
    const bool together = inner <= drawn_together * outer;
    if (together || within * std::max(inner, outer) <= accuracy / 2) {
      judges_[&a] = {within * std::max(distance(a, c), distance(a, b)), &c, false};
      judges_[&b] = {within * std::max(inner, distance(b, c)), &c, false};
      judges_[&c] = {within * inner, &b, true};
    }
    if (!judges_.contains(&c) || judges_[&c].error > part_of_judge * accuracy) continue;
    condition(c);
    return !is_hopeless(accuracy);
  }
  finest_ = runs.size() < 3 ? nullptr : runs.back();
  return false;
}

// The methods with error control that fit the system, the most suitable first.
std::vector<const Method*> Search::with_error_control(bool implicitly, double accuracy) const {
  std::vector<const Method*> all;
  const System& system = stage_.model().system();
  for (const Method& method : methods()) {
    if (method.knob != Knob::rtol || method.is(Trait::implicit) != implicitly ||
        !method.stock_of.empty() || !applies_to(method, system) ||
        method.asks(Need::split_forces) ||
        (system.has_massless() && !method.is(Trait::accepts_massless)))
      continue;
    all.push_back(&method);
  }
  // Order 8 suits errors from 1e-6 on, order 12 smaller ones.
  constexpr double orders_beyond = 2, least_order = 8, largest_order = 12;
  const double order = std::clamp(orders_beyond - std::log10(accuracy), least_order, largest_order);
  std::ranges::stable_sort(all, {}, [&](const Method* method) {
    return std::pair(method->family == Family::sundials, std::abs(method->order - order));
  });
  return all;
}

bool Search::judge_by_error_control(double accuracy, bool implicitly, std::int64_t most_forces) {
  std::vector<const Method*> all = with_error_control(implicitly, accuracy);
  constexpr std::size_t most_methods = 2;
  if (all.size() > most_methods) all.resize(most_methods);
  for (const Method* method : all) {
    if (judge_by_tolerance(*method, accuracy, most_forces)) return true;
    // A motion that rounding leaves unknown is so for all methods.
    if (is_hopeless(accuracy)) return false;
  }
  return false;
}

bool Search::judge_in_closed_form(double accuracy) {
  const ReducedScene& model = stage_.model();
  if (!model.system().stiffness_is_constant()) return false;
  // An eigenproblem of n unknowns takes about n^3 times this many forces' unknowns.
  constexpr double of_eigenproblem = 0.5;
  double cubes = 0;
  for (const Index n : model.unknowns_by_part()) cubes += std::pow(static_cast<double>(n), 3);
  const double explicitly = steps_of_verlet() * (call + static_cast<double>(model.system().size()));
  if (of_eigenproblem * cubes > std::max(little_work / 10, explicitly)) return false;
  const Method* exact = nullptr;
  for (const Method& method : methods()) {
    if (method.order == 0 && applies_to(method, model.system())) exact = &method;
  }
  if (!exact) return false;
  const Trial& trial = run(*exact, stage_.until(), {});
  if (!trial.reached_end()) return false;
  measure_by(trial);
  // A motion computed mode by mode has w_max^2 to its last digit. So a slower frequency w has an
  // error of w_max^2 / (2 w) roundings, for a time t.
  const Scales& scales = stage_.scales();
  const double slow = scales.displacement > 0 ? scales.speed / scales.displacement : 0;
  const double phase =
      bound_of_w_ * stage_.until() * (slow > 0 ? std::max(1.0, bound_of_w_ / slow) : 1);
  constexpr double of_rest = 64;  // roundings of sums over the modes
  const double error = 4 * machine_epsilon * (rests_ ? of_rest : 1 + phase);
  judges_[&trial] = {error, nullptr, false};
  condition(trial);
  if (stage_.is_reduced_by_symmetry()) {
    // Out of the line the motion is not linear.
    constexpr double part = 1e-3;
    const double tolerance = std::max(least_tolerance, part * accuracy);
    const Trial& other = run(*with_error_control(false, tolerance).front(), tolerance,
                             {.forces = forces_within(much_work)});
    if (other.reached_end()) condition_symmetry(other);
  }
  return error <= accuracy;
}

// The forces that an implicit run may evaluate if it is to take a part of the time of Verlet's
// method. The time of a step is that of its first steps. Zero if these already take too long, and
// for forces of the caller's own: a long implicit step may leap over a core that repels.
std::int64_t Search::forces_worth_implicit_steps(double accuracy) {
  constexpr double fewest_steps = 2000, part = 0.3;
  constexpr std::int64_t first_steps = 12;
  const auto all = with_error_control(true, accuracy);
  if (!stage_.has_springs() || steps_of_verlet() < fewest_steps || all.empty()) return 0;
  const Trial& first = run(*all.front(), accuracy, {.forces = first_steps});
  const double a_force = first.seconds / static_cast<double>(first_steps);
  const double worth = part * steps_of_verlet() * seconds_of_force(stage_.model()) / a_force;
  return worth > 2 * first_steps ? static_cast<std::int64_t>(worth) : 0;
}

bool Search::judge(double accuracy) {
  const System& system = stage_.model().system();
  if (w_start_ == 0) w_start_ = bound_of_w_;
  if (judge_in_closed_form(accuracy)) return true;
  if (stage_.of() == AccuracyOf::energy) return judge_energy(accuracy);
  const auto lastly = [&](bool implicitly) {
    const bool is_found = judge_by_error_control(accuracy, implicitly, forces_within(much_work));
    // The finest run tells whether rounding is the reason.
    if (!is_found && finest_ && !conditioning_) condition(*finest_);
    return is_found;
  };
  if (system.has_massless()) return lastly(true);
  constexpr double forces_of_judge = 50;  // over those of Verlet's method at its limit
  const auto few = forces_within(little_work);
  if (forces_of_judge * steps_of_verlet() < static_cast<double>(few)) {
    if (judge_by_error_control(accuracy, false, few)) return true;
  } else {
    // An implicit run takes far fewer steps if the fast vibrations are hardly excited.
    const auto worth = forces_worth_implicit_steps(accuracy);
    if (worth > 0 && judge_by_error_control(accuracy, true, worth)) return true;
  }
  if (is_hopeless(accuracy)) return false;
  is_judged_by_forecast_ = judge_by_forecast(accuracy);
  if (is_judged_by_forecast_) return true;
  // A run near the stability limit may part from its twin where the motion does not.
  const auto seen = std::exchange(conditioning_, std::nullopt);
  const bool is_found = lastly(false);
  if (!conditioning_) conditioning_ = seen;
  return is_found;
}

// The energy of a run is its own judge, as the exact motion keeps it. A run with error control
// gives the scale: the largest kinetic energy.
bool Search::judge_energy(double accuracy) {
  constexpr double first_tolerance = 1e-3, much_finer = 1e-2;
  std::int64_t forces_left = forces_within(much_work);
  const bool implicitly = stage_.model().system().has_massless();
  const Trial* last = nullptr;
  for (const Method* method : with_error_control(implicitly, accuracy)) {
    double rtol = first_tolerance;
    for (; rtol >= least_tolerance && forces_left > 0; rtol *= much_finer) {
      const Trial& trial = run(*method, rtol, {.forces = forces_left});
      forces_left -= trial.summary.counts.force_evaluations;
      if (!trial.reached_end()) break;
      measure_by(trial);
      last = &trial;
      judges_[&trial] = {0, nullptr, false};
      conditioning_ = Conditioning{.effect = stage_.energy_rounding(trial)};
      if (is_known(trial, accuracy)) return true;
      if (is_hopeless(accuracy)) return false;
    }
    if (last) break;
  }
  if (!last || implicitly || !may_forecast(*last)) return false;
  // Steps of fixed length may keep an energy that is small beside its rounding.
  constexpr int most_runs = 8;
  learn();
  for (int i = 0; i < most_runs; ++i) {
    const auto next = promised(part_of_judge * accuracy, std::numeric_limits<double>::infinity());
    if (!next) break;
    if (is_known(run(*next->method, next->value, {.forces = forces_within(much_work)}), accuracy))
      return true;
    learn();
  }
  return false;
}

}  // namespace qddot::inline measure
