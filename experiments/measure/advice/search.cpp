#include "qddot/measure/advice/search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "qddot/analysis/frequency_bound.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/resolved_frequency.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::measure {
namespace {

// Fraction of the accuracy that a run is chosen to miss by, as it is known to a factor of about two
// before.
constexpr double aim = 0.45;
// Fraction of it that an earlier run may be expected to miss by and be taken for good enough.
constexpr double good_enough = 0.6;
// How many times as accurate a run must be to check another, and is chosen to be.
constexpr double checks = 3, chosen_to_check = 3.5;
// Above the distance from a check: that this is not quite as accurate as is expected.
constexpr double margin = 1.4;
constexpr int most_rounds = 14;
// Two runs that are `lost` apart have nothing to do with each other; up to `parting` their distance
// grows by itself.
constexpr double lost = 0.1, parting = 0.03;

// Each look costs as much as some forces.
int number_of_looks(double steps, AccuracyOf of) {
  return static_cast<int>(of == AccuracyOf::positions ? std::clamp(steps / 60, 4.0, 24.0)
                                                      : std::clamp(steps / 20, 20.0, 100.0));
}

double steps_of_verlet(const ReducedScene& model, double until) {
  const double w = frequency_bound(model.system(), model.initial().q);
  return std::isfinite(w) ? std::max(1.0, until * w / 2) : 1;
}

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

// Steps that implicit methods begin with: what is not to be accurate may be a motion of some steps.
double few_steps(double accuracy) { return accuracy > 1e-3 ? 2 : 8; }

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

Search::Search(const ReducedScene& model, double until, AccuracyOf of, double seconds)
    : of_(of),
      limit_(seconds),
      stage_(model, until, of, number_of_looks(steps_of_verlet(model, until), of)) {}

double Search::seconds_left() const {
  stop_if_interrupted();
  return limit_ - seconds_since(begin_);
}

Trial& Search::run(const Method& method, double value, double seconds) {
  const double expected = forecast_ ? forecast_->error(method, value) : 0;
  trials_.push_back(stage_.run(method, value, std::min(seconds, seconds_left())));
  Trial& trial = trials_.back();
  trial.expected = expected;
  if (!forecast_) return trial;
  if (trial.reached_end()) {
    forecast_->learn_seconds(trial);
  } else {
    forecast_->learn_failure(trial);
  }
  learn();
  return trial;
}

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
  first->expected = forecast_->error(*first->method, first->value);
  learn();
  return true;
}

// What rounding leaves of a motion that is computed mode by mode: w_max^2 is known to its last
// digit, so that a slower frequency w is off by w_max^2 / (2 w) of that, for a time t.
double Search::rounding() const {
  const Scales& scales = stage_.scales();
  const double slow = scales.displacement > 0 ? scales.speed / scales.displacement : 0;
  const double phase = w_start_ * stage_.until() * (slow > 0 ? std::max(1.0, w_start_ / slow) : 1);
  return 4 * machine_epsilon * (1 + phase);
}

double Search::expected(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return stage_.energy_error(trial);
  if (trial.method->order == 0) return rounding();
  return forecast_ ? forecast_->error(*trial.method, trial.value)
                   : std::pow(trial.value, power_of_error(*trial.method));
}

// What the error of `other` is of that of `trial`, at most.
double Search::ratio(const Trial& other, const Trial& trial) const {
  if (!forecast_ && other.method != trial.method) return std::numeric_limits<double>::infinity();
  const double doubt = forecast_ ? forecast_->doubt(*other.method, *trial.method) : 1;
  const double own = expected(trial), others = expected(other);
  return std::isfinite(others) ? others / own * doubt : std::numeric_limits<double>::infinity();
}

const Trial* Search::checker(const Trial& trial) const {
  const Trial* best = nullptr;
  for (const Trial& other : trials_) {
    if (&other != &trial && other.reached_end() && ratio(other, trial) * checks <= 1 &&
        (!best || ratio(other, trial) < ratio(*best, trial)))
      best = &other;
  }
  return best;
}

const Trial* Search::most_accurate(bool seen_on_its_way) const {
  const Trial* best = nullptr;
  for (const Trial& trial : trials_) {
    if (!trial.reached_end()) continue;
    if (seen_on_its_way && trial.path.size() < stage_.times().size()) continue;
    if (!best || expected(trial) < expected(*best)) best = &trial;
  }
  return best;
}

