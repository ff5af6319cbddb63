// How a search goes on once it has an answer: runs that may be faster.
#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/resolved_frequency.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::measure {

// The steps that an implicit method should need that has missed the accuracy, or few of them where
// it was not tried, so long as that takes less than so many seconds; nothing else.
std::optional<Candidate> Search::more_steps(const Method& method, double accuracy,
                                            double seconds) const {
  constexpr double fewest = 1.5, most = 4;
  double steps = few_steps(accuracy);
  for (const Trial& trial : trials_) {
    if (trial.method != &method) continue;
    if (!trial.reached_end() || !(error(trial) > accuracy)) return {};
    const double missed = error(trial) / (good_enough * accuracy);
    const double times = std::clamp(std::pow(missed, 1.0 / method.order), fewest, most);
    steps = std::max(steps, std::ceil(times * std::round(stage_.until() / trial.value)));
  }
  const double h = stage_.until() / steps, expected = forecast_->seconds(method, h);
  if (!(expected < seconds)) return {};
  return Candidate{&method, h, 0, expected};
}

// A run of which nothing is known yet and that may be faster than the answer: of adaptive methods
// of high order for few unknowns, of those that take stiff forces apart where some are named, and
// of implicit ones where few of their steps take little beside it.
std::optional<Candidate> Search::unknown(double accuracy, double seconds) const {
  constexpr Index few = 60;
  // Their order is low, which is soon too many steps.
  constexpr double least_by_implicit = 1e-4;
  const ReducedScene& model = stage_.model();
  const System& system = model.system();
  for (const char* name : {"linear_midpoint", "trbdf2", "bdf2", "multirate_adams4",
                           "multirate_adams2", "multirate_adams5", "dprkn12", "dprkn8", "dprkn6"}) {
    const Method& method = *find_method(name);
    if (!applies_to(method, system)) continue;
    if (method.is(Trait::implicit)) {
      if (!may_be_implicit() || accuracy < least_by_implicit) continue;
      const auto next = more_steps(method, accuracy, seconds);
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
  constexpr double clearly_faster = 0.92, part_of_answer = 0.5;
  const double end = seconds_since(begin_) + seconds;
  while (answer && forecast_ && answer->method->order > 0 && seconds_left() > 0) {
    const double left = end - seconds_since(begin_);
    std::optional<Candidate> next;
    for (const Candidate& c : forecast_->candidates(good_enough * accuracy)) {
      if (was_tried(c) || c.seconds > clearly_faster * answer->seconds || c.seconds > left)
        continue;
      if (c.method->is(Trait::implicit)) continue;
      next = c;
      break;
    }
    if (!next) next = unknown(accuracy, std::min(left, part_of_answer * answer->seconds));
    if (next && next->seconds == 0 && left < 2 * answer->seconds) next.reset();
    if (!next) {
      for (const Candidate& c : forecast_->candidates(good_enough * accuracy)) {
        if (was_tried(c) || c.seconds > clearly_faster * answer->seconds || c.seconds > left)
          continue;
        if (!may_be_implicit()) continue;
        next = c;
        break;
      }
    }
    if (!next || left <= 0) break;
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

}  // namespace qddot::measure
