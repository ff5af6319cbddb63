#include "qddot/measure/advice/solve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/break_errors.hpp"
#include "qddot/measure/advice/failure.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::inline measure {
namespace {

void fill(Answer& answer, const Search& search, const Trial& trial, const Model& model) {
  answer.method = trial.method;
  answer.value = trial.value;
  answer.summary = trial.summary;
  if (trial.method->ends_steps_at_looks() && !trial.only_end)
    answer.looks = search.runs().stage().times();
  answer.end = trial.path.empty() ? model.initial() : trial.path.back();
  answer.nodes = model.expand(answer.end);
  answer.seconds.run = trial.seconds;
  answer.break_errors = break_errors(search, trial);
  const auto bound = search.check().bound(trial);
  if (bound && bound->by) answer.seconds.check = bound->by->seconds;
}

EstimateKind kind_of(const Search& search, const Trial& trial, AccuracyOf of) {
  if (of == AccuracyOf::energy) return EstimateKind::conserved;
  if (trial.method->order == 0) return EstimateKind::rounding;
  const auto bound = search.check().bound(trial);
  return bound && bound->by_coarser ? EstimateKind::refined : EstimateKind::compared;
}

// The last trial that came to the end, else the last one; nullptr if none was made.
const Trial* last_of(const Search& search) {
  const Trial* last = nullptr;
  for (const Trial& trial : search.runs().all()) {
    if (trial.is_pushed) continue;
    if (!last || trial.reached_end() || !last->reached_end()) last = &trial;
  }
  return last;
}

// The answer for a scene that rests or moves in closed form. It has rounding errors only; these are
// larger beside a motion that is small beside its coordinates.
Answer of_nothing(const Model& model, double until, const Wanted& wanted) {
  Answer answer;
  const auto fits = [&](const Method& method) { return applies_to(method, model.system()); };
  const auto is_exact = [&](const Method& method) { return method.order == 0 && fits(method); };
  const auto exact = std::ranges::find_if(methods(), is_exact);
  answer.method = exact != methods().end() ? &*exact : &*std::ranges::find_if(methods(), fits);
  answer.value = until;
  answer.end = model.initial();
  answer.end.t = until;
  answer.summary.outcome = Outcome::reached_end;
  answer.summary.t_reached = until;
  answer.summary.message.clear();
  answer.nodes = model.expand(answer.end);
  const std::vector<Node> start = model.expand(model.initial());
  double extent = 0, displacement = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (start[i].pinned) continue;
    extent = std::max(extent, start[i].position.lpNorm<Eigen::Infinity>());
    displacement = std::max(displacement, (answer.nodes[i].position - start[i].position).norm());
  }
  const bool counts = displacement > 0 && wanted.of != AccuracyOf::energy;
  const double roundings = counts ? std::max(1.0, extent / displacement) : 1;
  // Coordinates that were settled are sums of many.
  constexpr Rules rules;
  answer.error_estimate = machine_epsilon * (counts ? 4 * roundings : rules.rest);
  answer.error_estimate_kind = EstimateKind::rounding;
  answer.is_reached = answer.error_estimate <= wanted.accuracy;
  if (!answer.is_reached) {
    answer.why = fmt::format("one rounding of the start changes the motion by {:.1e} of it",
                             machine_epsilon * roundings);
  }
  return answer;
}

}  // namespace

const char* name(EstimateKind kind) {
  constexpr const char* names[] = {"compared", "refined",   "conserved",
                                   "rounding", "neglected", "none"};
  return names[static_cast<int>(kind)];
}

const char* name(AdvisedBy origin) {
  constexpr const char* names[] = {"modes", "forecast", "tolerance"};
  return names[static_cast<int>(origin)];
}

void require_accuracy(double accuracy, const std::string& said) {
  if (accuracy >= least_accuracy && accuracy < 1) return;
  throw std::invalid_argument(
      fmt::format("{} {:g} is not allowed; it is a relative error from 1e-14 (rounding) to below 1 "
                  "(as large as the motion)",
                  said, accuracy));
}

Answer solve(const Model& model, double until, const Wanted& wanted, const Scene* drawn) {
  const auto begin = clock_now();
  require_accuracy(wanted.accuracy);
  if (!(until > 0) || !std::isfinite(until))
    throw std::invalid_argument(fmt::format("until = {:g} is not allowed; it is above 0", until));
  if (model.system().size() == 0) return of_nothing(model, until, wanted);
  require_constant_energy(model.system());
  if (!model.system().has_stiffness())
    throw std::invalid_argument(
        "solve: the system has no stiffness K, which its frequencies follow from");
  Search search(model, until, wanted.of, wanted.seconds, drawn);
  Answer answer;
  const Trial* found = nullptr;
  std::string stopped_by;
  try {
    found = search.find(wanted.accuracy);
    if (search.runs().seconds_left() <= 0) stopped_by = "time was up";
  } catch (const Interrupted& interrupted) {
    stopped_by = interrupted.what();
  }
  if (found) {
    fill(answer, search, *found, model);
    answer.is_reached = true;
    if (std::string unclear =
            unclear_order(answer.summary.breaks, answer.break_errors, model.general_springs());
        !unclear.empty()) {
      answer.is_reached = false;
      answer.why = std::move(unclear);
    }
    answer.error_estimate = search.check().bound(*found)->error;
    answer.error_estimate_kind = kind_of(search, *found, wanted.of);
    answer.advised_by = found->method->order == 0        ? AdvisedBy::modes
                        : search.is_judged_by_forecast() ? AdvisedBy::forecast
                                                         : AdvisedBy::tolerance;
  } else {
    const Failure failure = why_not(search, wanted.accuracy, stopped_by);
    answer.why = failure.why;
    answer.horizon = failure.horizon;
    answer.lyapunov = failure.lyapunov;
    answer.advised_by = AdvisedBy::tolerance;
    const Trial* best = search.check().best();
    const Trial* shown = best ? best : last_of(search);
    if (shown) fill(answer, search, *shown, model);
    // Beyond the horizon two lost runs may be near each other by chance.
    if (best && !(answer.horizon <= until)) {
      answer.error_estimate = search.check().bound(*best)->error;
      answer.error_estimate_kind = kind_of(search, *best, wanted.of);
    }
  }
  answer.runs = static_cast<int>(search.runs().all().size());
  answer.seconds.pilots = seconds_since(begin) - answer.seconds.run - answer.seconds.check;
  return answer;
}

Answer solve(const Scene& scene, double until, const Wanted& wanted) {
  const std::optional<Scene> settled = settled_if_asked(scene, scene.name);
  const Scene& start = settled ? *settled : scene;
  return solve(Model(start), until, wanted, &start);
}

Answer solve(const Scene& scene, double until, double accuracy) {
  return solve(scene, until, Wanted{.accuracy = accuracy});
}

}  // namespace qddot::inline measure