std::optional<double> Search::bound(const Trial& trial) const {
  if (!trial.reached_end()) return {};
  if (of_ == AccuracyOf::energy) return margin * stage_.energy_error(trial) + 4 * machine_epsilon;
  if (trial.method->order == 0) return expected(trial);
  const Trial* better = checker(trial);
  if (!better) return {};
  const double distance = stage_.distance(trial, *better);
  // A distance far below what is expected may be so by chance: errors change their sign. It is
  // believed half of the way.
  const double likely =
      forecast_ ? std::max(distance, std::sqrt(distance * std::min(expected(trial), 1.0)))
                : distance;
  return margin * likely / (1 - ratio(*better, trial)) + 4 * machine_epsilon;
}

double Search::error(const Trial& trial) const {
  if (of_ == AccuracyOf::energy) return stage_.energy_error(trial);
  if (const Trial* better = checker(trial)) return stage_.distance(trial, *better);
  return expected(trial);
}

// How far apart two runs are or, where they are lost, would be had their distance gone on growing.
double Search::lost_distance(const Trial& trial, const Trial& better) const {
  const double end = stage_.distance(trial, better);
  if (end < lost) return end;
  const auto& times = stage_.times();
  const std::vector<double> distances = stage_.distances(trial, better);
  std::size_t last = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] < parting) last = i;
  }
  if (last < 2) return std::max(end, 1.0);
  const double before = distances[last / 2];
  if (before == 0) return std::max(end, 1.0);
  constexpr double largest_exponent = 80;
  const double rate = std::log(distances[last] / before) / (times[last] - times[last / 2]);
  const double exponent = std::min(rate * (times.back() - times[last]), largest_exponent);
  return std::max(end, distances[last] * std::exp(exponent));
}

void Search::learn() {
  // A run that misses by a hundredth measures the motion well enough.
  constexpr double well_enough = 0.01;
  const Trial* best = most_accurate();
  if (best && best != measured_by_ && !(measured_within_ < well_enough)) {
    stage_.measure_by(*best);
    measured_by_ = best;
    measured_within_ = expected(*best);
  }
  for (const Trial& trial : trials_) {
    if (!trial.reached_end()) continue;
    if (of_ == AccuracyOf::energy) {
      forecast_->learn_error(trial, stage_.energy_error(trial));
    } else if (const Trial* better = checker(trial)) {
      const double error = lost_distance(trial, *better);
      // Steps that are far too long say nothing of those that are not.
      if (error < lost || !trial.method->is(Trait::implicit)) forecast_->learn_error(trial, error);
    }
  }
}

bool Search::was_tried(const Candidate& candidate) const {
  constexpr double same = 0.01;
  return std::ranges::any_of(trials_, [&](const Trial& trial) {
    return trial.method == candidate.method && std::abs(trial.value / candidate.value - 1) < same;
  });
}

// The cheapest run that is expected to be accurate enough to check the trial.
std::optional<Candidate> Search::check_of(const Trial& trial) const {
  std::optional<Candidate> best;
  for (const double doubt : Forecast::doubts) {
    for (const Candidate& c : forecast_->candidates(expected(trial) / (chosen_to_check * doubt))) {
      if (c.method->order == 0 || was_tried(c)) continue;
      if (forecast_->doubt(*c.method, *trial.method) > doubt) continue;
      if (c.method->is(Trait::implicit) && c.method != trial.method) continue;
      if (!best || c.seconds < best->seconds) best = c;
      break;
    }
  }
  return best;
}

// The run that is expected to come to the accuracy in the least time. Implicit ones only where they
// promise much: what a step of theirs takes is known badly before.
std::optional<Candidate> Search::fresh(double accuracy) const {
  constexpr double much = 0.2;
  const auto all = forecast_->candidates(accuracy);
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& c : all) {
    if (!c.method->is(Trait::implicit)) least = std::min(least, c.seconds);
  }
  // Of two that promise about the same, the one that was seen.
  constexpr double unseen = 1.2;
  std::optional<Candidate> best;
  double shortest = std::numeric_limits<double>::infinity();
  for (const Candidate& c : all) {
    if (c.error > 2 * accuracy || was_tried(c)) continue;
    if (c.method->is(Trait::implicit) && !(may_be_implicit() && c.seconds < much * least)) continue;
    const double seconds = c.seconds * (forecast_->has_learned(*c.method) ? 1 : unseen);
    if (seconds >= shortest) continue;
    shortest = seconds;
    best = c;
  }
  return best;
}

