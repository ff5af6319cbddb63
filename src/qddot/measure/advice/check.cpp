#include "qddot/measure/advice/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {

void Check::accept(const Trial& judge, const Bound& own) {
  std::erase_if(judges_, [&](const auto& former) {
    const double both = former.second.error + own.error;
    return runs_.distance(*former.first, judge) > runs_.rules().doubt * both;
  });
  judges_[&judge] = own;
}

const Trial* Check::judge() const {
  const auto least =
      std::ranges::min_element(judges_, {}, [](const auto& judge) { return judge.second.error; });
  return least == judges_.end() ? nullptr : least->first;
}

// A repetition with error control takes other steps. The distance that the run's own error explains
// is then in its bound already. Fixed steps are the same, so that only rounding parts the two.
double Check::beyond_own_error(const Trial& trial, double apart_by) const {
  const auto judged = judges_.find(&trial);
  if (judged == judges_.end() || trial.method->knob != Knob::rtol) return apart_by;
  return std::max(0.0, apart_by - judged->second.error);
}

void Check::condition(const Trial& judge, double accuracy) {
  conditioning_.reset();
  if (judge.only_end) {
    const Trial& seen = runs_.make(*judge.method, judge.value);
    if (seen.reached_end()) condition(seen, accuracy);
    return;
  }
  const Stage& stage = runs_.stage();
  const Rules& rules = runs_.rules();
  if (stage.rests()) return condition_rest(judge);
  if (!condition_symmetry(judge, accuracy)) return;
  Conditioning found = conditioning_.value_or(Conditioning{});
  if (conditioning_ && found.share <= rules.part_of_judge * accuracy) {
    // The scene was repeated as it was drawn, with all its nodes pushed.
    conditioning_->effect = found.leaves_by;
    conditioning_->differences = found.differences_left;
    return;
  }
  conditioning_.reset();
  double apart = 0;
  const auto repeat = [&](std::uint32_t seed) {
    const Trial& twin = runs_.make_pushed(*judge.method, judge.value, {.seed = seed});
    if (!twin.reached_end()) return false;
    const std::vector<double> differences = stage.distances(judge, twin);
    const double by =
        stage.of() == AccuracyOf::path ? std::ranges::max(differences) : differences.back();
    apart = std::max(apart, by);
    const double effect = beyond_own_error(judge, by);
    if (found.differences.empty() || effect > found.effect) found.differences = differences;
    found.effect = std::max(found.effect, effect);
    return true;
  };
  if (!repeat(1)) return;
  // One pair of runs may be near each other by luck. So its distance counts twice as often as the
  // largest of three.
  double share = std::max(rules.doubt_of_two() * found.effect, by_chance(judge, apart));
  if (share > rules.part_of_judge * accuracy && found.effect <= accuracy) {
    if (!repeat(2) || !repeat(3)) return;
    share = std::max(rules.doubt * found.effect, by_chance(judge, apart) / rules.doubt);
  }
  found.share = std::max(found.share, share);
  conditioning_ = found;
}

// Steps of a tenth of the tolerance leave a tenth of the error, and their repetition about as much.
// If it is farther away, the runs differ by rounding. Where a motion has one direction in which
// errors grow, two of three such runs are near each other by chance.
double Check::by_chance(const Trial& judge, double apart) const {
  const Rules& rules = runs_.rules();
  const auto judged = judges_.find(&judge);
  if (judged == judges_.end() || judge.method->knob != Knob::rtol) return 0;
  const double own = judged->second.error;
  if (apart <= rules.part_of_judge * own) return 0;
  return std::max(rules.doubt * apart, own);
}

void Check::condition_by_pair(const Trial& known, double between, const Trial& first,
                              double accuracy) {
  conditioning_ = Conditioning{.effect = between, .share = runs_.rules().doubt_of_two() * between};
  if (!is_known(known, accuracy)) return condition(first, accuracy);
  condition_symmetry(first, accuracy);
}

// A motion at rest does not feel one rounding, though roundings add up. The repetition is pushed by
// many, as it was drawn, and the effect is in proportion. An unstable equilibrium may be left as
// far as it can be: fewer roundings tell then. The run's own forces round as well.
void Check::condition_rest(const Trial& judge) {
  const Stage& stage = runs_.stage();
  const Rules& rules = runs_.rules();
  std::vector<double> differences;
  double roundings = 1, largest = 0;
  for (const int power : {20, 10, 0}) {
    roundings = std::ldexp(1.0, power);
    differences.clear();
    if (stage.has_springs()) {
      differences =
          stage.distances_as_drawn(judge, *judge.method, judge.value,
                                   {.seconds = runs_.seconds_left()}, {.roundings = roundings});
    } else {
      const Trial& twin = runs_.make_pushed(*judge.method, judge.value, {.roundings = roundings});
      if (twin.reached_end()) differences = stage.distances(judge, twin);
    }
    if (differences.empty()) return;
    largest = std::ranges::max(differences);
    if (largest <= rules.small * rules.small) break;
  }
  for (double& difference : differences) difference /= roundings;
  const double effect = std::max(machine_epsilon, largest / roundings);
  conditioning_ = Conditioning{.effect = effect,
                               .share = rules.doubt_of_two() * rules.doubt * effect,
                               .differences = std::move(differences)};
}

