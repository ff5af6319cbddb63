#include "qddot/measure/advice/solve.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::inline measure {
namespace {

void fill(Answer& answer, const Search& search, const Trial& trial, const ReducedScene& model) {
  answer.method = trial.method;
  answer.value = trial.value;
  answer.summary = trial.summary;
  answer.end = trial.path.empty() ? model.initial() : trial.path.back();
  answer.nodes = model.expand(answer.end);
  answer.seconds.run = trial.seconds;
  const auto bound = search.bound(trial);
  if (bound && bound->by) answer.seconds.check = bound->by->seconds;
}

EstimateKind kind_of(const Search& search, const Trial& trial, AccuracyOf of) {
  if (of == AccuracyOf::energy) return EstimateKind::conserved;
  if (trial.method->order == 0) return EstimateKind::rounding;
  const auto bound = search.bound(trial);
  return bound && bound->by_coarser ? EstimateKind::refined : EstimateKind::compared;
}

// The run with the least known error bound, and that bound. For two runs without a bound it is
// twice their distance, as if both had about the same error.
std::pair<const Trial*, double> nearest(const Search& search, AccuracyOf of) {
  const Trial* best = search.most_accurate();
  double least = std::numeric_limits<double>::infinity();
  for (const Trial& trial : search.trials()) {
    const auto bound = search.bound(trial);
    if (!bound || bound->error >= least) continue;
    least = bound->error;
    best = &trial;
  }
  if (of == AccuracyOf::energy) return {best, least};
  const Trial* finest = search.most_accurate();
  for (const Trial& trial : search.trials()) {
    if (&trial == finest || !trial.reached_end()) continue;
    const double apart = 2 * search.distance(trial, *finest);
    if (apart >= least) continue;
    least = apart;
    best = finest;
  }
  return {best, least};
}

// The last time [s] until which the two most accurate runs agree to the accuracy.
double agreed_until(const Search& search, const Trial& one, double accuracy) {
  const Trial* other = nullptr;
  for (const Trial& trial : search.trials()) {
    if (&trial == &one || !trial.reached_end()) continue;
    if (!other || search.error(trial) < search.error(*other)) other = &trial;
  }
  double until = 0;
  if (!other) return until;
  const std::vector<double> distances = search.stage().distances(one, *other);
  for (std::size_t i = 0; i < distances.size() && 2 * distances[i] <= accuracy; ++i)
    until = search.stage().times()[i];
  return until;
}

// Explains why no run is known to be accurate enough, and which accuracy or end is possible.
// `stopped_by`: the reason why the search ended early, or empty.
void explain_failure(Answer& answer, Search& search, const Wanted& wanted, double until,
                     const std::string& stopped_by) {
  const auto [best, least] = nearest(search, wanted.of);
  if (!best) {
    const Trial* last = search.trials().empty() ? nullptr : &search.trials().back();
    if (last) fill(answer, search, *last, search.stage().model());
    answer.why =
        last ? fmt::format("no run reached the end; {} at {:g}: {}", last->method->name,
                           last->value, stopped_by.empty() ? last->summary.message : stopped_by)
             : stopped_by;
    return;
  }
  fill(answer, search, *best, search.stage().model());
  answer.error_estimate = least;
  answer.error_estimate_kind =
      std::isfinite(least) ? kind_of(search, *best, wanted.of) : EstimateKind::none;
  const std::string reached = std::isfinite(least)
                                  ? fmt::format("the smallest known error bound is {:.1e}", least)
                                  : "no error is known";
  if (!stopped_by.empty()) {
    answer.why = fmt::format("{}; {}", stopped_by, reached);
    return;
  }
  if (wanted.of != AccuracyOf::energy) {
    const Trial* seen = search.most_accurate(true);
    const auto parted =
        seen ? parting_of_twins(search.stage(), *seen, search.seconds_left()) : std::nullopt;
    if (parted) {
      answer.horizon = parted->horizon;
      answer.lyapunov = parted->lyapunov;
    }
  }
  const double agreed = agreed_until(search, *best, wanted.accuracy);
  const std::string instead =
      agreed > 0 ? fmt::format("; up to t = {:.3g} s it can be reached", agreed) : "";
  if (answer.horizon <= until) {
    // Two lost runs may be near each other by chance.
    answer.error_estimate = std::numeric_limits<double>::infinity();
    answer.error_estimate_kind = EstimateKind::none;
    answer.why = fmt::format(
        "the motion is chaotic: from t = {:.3g} s on nobody knows its positions (errors grow by a "
        "factor of e in {}){}; ask for an earlier end, or for --accuracy-of energy",
        answer.horizon, duration_in_words(1 / answer.lyapunov), instead);
  } else if (answer.lyapunov > 0) {
    answer.why = fmt::format(
        "the motion is chaotic: rounding has grown beyond the accuracy by t = {:g} s; {}{}", until,
        reached, instead);
  } else {
    answer.why = fmt::format("no method is known to reach this accuracy; {}{}", reached, instead);
  }
}

// The answer for a scene that rests or moves in closed form: it has rounding errors only.
Answer of_nothing(const ReducedScene& model, double until) {
  Answer answer;
  answer.is_reached = true;
  const Method* exact = find_method("exact");
  answer.method = applies_to(*exact, model.system()) ? exact : find_method("verlet");
  answer.value = until;
  answer.error_estimate = 4 * machine_epsilon;
  answer.error_estimate_kind = EstimateKind::rounding;
  answer.end = model.initial();
  answer.end.t = until;
  answer.summary.outcome = Outcome::reached_end;
  answer.summary.t_reached = until;
  answer.summary.message.clear();
  answer.nodes = model.expand(answer.end);
  return answer;
}

}  // namespace

