#include "qddot/measure/advice/advise.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "qddot/analysis/damped_step.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/failure.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::inline measure {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void keep_faster(std::optional<Candidate>& fastest, const Candidate& candidate) {
  if (!fastest || candidate.seconds < fastest->seconds) fastest = candidate;
}

// The bound of a run's error without looks. Steps of error control that end at looks are longer
// without them, and errors on the way may be ten times as large. Those at the end are of runs that
// have no looks (see try_sundials).
double error_without_looks(const Search& search, const Trial& trial) {
  const Method& method = *trial.method;
  const Stage& stage = search.runs().stage();
  const bool is_alone = stage.model().system().has_massless();
  const double error = search.check().bound(trial)->error;
  return method.ends_steps_at_looks() && !is_alone && stage.of() != AccuracyOf::positions
             ? error / search.runs().rules().small
             : error;
}

// The fastest runs that are known to reach the accuracy.
Advice advice_for(const Search& search, double accuracy) {
  Advice advice{.accuracy = accuracy};
  std::vector<Candidate> known;
  for (const Trial& trial : search.runs().all()) {
    if (!search.check().is_known(trial, accuracy)) continue;
    const double error = error_without_looks(search, trial);
    if (error <= accuracy) known.push_back({trial.method, trial.value, error, trial.seconds});
  }
  std::ranges::sort(known, {}, &Candidate::seconds);
  for (const Candidate& c : known) {
    if (!advice.take) advice.take = c;
    if (!advice.runner_up && c.method != advice.take->method) advice.runner_up = c;
    if (c.method->family == Family::sundials) {
      keep_faster(advice.sundials, c);
    } else {
      keep_faster(c.method->is(Trait::implicit) ? advice.own_implicit : advice.own_explicit, c);
    }
  }
  return advice;
}

// Runs of SUNDIALS' methods with error control, of the families that were not tried, while
// `seconds` last: they are compared only.
void try_sundials(Search& search, double accuracy, double seconds) {
  const double tolerance = search.runs().rules().small;  // of the accuracy
  const auto begin = clock_now();
  const System& system = search.runs().stage().model().system();
  for (const Method& method : methods()) {
    const double left = seconds - seconds_since(begin);
    if (left <= 0) break;
    if (method.family != Family::sundials || method.knob != Knob::rtol ||
        !method.stock_of.empty() || !applies_to(method, system) || method.order < 4 ||
        (system.has_massless() && !method.is(Trait::accepts_massless)))
      continue;
    search.try_once(method, std::clamp(tolerance * accuracy, 10 * least_accuracy, tolerance),
                    {.seconds = left, .only_end = true});
  }
}

Advices of_nothing(const Model& model, double until, const std::vector<double>& accuracies,
                   AccuracyOf of) {
  Advices all{.largest_stable_step = infinity, .horizon = infinity};
  for (const double accuracy : accuracies) {
    const Answer rest = solve(model, until, {.accuracy = accuracy, .of = of});
    Advice advice{.accuracy = accuracy, .why = rest.why};
    if (rest.is_reached) advice.take = Candidate{rest.method, rest.value, rest.error_estimate, 0};
    all.for_each.push_back(advice);
  }
  return all;
}

// With damping the limit at the start, shorter by as much as 2/w is.
double verlets_limit(const Model& model, double w_start, double w_motion) {
  if (!(w_motion > 0)) return infinity;
  if (!model.system().damping()) return 2 / w_motion;
  const double lag = find_method("verlet")->friction_lag;
  return w_start / w_motion * damped_step_limit(model.system(), model.initial().q, lag);
}

}  // namespace

double Advice::margin() const {
  if (!take || !runner_up || !(take->seconds > 0)) return infinity;
  return std::max(1.0, runner_up->seconds / take->seconds);
}

Advices advise(const Model& model, double until, const std::vector<double>& accuracies,
               AccuracyOf of, const Scene* drawn) {
  const auto begin = clock_now();
  for (const double accuracy : accuracies) require_accuracy(accuracy);
  if (accuracies.empty()) throw std::invalid_argument("advise: no accuracy is given");
  if (!(until > 0) || !std::isfinite(until))
    throw std::invalid_argument(fmt::format("until = {:g} is not allowed; it is above 0", until));
  if (model.system().size() == 0) return of_nothing(model, until, accuracies, of);
  require_constant_energy(model.system());
  if (!model.system().has_stiffness())
    throw std::invalid_argument(
        "advise: the system has no stiffness K, which its frequencies follow from");
  Search search(model, until, of, infinity, drawn);
  Advices all{.horizon = infinity};
  // The judge of the smallest accuracy judges for the others.
  std::vector<double> fine_first = accuracies;
  std::ranges::sort(fine_first);
  for (const double accuracy : fine_first) search.find(accuracy);
  // They take a small part of the time so far, or of a second.
  const double small = search.runs().rules().small;
  for (const double accuracy : fine_first)
    try_sundials(search, accuracy, small * std::max(1.0, seconds_since(begin)));
  for (const double accuracy : accuracies) {
    Advice advice = advice_for(search, accuracy);
    if (!advice.take) advice.why = why_not(search, accuracy, "").why;
    all.for_each.push_back(advice);
  }
  if (const auto parted = parting(search); parted && of != AccuracyOf::energy) {
    all.horizon = parted->horizon;
    all.lyapunov = parted->lyapunov;
  }
  all.w_start = all.w_motion = search.w_start();
  if (search.forecast()) {
    all.w_motion = search.forecast()->w_motion();
    all.own_frequency = search.forecast()->own().at(2);
  }
  all.largest_stable_step = verlets_limit(model, all.w_start, all.w_motion);
  all.runs = static_cast<int>(search.runs().all().size());
  all.seconds = seconds_since(begin);
  return all;
}

Advices advise(const Scene& scene, double until, const std::vector<double>& accuracies,
               AccuracyOf of) {
  const std::optional<Scene> settled = settled_if_asked(scene, scene.name);
  const Scene& start = settled ? *settled : scene;
  return advise(Model(start), until, accuracies, of, &start);
}

}  // namespace qddot::inline measure
