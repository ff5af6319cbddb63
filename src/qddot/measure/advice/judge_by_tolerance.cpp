// Runs with error control, and the motion in closed form, as judges.
#include <algorithm>
#include <cmath>
#include <utility>

#include "qddot/algebra/symbolic_factorization.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {

// The run, or its beginning if that has little hope to reach the end with so many forces. A
// beginning may need more steps than the rest.
const Trial& Search::run_if_promising(const Method& method, double rtol, std::int64_t forces) {
  const auto few = static_cast<std::int64_t>(rules_.small * static_cast<double>(forces));
  const Trial& begun = runs_.make(method, rtol, {.forces = std::max<std::int64_t>(1, few)});
  const bool may_reach = rules_.doubt_of_two() * begun.summary.t_reached > rules_.small * until_;
  if (begun.summary.outcome != Outcome::over_budget || !may_reach) return begun;
  return runs_.make(method, rtol, {.forces = forces});
}

// Three runs of one method with error control, at tolerances that fall by tens. If they draw
// together, the finest is within the distance of the finer two.
bool Search::judge_by_tolerance(const Method& method, double accuracy, std::int64_t& forces_left,
                                bool is_last) {
  // Errors of implicit methods follow their tolerances less closely.
  const double doubt = method.is(Trait::implicit) ? rules_.doubt_of_two() : rules_.doubt;
  const Stage& stage = runs_.stage();
  const double length = with_tolerance_scales({}, model_).length;
  std::vector<const Trial*> runs;
  for (double rtol = std::min(accuracy, rules_.largest_tolerance); rtol >= least_accuracy;
       rtol /= 10) {
    if (runs_.seconds_left() <= 0 || forces_left <= 0) break;
    const bool is_first = runs.empty();
    const std::int64_t most_forces =
        is_first ? std::max<std::int64_t>(1, forces_left / runs_of_three) : forces_left;
    const Trial* before = runs_.find(method, rtol);
    const bool is_new = !before || !before->reached_end();
    const Trial& trial = !is_new                ? *before
                         : is_first && !is_last ? run_if_promising(method, rtol, most_forces)
                                                : runs_.make(method, rtol, {.forces = most_forces});
    if (is_new) forces_left -= std::llround(runs_.forces(trial));
    if (!trial.path.empty()) runs_.measure_by(trial);
    if (!trial.reached_end()) {
      if (trial.summary.outcome == Outcome::over_budget || !is_first) break;
      continue;
    }
    if (stage.rests()) {
      check_.accept(trial, {});
      check_.condition(trial, accuracy);
      return !check_.is_hopeless(accuracy);
    }
    if (stage.rounding() > accuracy) {
      // The motion is too small beside the positions' own rounding.
      check_.set(Conditioning{.effect = stage.rounding(), .share = stage.rounding()});
      return false;
    }
    // A tolerance as large as the motion controls nothing: runs whose steps stability does not
    // bound all come to rest then.
    if (method.is(Trait::implicit) && rtol * length > rules_.small * stage.least_scale()) continue;
    if (!runs.empty() && runs_.distance_on_the_way(*runs.back(), trial) == 0) {
      // The same steps judge nothing; more than the tolerance bounds them.
      runs.pop_back();
      rtol *= rules_.small * rules_.small;
    }
    runs.push_back(&trial);
    if (runs.size() < 3) continue;
    const Trial &c = *runs.back(), &b = *runs[runs.size() - 2], &a = *runs[runs.size() - 3];
    const double outer = runs_.distance_on_the_way(a, c), inner = runs_.distance_on_the_way(b, c);
    // A run that is far away is not on its way.
    const bool together = inner <= rules_.drawn_together * outer && outer <= rules_.small;
    if (!together && doubt * std::max(inner, outer) > accuracy / 2) continue;
    // Errors that do not fall as the tolerances may be larger than what parts the runs.
    const double bound = together ? doubt : rules_.doubt * doubt;
    check_.accept(a, {bound * std::max(runs_.distance(a, c), runs_.distance(a, b)), &c});
    // The finer one of the last two may be no better than the other.
    check_.accept(b, {bound * inner + std::max(inner, runs_.distance(b, c)), &c});
    check_.accept(c, {bound * inner, &b, true});
    if (check_.error_of(c) > rules_.part_of_judge * accuracy) continue;
    check_.condition(c, accuracy);
    if (check_.is_hopeless(accuracy)) return false;
    if (check_.is_known(c, accuracy)) return true;
  }
  finest_ = runs.size() < 3 ? nullptr : runs.back();
  return false;
}

