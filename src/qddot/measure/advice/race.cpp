// The last phase of a search: runs that may be faster than its answer.
#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {

// The fastest run, not made yet, that is expected to have the error in less than `seconds`; in less
// than `unseen` if no error of its method was seen, as the time of its forces is then a guess.
std::optional<Candidate> Search::promised(double error, double seconds, double unseen) const {
  for (const Candidate& c : forecast_->candidates(error)) {
    if (c.seconds > (forecast_->has_seen(*c.method) ? seconds : unseen)) continue;
    // More runs of one method teach nothing.
    const auto made = std::ranges::count(runs_.all(), c.method, &Trial::method);
    if (!runs_.has(*c.method, c.value) && made < 2 * rules_.rounds) return c;
  }
  return {};
}

// The first run of a method that has no forecast without one: of those that evaluate fewer forces
// than `fewest`, the cheapest. An answer that is much more accurate than need be has short steps
// for vibrations that hardly move. Implicit methods may then take steps of any length, and begin
// with so few that those take a small part of its time.
std::optional<Candidate> Search::first_of_method(const Trial& answer, double fewest,
                                                 double accuracy) {
  std::optional<Candidate> cheapest;
  const bool is_held_back = check_.bound(answer)->error <= rules_.small * accuracy;
  const bool may_be_implicit =
      system_.has_stiffness() && may_analyse(rules_.part_of_answer * fewest);
  const double few =
      is_held_back && may_be_implicit
          ? std::floor(rules_.small * runs_.forces(answer) / forces_of_implicit_step(2))
          : 0;
  for (const Method& method : methods()) {
    const bool is_implicit = method.is(Trait::implicit);
    if (is_forecast_by_frequency(method) || method.order < 2 || !applies_to(method, system_) ||
        method.family == Family::sundials || method.asks(Need::laplacian) ||
        (system_.has_massless() && !method.is(Trait::accepts_massless)) ||
        (is_implicit && (!may_be_implicit || runs_.stage().of() == AccuracyOf::energy)))
      continue;
    const bool splits = method.asks(Need::split_forces);
    // Stiff forces are evaluated as often as by Verlet's method.
    if (splits && runs_.steps_of_verlet() >= fewest) continue;
    // A step that was too long, or an error as large as the motion, says nothing of shorter steps.
    double failed = INFINITY;
    bool is_known = std::ranges::count(runs_.all(), &method, &Trial::method) >= rules_.rounds;
    for (const Trial& trial : runs_.all()) {
      if (trial.method != &method) continue;
      failed = std::min(failed, trial.value);
      const bool was_over_budget = trial.summary.outcome == Outcome::over_budget;
      const auto bound = check_.bound(trial);
      is_known |= (bound && runs_.is_sound(trial) && bound->error < 1) ||
                  (method.knob == Knob::rtol && !was_over_budget) ||
                  (was_over_budget && rules_.doubt * trial.seconds * until_ >
                                          answer.seconds * trial.summary.t_reached);
    }
    if (is_known) continue;
    // The work of the run at least, in forces: a step of order p takes about p of them.
    double value = std::clamp(accuracy, 10 * least_accuracy, rules_.largest_tolerance),
           steps = rules_.places, of_step = method.knob == Knob::rtol ? method.order : 1;
    // Nonlinear equations take several solves, and steps with error control may be tried twice.
    if (is_implicit)
      of_step = forces_of_implicit_step(method.order) *
                (method.listens_to(Option::solve_tolerance) ? rules_.doubt_of_two() : 1) *
                (method.knob == Knob::rtol ? rules_.doubt : 1);
    if (method.knob == Knob::rtol) {
      // Steps of order p leave the accuracy if h w_p is its p-th root.
      steps = std::max(steps, until_ * forecast_->own().at(method.order) *
                                  std::pow(accuracy, -1.0 / method.order));
      if (method.is(Trait::bounds_steps)) steps = std::max(steps, until_ * forecast_->w_motion());
      if (is_implicit && is_held_back) steps = std::max(1.0, few);
    } else {
      // Steps that resolve the motion's own frequency of order 2, or the soft forces.
      const double own =
          splits ? resolved_frequency(method, system_, model_.initial().q) : forecast_->own().at(2);
      steps = std::max(steps, std::ceil(until_ * own));
      if (is_implicit && is_held_back) steps = std::clamp(few, 1.0, steps);
      steps = std::max(steps, rules_.doubt * until_ / failed);
      // To find this step takes longer than short runs.
      if (!is_held_back && has_linear_step(method) && steps * of_step < fewest)
        steps = std::max(steps, std::ceil(until_ / forecast_->step_by_frequency(method, accuracy)));
      value = until_ / steps;
      if (splits) steps = std::max(steps, runs_.steps_of_verlet());
    }
    const double forces = steps * of_step;
    if (forces >= fewest) continue;
    fewest = forces;
    cheapest = Candidate{.method = &method, .value = value, .forces = forces};
  }
  return cheapest;
}