const Trial* Search::find(double accuracy) {
  if (stage_.model().system().has_massless()) return by_tolerance(accuracy);
  // Where so much did not do, more hardly will: chaos and rounding are not refined away.
  constexpr double always_allowed = 1, of_the_first = 60;
  const double most_seconds =
      seconds_since(begin_) + std::max(always_allowed, of_the_first * first_seconds_);
  for (int round = 0; round < most_rounds; ++round) {
    const Trial *known = nullptr, *promising = nullptr;
    for (const Trial& trial : trials_) {
      if (!trial.reached_end()) continue;
      const auto most = bound(trial);
      if (most && *most <= accuracy && (!known || trial.seconds < known->seconds)) known = &trial;
      if (!most && expected(trial) <= good_enough * accuracy &&
          (!promising || trial.seconds < promising->seconds))
        promising = &trial;
    }
    if (known) return known;
    if (!forecast_ || seconds_left() <= 0 || seconds_since(begin_) > most_seconds) return nullptr;
    std::optional<Candidate> next = promising ? check_of(*promising) : std::nullopt;
    if (!next) next = fresh(aim * accuracy);
    if (!next) return nullptr;
    run(*next->method, next->value, most_seconds - seconds_since(begin_));
  }
  return nullptr;
}

// Four times the steps that an implicit method has missed the accuracy with, or few of them where
// it was not tried, so long as that takes little beside the answer; nothing else.
std::optional<Candidate> Search::more_steps(const Method& method, double accuracy,
                                            const Trial& answer) const {
  constexpr double little = 0.1, times = 4;
  double steps = few_steps(accuracy);
  for (const Trial& trial : trials_) {
    if (trial.method != &method) continue;
    if (!trial.reached_end() || !(error(trial) > accuracy)) return {};
    steps = std::max(steps, times * std::round(stage_.until() / trial.value));
  }
  const double h = stage_.until() / steps;
  const double in_all = 1 + steps_to_analyse(stage_.model().system().size()) / steps;
  const double seconds = forecast_->seconds(method, h) * in_all;
  if (!(seconds < little * answer.seconds)) return {};
  return Candidate{&method, h, 0, seconds};
}

// A run of which nothing is known yet and that may be faster than the answer: of adaptive methods
// of high order for few unknowns, of those that take stiff forces apart where some are named, and
// of implicit ones where few of their steps take little beside it.
std::optional<Candidate> Search::unknown(double accuracy, const Trial& answer) const {
  constexpr Index few = 60;
  const ReducedScene& model = stage_.model();
  const System& system = model.system();
  for (const char* name : {"linear_midpoint", "trbdf2", "bdf2", "multirate_adams4",
                           "multirate_adams2", "multirate_adams5", "dprkn12", "dprkn8", "dprkn6"}) {
    const Method& method = *find_method(name);
    if (!applies_to(method, system)) continue;
    if (method.is(Trait::implicit)) {
      const auto next = may_be_implicit() ? more_steps(method, accuracy, answer) : std::nullopt;
      if (next && !was_tried(*next)) return next;
      continue;
    }
    if (std::ranges::find(trials_, &method, &Trial::method) != trials_.end()) continue;
    if (method.knob == Knob::rtol) {
      if (system.size() <= few) return Candidate{&method, std::clamp(accuracy, 1e-13, 1e-2), 0, 0};
    } else {
      const double w = resolved_frequency(method, system, model.initial().q);
      const double steps = std::max(8.0, std::ceil(stage_.until() * w));
      return Candidate{&method, stage_.until() / steps, 0, 0};
    }
  }
  return {};
}

const Trial* Search::race(const Trial* answer, double accuracy, double seconds) {
  constexpr double clearly_faster = 0.92;
  const double end = seconds_since(begin_) + seconds;
  while (answer && forecast_ && answer->method->order > 0 && seconds_left() > 0) {
    const double left = end - seconds_since(begin_);
    std::optional<Candidate> next = unknown(accuracy, *answer);
    for (const Candidate& c : forecast_->candidates(good_enough * accuracy)) {
      if (was_tried(c) || c.seconds > clearly_faster * answer->seconds) continue;
      if (c.method->is(Trait::implicit) && !may_be_implicit()) continue;
      if (next && next->seconds == 0 && left < 2 * answer->seconds) next.reset();
      if (!next) next = c;
      break;
    }
    if (!next || left < next->seconds || left <= 0) break;
    const Trial& trial =
        run(*next->method, next->value, std::min(left, clearly_faster * answer->seconds + 1e-5));
    const auto most = bound(trial);
    if (most && *most <= accuracy && trial.seconds < answer->seconds) answer = &trial;
  }
  return answer;
}

void Search::try_once(const Candidate& candidate, double seconds) {
  if (!was_tried(candidate)) run(*candidate.method, candidate.value, seconds);
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