// The methods with error control that fit the system: first the one whose order suits a judge, then
// the one of the highest order, or the other way round.
std::vector<const Method*> Search::with_error_control(bool implicitly, double accuracy) const {
  std::vector<const Method*> all;
  for (const Method& method : methods()) {
    if (method.knob != Knob::rtol || method.is(Trait::implicit) != implicitly ||
        !method.stock_of.empty() || !applies_to(method, system_) ||
        method.asks(Need::split_forces) ||
        (system_.has_massless() && !method.is(Trait::accepts_massless)))
      continue;
    all.push_back(&method);
  }
  const auto is_own = [](const Method* method) { return method->family != Family::sundials; };
  if (std::ranges::any_of(all, is_own)) std::erase_if(all, std::not_fn(is_own));
  if (all.size() < 2) return all;
  const Method* suited = *std::ranges::min_element(all, {}, [&](const Method* method) {
    return std::abs(method->order - rules_.order_of_judge);
  });
  const Method* highest = *std::ranges::max_element(all, {}, &Method::order);
  if (suited == highest) return {suited};
  if (accuracy < rules_.small_accuracy) std::swap(suited, highest);
  return {suited, highest};
}

bool Search::judge_by_error_control(double accuracy, bool implicitly, std::int64_t most_forces,
                                    bool is_last) {
  for (const Method* method : with_error_control(implicitly, accuracy)) {
    if (judge_by_tolerance(*method, accuracy, most_forces, is_last)) return true;
    // A motion that rounding leaves unknown is so for all methods. What is too much work for one is
    // so for the next.
    const bool is_too_much = !is_last && !runs_.all().empty() &&
                             runs_.all().back().summary.outcome == Outcome::over_budget;
    if (is_too_much || check_.is_hopeless(accuracy)) return false;
  }
  return false;
}

bool Search::judge_in_closed_form(double accuracy) {
  if (!system_.stiffness_is_constant()) return false;
  // An eigenproblem of n unknowns takes about as long as the force on n^3 of them.
  double cubes = 0;
  for (const Index n : model_.unknowns_by_part()) cubes += std::pow(static_cast<double>(n), 3);
  if (cubes >
      std::max(rules_.small * rules_.little_work, runs_.steps_of_verlet() * runs_.work_of_force()))
    return false;
  const auto exact = std::ranges::find_if(methods(), [&](const Method& method) {
    return method.order == 0 && applies_to(method, system_);
  });
  if (exact == methods().end()) return false;
  const Trial& trial = runs_.make(*exact, until_);
  if (!trial.reached_end()) return false;
  runs_.measure_by(trial);
  const Stage& stage = runs_.stage();
  const double error = stage.rounding_of_modes(runs_.bound_of_w());
  check_.accept(trial, {error});
  if (stage.of() == AccuracyOf::energy) {
    const double rounding = stage.energy_rounding(trial);
    check_.set(Conditioning{.effect = rounding, .share = rounding});  // all motions keep it
  } else {
    check_.condition(trial, accuracy);
  }
  if (!check_.conditioning() && stage.is_reduced_by_symmetry()) {
    // Out of the line the motion is not linear, so that a run with error control is compared.
    const double tolerance = std::max(least_accuracy, rules_.small * rules_.small * accuracy);
    for (const Method* method : with_error_control(false, tolerance)) {
      const Trial& other =
          runs_.make(*method, tolerance, {.forces = runs_.forces_within(rules_.much_work)});
      if (other.reached_end() && check_.condition_symmetry(other, accuracy)) break;
    }
  }
  return error <= accuracy;
}

