// The last phase of a search: runs that may be faster than its answer.
#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"

namespace qddot::inline measure {
namespace {

// A run is made only if it is expected to take less than this fraction of the answer's time.
constexpr double clearly_faster = 0.92;

// The time [s] for runs that may be faster than the answer. It is unnoticed by users or, for a long
// answer, a small part of the answer's time.
double seconds_of_race(const Trial& answer) {
  constexpr double unnoticed = 0.02, as_long = 0.01, part = 0.08;
  const double falling = as_long * as_long / answer.seconds;
  return std::max(std::min(unnoticed, falling), part * answer.seconds);
}

}  // namespace

std::optional<Candidate> Search::more_steps(const Method& method, double accuracy,
                                            double seconds) const {
  constexpr double fewest = 1.2, most = 6, infinite = std::numeric_limits<double>::infinity();
  double steps = 1, enough = steps;
  for (const Trial& trial : trials_) {
    if (trial.method != &method) continue;
    const bool failed = !trial.reached_end();
    if (failed ? trial.summary.outcome != Outcome::diverged : is_known(trial, accuracy)) return {};
    const double missed = failed ? infinite : error(trial);
    const double times = std::pow(missed / (good_enough * accuracy), 1.0 / method.order);
    const double made = std::round(stage_.until() / trial.value);
    steps = std::max(steps, std::ceil(std::clamp(times, fewest, most) * made));
    // A lost run does not predict how many steps are enough.
    if (missed < lost) enough = std::max(enough, times * made);
  }
  const double h = stage_.until() / std::max(steps, enough);
  if (!(forecast_->seconds(method, h) < seconds)) return {};
  return Candidate{&method, stage_.until() / steps, 0, forecast_->seconds(method, h)};
}

// A run without forecast that may be faster than the answer. Adaptive methods of high order are for
// few unknowns, multirate methods for named stiff forces. Times of adaptive runs and of the first
// implicit steps are uncertain, so these are tried only if much time is left.
std::optional<Candidate> Search::unknown(const Trial& answer, double accuracy, double left) const {
  constexpr Index few = 60;
  constexpr double part_of_answer = 0.5, much = 2;
  const bool has_time = left > much * answer.seconds;
  const double seconds = std::min(left, part_of_answer * answer.seconds);
  const ReducedScene& model = stage_.model();
  const System& system = model.system();
  for (const char* name : {"linear_midpoint", "linear_midpoint4", "multirate_adams4",
                           "multirate_adams2", "multirate_adams5", "trapezoidal", "hht", "trbdf2",
                           "bdf2", "dprkn12", "dprkn8", "dprkn6"}) {
    const Method& method = *find_method(name);
    if (!applies_to(method, system)) continue;
    const bool is_new = std::ranges::find(trials_, &method, &Trial::method) == trials_.end();
    if (method.is(Trait::implicit)) {
      if (!may_be_implicit()) continue;
      const auto next = more_steps(method, accuracy, is_new && has_time ? left : seconds);
      if (next && !was_tried(*next)) return next;
      continue;
    }
    if (!is_new) continue;
    if (method.knob == Knob::rtol) {
      if (system.size() <= few && has_time)
        return Candidate{&method, std::clamp(accuracy, 1e-13, 1e-2), 0, 0};
    } else {
      const double w = resolved_frequency(method, system, model.initial().q);
      const double steps = std::max(8.0, std::ceil(stage_.until() * w));
      return Candidate{&method, stage_.until() / steps, 0, 0};
    }
  }
  return {};
}

// The fastest run, not made yet, that is expected to reach the accuracy in less than `seconds`.
// `explicitly` leaves explicit methods only.
std::optional<Candidate> Search::promised(double accuracy, double seconds, bool explicitly) const {
  for (const Candidate& c : forecast_->candidates(good_enough * accuracy)) {
    if (c.seconds > seconds) break;
    if (was_tried(c) || (c.method->is(Trait::implicit) && (explicitly || !may_be_implicit())))
      continue;
    return c;
  }
  return {};
}

// A run in less than `seconds` by an explicit method of which no error was seen. Its expected error
// may exceed the accuracy by the factor `unsure`.
std::optional<Candidate> Search::unseen(double accuracy, double seconds) const {
  constexpr double unsure = 30;
  for (const Candidate& c : forecast_->candidates(unsure * good_enough * accuracy, true)) {
    if (c.seconds > seconds) break;
    if (!forecast_->has_seen(*c.method) && !was_tried(c)) return c;
  }
  return {};
}

// An implicit run that is likely to reach the accuracy in less than `seconds`, because an earlier
// run of the method missed it by little.
std::optional<Candidate> Search::lead(double accuracy, double seconds) const {
  constexpr double near = 6;  // times as many steps, at most
  std::optional<Candidate> best;
  for (const Trial& trial : trials_) {
    const Method& method = *trial.method;
    if (!may_be_implicit() || !method.is(Trait::implicit) || method.knob != Knob::step_size ||
        !trial.reached_end() ||
        !(error(trial) < std::min(lost, std::pow(near, method.order) * good_enough * accuracy)))
      continue;
    const std::optional<Candidate> next = more_steps(method, accuracy, seconds);
    if (next && !was_tried(*next) && (!best || next->seconds < best->seconds)) best = next;
  }
  return best;
}

const Trial* Search::race(const Trial* answer, double accuracy, double seconds) {
  if (!answer) return nullptr;
  seconds = std::min(seconds, seconds_of_race(*answer));
  survey_again();
  // A lead may take this fraction of the answer's time, even beyond the time limit of the race.
  constexpr double worth = 0.5;
  int leads = 2;
  const double end = seconds_since(begin_) + seconds;
  while (forecast_ && answer->method->order > 0 && seconds_left() > 0) {
    const double left = end - seconds_since(begin_);
    const double faster = std::min(left, clearly_faster * answer->seconds);
    // The best-known methods come first.
    std::optional<Candidate> next = promised(accuracy, faster, true);
    if (!next) next = unknown(*answer, accuracy, left);
    if (!next) next = unseen(accuracy, faster);
    if (!next) next = promised(accuracy, faster, false);
    double longest = std::min(left, clearly_faster * answer->seconds + 1e-5);
    if (!next || left <= 0) {
      longest = worth * answer->seconds;
      next = leads-- > 0 ? lead(accuracy, longest) : std::nullopt;
    }
    if (!next) break;
    const Trial& trial = run(*next->method, next->value, longest);
    if (trial.seconds < answer->seconds && is_known(trial, accuracy)) answer = &trial;
  }
  return forecast_ && is_known(*answer, accuracy)
             ? gamble(answer, accuracy, end - seconds_since(begin_))
             : answer;
}

const Trial* Search::gamble(const Trial* answer, double accuracy, double seconds) {
  constexpr double most = 300, coarser = 2;
  const double end = seconds_since(begin_) + seconds;
  if (of_ == AccuracyOf::energy) return answer;
  for (double factor = coarser; factor < most; factor *= coarser) {
    for (const Candidate& c : forecast_->candidates(factor * good_enough * accuracy, true)) {
      const double left = std::min(end - seconds_since(begin_), seconds_left());
      if (c.seconds > std::min(left, clearly_faster * answer->seconds)) break;
      if (was_tried(c)) continue;
      trials_.push_back(stage_.run(*c.method, c.value, left));
      Trial& trial = trials_.back();
      trial.is_gamble = true;
      if (!is_known(trial, accuracy)) continue;
      stage_.time_again(trial);
      if (trial.seconds < answer->seconds) answer = &trial;
    }
  }
  return answer;
}

void Search::try_once(const Candidate& candidate, double seconds) {
  if (!was_tried(candidate)) run(*candidate.method, candidate.value, seconds);
}

}  // namespace qddot::inline measure