bool Check::condition_symmetry(const Trial& judge, double accuracy) {
  const Stage& stage = runs_.stage();
  if (!stage.is_reduced_by_symmetry()) return true;
  if (!conditioning_) conditioning_.emplace();
  const Rules& rules = runs_.rules();
  // The drawn motion may need a finer tolerance than the reduced one: it passes beside what that
  // one passes through. A smaller distance then was not that of rounding.
  const std::int64_t most_forces =
      std::max(runs_.forces_within(rules.much_work),
               static_cast<std::int64_t>(rules.doubt_of_two() * runs_.forces(judge)));
  bool is_run = false;
  double value = judge.value;
  for (int i = 0; i < 3; ++i, value *= rules.small) {
    const auto left = stage.distances_as_drawn(
        judge, *judge.method, value, {.seconds = runs_.seconds_left(), .forces = most_forces});
    if (left.empty()) break;
    const double by = beyond_own_error(
        judge, stage.of() == AccuracyOf::path ? std::ranges::max(left) : left.back());
    if (!is_run || by < conditioning_->leaves_by) {
      conditioning_->leaves_by = by;
      conditioning_->differences_left = left;
    }
    is_run = true;
    if (by <= rules.part_of_judge * accuracy || judge.method->knob != Knob::rtol ||
        rules.small * value < least_accuracy)
      break;
  }
  conditioning_->share =
      std::max(conditioning_->share, rules.doubt_of_two() * conditioning_->leaves_by);
  if (!is_run) conditioning_.reset();
  return is_run;
}

// The error that states between steps may have beyond those that were seen: in some steps it is a
// part of the tolerance.
double Check::between_steps(const Trial& trial) const {
  const Stage& stage = runs_.stage();
  if (stage.of() == AccuracyOf::positions || stage.rests() || trial.method->knob != Knob::rtol)
    return 0;
  const Rules& rules = runs_.rules();
  // Looks end steps of the other methods, so that a run with fewer looks has longer steps.
  if (!trial.method->is(Trait::interpolates)) return rules.doubt / rules.small * trial.value;
  return rules.doubt_of_two() * rules.small * trial.value;
}

std::optional<Bound> Check::bound(const Trial& trial) const {
  if (!trial.reached_end() || judges_.empty()) return {};
  const Stage& stage = runs_.stage();
  const Rules& rules = runs_.rules();
  const double least = rules.doubt_of_two() * machine_epsilon,
               share = conditioning_ ? conditioning_->share : 0;
  if (stage.of() == AccuracyOf::energy) {
    // The largest error between the looks and steps may be larger than at them. Steps that end at
    // looks, as a tolerance bounds them, end elsewhere with others.
    const bool is_bounded = trial.method->knob == Knob::rtol;
    const double seen =
        (is_bounded ? rules.doubt_of_two() : rules.doubt) * stage.energy_error(trial);
    const bool interpolates = trial.method->is(Trait::interpolates);
    // The relative error of a velocity counts twice in the kinetic energy, and velocities turn
    // faster than positions.
    const double between =
        interpolates ? std::max(seen, rules.doubt_of_two() * between_steps(trial)) : seen;
    return Bound{between + least + share};
  }
  std::optional<Bound> best;
  for (const auto& [by, own] : judges_) {
    const bool is_itself = by == &trial;
    // Both count twice or more, so that the larger holds them, as fixed steps stay the same. A
    // judge's own error may be a little larger than its bound, beside a distance that is larger.
    const double judged =
        by->method->knob == Knob::rtol ? own.error + share : std::max(own.error, share);
    const double error =
        judged + least + between_steps(trial) +
        (is_itself ? 0 : between_steps(*by) + (1 + rules.small) * runs_.distance(trial, *by));
    if (best && best->error <= error) continue;
    best = Bound{error, is_itself ? own.by : by, is_itself && own.by_coarser};
  }
  return best;
}

bool Check::is_known(const Trial& trial, double accuracy) const {
  if (trial.is_pushed) return false;
  const auto most = bound(trial);
  return most && most->error <= accuracy;
}

const Trial* Check::best() const {
  const Trial* least = nullptr;
  double error = std::numeric_limits<double>::infinity();
  for (const Trial& trial : runs_.all()) {
    if (trial.is_pushed) continue;
    const auto own = bound(trial);
    if (!own || own->error >= error) continue;
    error = own->error;
    least = &trial;
  }
  return least;
}

const Trial* Check::fastest(double accuracy) const {
  const Trial* least = nullptr;
  for (const Trial& trial : runs_.all()) {
    if ((!least || trial.seconds < least->seconds) && is_known(trial, accuracy)) least = &trial;
  }
  return least;
}

}  // namespace qddot::inline measure