// Runs of fixed steps that are halved until the error is known to be small enough, method after
// method; where no forecast can choose steps.
const Trial* Search::race_of_halved_steps(const Trial* answer, double accuracy) {
  for (const Method& method : methods()) {
    if (method.knob != Knob::step_size || !applies_to(method, system_)) continue;
    for (double h = until_ / rules_.places; runs_.seconds_left() > 0; h /= 2) {
      const double seconds = rules_.clearly_below * answer->seconds;
      const Trial& trial = runs_.make(method, h, {.seconds = seconds, .only_end = true});
      if (trial.summary.outcome == Outcome::over_budget) break;
      if (!trial.reached_end() || !check_.is_known(trial, accuracy)) continue;
      runs_.time_again(trial);
      if (trial.seconds < answer->seconds) answer = &trial;
      break;
    }
  }
  return answer;
}

const Trial* Search::race(const Trial* answer, double accuracy) {
  if (answer->method->order == 0 || !check_.has_judge() || runs_.stage().rests()) return answer;
  if (is_constrained(system_)) return race_of_halved_steps(answer, accuracy);
  if (!may_forecast(*answer)) return answer;
  forecast_->learn(check_);
  runs_.time_again(*answer);
  const double unnoticed_end = runs_.seconds() + rules_.unnoticed - answer->seconds,
               end = std::max(unnoticed_end,
                              runs_.seconds() + rules_.part_of_answer * answer->seconds);
  // A bound is 1.1 times the distance to a judge, beside what is unknown of the judge.
  const double rounding = check_.conditioning() ? check_.conditioning()->share : 0,
               unknown = std::max(rounding, check_.error_of(*check_.judge()));
  const double aim =
      std::max(rules_.small, rules_.clearly_below * (rules_.clearly_below - unknown / accuracy)) *
      accuracy;
  while (runs_.seconds_left() > 0) {
    const double left = end - runs_.seconds();
    if (left <= 0) break;
    const double seconds = std::min(left, rules_.clearly_below * answer->seconds);
    const double unseen =
        std::clamp(unnoticed_end - runs_.seconds(), seconds, rules_.doubt * answer->seconds);
    std::optional<Candidate> next = promised(aim, seconds, unseen);
    // Forces of methods that were not run may be cheaper. All may be tried where that takes no
    // time.
    const double fewest = runs_.forces(*answer) * std::max(1.0, left / answer->seconds);
    const auto first = first_of_method(*answer, fewest, accuracy);
    // A run that is expected to be much faster comes first: the others then take less time.
    const bool is_much_faster = next && rules_.doubt * next->seconds < answer->seconds;
    if (!next || (first && !is_much_faster && first->forces < next->forces)) next = first;
    if (!next) break;
    constexpr double of_clock = 1e-5;  // [s], the time to see that it is over
    // Looks would end steps that are longer than the time between them.
    const Trial& trial =
        runs_.make(*next->method, next->value, {.seconds = seconds + of_clock, .only_end = true});
    forecast_->learn(check_);
    if (trial.seconds > rules_.doubt * answer->seconds || !check_.is_known(trial, accuracy))
      continue;
    runs_.time_again(trial);
    if (trial.seconds < answer->seconds) answer = &trial;
  }
  return answer;
}

}  // namespace qddot::inline measure
