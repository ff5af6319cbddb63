// How a search goes on once it has an answer: runs that may be faster.
#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/step_cost.hpp"
#include "qddot/measure/motion/resolved_frequency.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::measure {

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

}  // namespace qddot::measure
