#include "qddot/measure/advice/search.hpp"

#include <algorithm>
#include <utility>

namespace qddot::inline measure {

Search::Search(const Model& model, double until, AccuracyOf of, double seconds, const Scene* drawn,
               const Rules& rules)
    : model_(model),
      system_(model.system()),
      until_(until),
      runs_(model, until, of, seconds, drawn, rules),
      check_(runs_),
      w_start_(runs_.bound_of_w()) {}

const Trial* Search::find(double accuracy) {
  const Trial* known = check_.fastest(accuracy);
  if (!known) {
    // The distance of a pair, made for another accuracy, is more than the effect of rounding.
    check_.set({});
    judge(accuracy);
    known = check_.fastest(accuracy);
    // No claim without a look at what rounding does.
    if (known && !check_.conditioning()) {
      check_.condition(*known, accuracy);
      known = check_.conditioning() ? check_.fastest(accuracy) : nullptr;
    }
  }
  return known ? race(known, accuracy) : nullptr;
}

void Search::try_once(const Method& method, double value, const Limits& limits) {
  if (!runs_.has(method, value)) runs_.make(method, value, limits);
}

// The judge by the motion: in closed form, of little work, or by a forecast. All that fails, runs
// with error control of much work.
bool Search::judge(double accuracy) {
  if (runs_.all().empty() && runs_.stage().of() != AccuracyOf::positions) {
    const auto coarse = with_error_control(system_.has_massless(), 1);
    if (!coarse.empty()) {
      if (system_.has_massless()) runs_.begin_in_balance(*coarse.front());
      runs_.look_within_steps(*coarse.front(), rules_.largest_tolerance);
    }
  }
  if (judge_in_closed_form(accuracy)) return true;
  if (runs_.stage().of() == AccuracyOf::energy) return judge_energy(accuracy);
  if (system_.has_massless()) return judge_at_last(accuracy, true);
  // A forecast knows no moments at which springs go slack or break.
  if (system_.switching()) return judge_at_last(accuracy, false);
  // Vibrations under constraints are not those of K.
  if (is_constrained(system_)) return judge_at_last(accuracy, false);
  // Explicit methods take no fewer steps than Verlet's where vibrations bound them.
  const std::int64_t few = runs_.forces_within(rules_.little_work);
  if (runs_.steps_of_verlet() < static_cast<double>(few / runs_of_three) &&
      judge_by_error_control(accuracy, false, few, false))
    return true;
  if (check_.is_hopeless(accuracy)) return false;
  const auto worth = forces_worth_implicit_steps(accuracy);
  if (worth > 0 && judge_by_error_control(accuracy, true, worth, false)) return true;
  if (check_.is_hopeless(accuracy)) return false;
  is_judged_by_forecast_ = judge_by_forecast(accuracy);
  if (is_judged_by_forecast_) return true;
  // A run near the stability limit may part from its twin where the motion does not.
  const auto seen = check_.conditioning();
  check_.set({});
  const bool is_found = judge_at_last(accuracy, false);
  if (!check_.conditioning()) check_.set(seen);
  // The run that is known best tells whether rounding is the reason.
  const Trial* best = check_.best();
  if (!is_found && best && !check_.conditioning()) check_.condition(*best, accuracy);
  return is_found;
}

bool Search::judge_at_last(double accuracy, bool implicitly) {
  // They may take as much work as all that failed.
  double forces = 0;
  for (const Trial& trial : runs_.all()) forces += runs_.forces(trial);
  const bool is_found = judge_by_error_control(
      accuracy, implicitly,
      std::max(runs_.forces_within(rules_.much_work), static_cast<std::int64_t>(forces)), true);
  // The finest run tells whether rounding is the reason.
  if (!is_found && finest_ && !check_.conditioning()) check_.condition(*finest_, accuracy);
  return is_found;
}

}  // namespace qddot::inline measure