const char* name(EstimateKind kind) {
  constexpr const char* names[] = {"compared", "refined", "conserved", "rounding", "none"};
  return names[static_cast<int>(kind)];
}

const char* name(AdvisedBy origin) {
  constexpr const char* names[] = {"modes", "forecast", "refinement", "tolerance"};
  return names[static_cast<int>(origin)];
}

void require_accuracy(double accuracy, const std::string& said) {
  if (accuracy >= least_accuracy && accuracy < 1) return;
  throw std::invalid_argument(
      fmt::format("{} {:g} is not allowed; it is a relative error from 1e-14 (rounding) to below 1 "
                  "(as large as the motion)",
                  said, accuracy));
}

Answer solve(const ReducedScene& model, double until, const Wanted& wanted) {
  const auto begin = clock_now();
  require_accuracy(wanted.accuracy);
  if (!(until > 0) || !std::isfinite(until))
    throw std::invalid_argument(fmt::format("until = {:g} is not allowed; it is above 0", until));
  if (model.system().size() == 0) return of_nothing(model, until);
  if (!model.system().has_stiffness())
    throw std::invalid_argument(
        "solve: the system has no stiffness K, which its frequencies follow from");
  Search search(model, until, wanted.of, wanted.seconds);
  Answer answer;
  const Trial* found = nullptr;
  std::string stopped_by;
  try {
    if (search.survey(wanted.accuracy)) found = search.find(wanted.accuracy);
    if (found) found = search.race(found, wanted.accuracy, search.seconds_left());
    // The race may have raised the bound of the run, or removed it.
    if (found && !search.is_known(*found, wanted.accuracy)) found = search.find(wanted.accuracy);
    if (search.seconds_left() <= 0) stopped_by = "time was up";
  } catch (const Interrupted& interrupted) {
    stopped_by = interrupted.what();
  }
  answer.advised_by = search.forecast()                   ? AdvisedBy::forecast
                      : model.system().has_massless()     ? AdvisedBy::tolerance
                      : found && found->method->order > 0 ? AdvisedBy::refinement
                                                          : AdvisedBy::modes;
  if (found && search.is_known(*found, wanted.accuracy)) {
    fill(answer, search, *found, model);
    answer.is_reached = true;
    answer.error_estimate = search.bound(*found)->error;
    answer.error_estimate_kind = kind_of(search, *found, wanted.of);
  } else {
    explain_failure(answer, search, wanted, until, stopped_by);
  }
  answer.runs = static_cast<int>(search.trials().size());
  answer.seconds.pilots = seconds_since(begin) - answer.seconds.run - answer.seconds.check;
  return answer;
}

Answer solve(const Scene& scene, double until, const Wanted& wanted) {
  const Scene start = scene.starts_at_equilibrium ? settled(scene, scene.name) : scene;
  return solve(ReducedScene(start), until, wanted);
}

Answer solve(const Scene& scene, double until, double accuracy) {
  return solve(scene, until, Wanted{.accuracy = accuracy});
}

}  // namespace qddot::inline measure