// Whether the cost of implicit steps is known, or takes less than so many forces to find.
bool Search::may_analyse(double forces) const {
  const double entries = static_cast<double>(system_.stiffness_entries());
  return implicit_force_ || rules_.analysis * entries < forces * runs_.work_of_force();
}

// The explicit forces that take as long as an implicit step.
double Search::forces_of_implicit_step(int order) {
  if (!implicit_force_) {
    const SymbolicFactorization factors = analyse(system_.stiffness_pattern());
    implicit_force_ = rules_.implicit_force +
                      (rules_.entry * factors.entries() + rules_.operation * factors.operations()) /
                          runs_.work_of_force();
  }
  return order * *implicit_force_;
}

// The forces that an implicit run may evaluate if it is to take a part of the work of Verlet's
// method; zero if that is no more than a few steps, and for forces of the caller's own: a long
// implicit step may leap over a core that repels.
std::int64_t Search::forces_worth_implicit_steps(double accuracy) {
  const auto all = with_error_control(true, accuracy);
  if (!runs_.stage().has_springs() || all.empty()) return 0;
  // Factors are not even analysed for less than some steps.
  const double most = rules_.short_cut * runs_.steps_of_verlet(),
               fewest = rules_.places * all.front()->order;
  // Factors have at least the entries of K.
  const double entries = static_cast<double>(system_.stiffness_entries());
  if (!may_analyse(most) ||
      most < fewest * (rules_.implicit_force + rules_.entry * entries / runs_.work_of_force()))
    return 0;
  const double worth = most / forces_of_implicit_step(1);
  return worth > fewest ? static_cast<std::int64_t>(worth) : 0;
}

// The energy of a run is its own judge, as the exact motion keeps it. A run with error control
// gives the scale: the largest kinetic energy.
bool Search::judge_energy(double accuracy) {
  std::int64_t forces_left = runs_.forces_within(rules_.much_work);
  const bool implicitly = system_.has_massless();
  const Trial* last = nullptr;
  for (const Method* method : with_error_control(implicitly, accuracy)) {
    for (double rtol = rules_.small * rules_.largest_tolerance;
         rtol >= least_accuracy && forces_left > 0; rtol /= 10) {
      const Trial& trial = runs_.make(*method, rtol, {.forces = forces_left});
      forces_left -= std::llround(runs_.forces(trial));
      if (!trial.reached_end()) {
        // Long steps may find a cable slack that is taut.
        if (last || trial.summary.outcome == Outcome::over_budget) break;
        continue;
      }
      runs_.measure_by(trial);
      last = &trial;
      check_.accept(trial, {});
      const double rounding = runs_.stage().energy_rounding(trial);
      check_.set(Conditioning{.effect = rounding, .share = rounding});
      if (check_.is_known(trial, accuracy)) return true;
      if (check_.is_hopeless(accuracy)) return false;
    }
    if (last) break;
  }
  if (!last || implicitly || !may_forecast(*last)) return false;
  // Steps of fixed length may keep an energy that is small beside its rounding.
  forecast_->learn(check_);
  for (int i = 0; i < static_cast<int>(rules_.rounds); ++i) {
    const auto next = promised(rules_.part_of_judge * accuracy, INFINITY, INFINITY);
    if (!next) break;
    const Trial& trial =
        runs_.make(*next->method, next->value, {.forces = runs_.forces_within(rules_.much_work)});
    if (check_.is_known(trial, accuracy)) return true;
    forecast_->learn(check_);
  }
  return false;
}

}  // namespace qddot::inline measure
