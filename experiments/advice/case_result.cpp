#include "experiments/advice/case_result.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/advise.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/judgement.hpp"
#include "qddot/measure/speed/ladder_points.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::judged_advice {
namespace {

// A run, and all runs of a case together [s].
constexpr double longest_run = 2, patience = 25;
// Runs so much slower than the fastest in one timing may be as fast in several.
constexpr double close_race = 1.3;

// The methods in the order in which they are likely to be fast: what comes first bounds the time of
// the others.
std::vector<const Method*> in_order_of_promise(const System& system) {
  std::vector<const Method*> order;
  for (const char* first : {"exact", "symmetric6", "symmetric4", "symmetric8", "verlet",
                            "symmetric10", "dprkn8", "dprkn12"}) {
    order.push_back(find_method(first));
  }
  for (const Method& method : methods()) {
    if (std::ranges::find(order, &method) == order.end()) order.push_back(&method);
  }
  // Those of order 1, the stock twins, and SUNDIALS' explicit methods, which each take several
  // times what others do on all charts, never bound anything.
  std::erase_if(order, [&](const Method* method) {
    return !applies_to(*method, system) || method->order == 1 || !method->stock_of.empty() ||
           (method->family == Family::sundials && !method->is(Trait::implicit));
  });
  return order;
}

// Finds the fastest run that is known to be within `accuracy` of the reference. It tries all
// methods that fit the scene and may be the fastest, the most promising ones first, for half a
// minute in all. A ladder ends when its runs take longer than the fastest run so far. The best few
// runs are timed `repeats` times. It is over budget if no run came so far.
Point best_in_hindsight(const Model& scene, double until, double accuracy,
                        const Reference& reference, int repeats) {
  Point best;
  best.outcome = Outcome::over_budget;
  Effort effort{.seconds = longest_run, .repeats = 1};
  const auto is_enough = [&](const Point& point) {
    return judged(point, reference).is_within(accuracy);
  };
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Point> enough;
  for (const Method* method : in_order_of_promise(scene.system())) {
    if (seconds_since(begin) > patience) break;
    const std::vector<Point> points = measure_ladder(
        *method, scene, until, reference, effort, [](const Point&) {}, is_enough);
    // Luck does not count.
    const auto all_judged = judged_together(points, reference, judge_of(reference));
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].outcome == Outcome::reached_end && all_judged[i].is_within(accuracy))
        enough.push_back(points[i]);
    }
    if (enough.empty()) continue;
    best = *std::ranges::min_element(enough, {}, &Point::time_min);
    effort.seconds = std::min(effort.seconds, close_race * best.time_min + 1e-4);
  }
  std::vector<Point> near;
  for (const Point& point : enough) {
    if (point.time_min <= close_race * best.time_min) near.push_back(point);
  }
  effort = {.seconds = 4 * longest_run, .repeats = repeats};
  for (const Point& point : near) {
    const Point timed = measure_point(*point.method, point.value, scene, until, reference, effort);
    if (timed.outcome == Outcome::reached_end &&
        (timed.time_min <= best.time_min || best.timed_runs < repeats))
      best = timed;
  }
  return best;
}

// Fraction of the accuracy that the reference may be off by.
constexpr double good_reference = 0.3;

// The error of positions at the end; infinite if the run does not reach it.
double error_of_run(const Method& method, double value, const Model& model,
                    const Reference& reference) {
  const Point point = measure_point(method, value, model, reference.end.t, reference,
                                    {.seconds = 60, .repeats = 1});
  return point.outcome == Outcome::reached_end ? point.errors.position
                                               : std::numeric_limits<double>::infinity();
}

void measure_worth(CaseResult& result, const Model& model, const Reference& reference,
                   const Answer& answer, int repeats) {
  result.error =
      errors_between(model, answer.end, reference.end, reference.energy, reference.scales).position;
  const Point best = best_in_hindsight(model, result.until, result.accuracy, reference, repeats);
  if (best.outcome == Outcome::reached_end) {
    result.best_method = best.method->name;
    result.best_value = best.value;
    result.best_seconds = best.time;
  }
  const Point own = measure_point(*answer.method, answer.value, model, result.until, reference,
                                  {.seconds = 60, .repeats = repeats});
  result.run_seconds = own.time;
}

}  // namespace

CaseResult result_of(const Case& drawn, double reference_seconds, int repeats) {
  const Model model(drawn.scene);
  CaseResult result{.name = drawn.scene.name,
                    .kind = drawn.kind,
                    .unknowns = static_cast<double>(model.system().size()),
                    .springs = static_cast<double>(drawn.scene.springs.size()),
                    .until = drawn.until,
                    .accuracy = drawn.accuracy};
  if (model.system().size() == 0) {
    result.left_out = "nothing is left to be integrated";
    return result;
  }
  std::optional<Reference> reference;
  try {
    reference = make_reference(model, drawn.until, reference_seconds, &drawn.scene);
  } catch (const NoReference& error) {
    result.left_out = error.what();
    return result;
  }
  result.certified = reference->certified.position;
  if (reference->is_only_symmetric()) {
    result.left_out = "the drawn motion leaves its symmetry";
    return result;
  }
  if (!(result.certified <= good_reference * drawn.accuracy)) {
    result.left_out = "the reference is not certified to three tenths of the accuracy";
    return result;
  }
  const Answer answer = solve(model, drawn.until, {.accuracy = drawn.accuracy}, &drawn.scene);
  result.is_claimed = answer.is_reached;
  result.method = answer.method ? answer.method->name : "";
  result.kind_of_estimate = name(answer.error_estimate_kind);
  result.why = answer.why;
  result.value = answer.value;
  result.error_estimate = answer.error_estimate;
  result.total_seconds = answer.seconds.total();
  result.runs = answer.runs;
  const Advices advices =
      advise(model, drawn.until, {drawn.accuracy}, AccuracyOf::positions, &drawn.scene);
  result.advice_seconds = advices.seconds;
  if (const auto& take = advices.for_each.front().take) {
    result.advised = take->method->name;
    result.advised_value = take->value;
    result.advised_error = take->error;
    result.advised_seconds = take->seconds;
    result.advised_true_error = error_of_run(*take->method, take->value, model, *reference);
  }
  if (answer.method) measure_worth(result, model, *reference, answer, repeats);
  return result;
}

const Columns<CaseResult>& case_columns() {
  static const Columns<CaseResult> columns = {
      {"is_claimed", [](const CaseResult& result) { return result.is_claimed ? 1 : 0; }},
      {"case", &CaseResult::name},
      {"kind", &CaseResult::kind},
      {"left_out", &CaseResult::left_out},
      {"method", &CaseResult::method},
      {"error_estimate_kind", &CaseResult::kind_of_estimate},
      {"why", &CaseResult::why},
      {"best_method", &CaseResult::best_method},
      {"advised", &CaseResult::advised},
      {"unknowns", &CaseResult::unknowns},
      {"springs", &CaseResult::springs},
      {"until", &CaseResult::until},
      {"accuracy", &CaseResult::accuracy},
      {"value", &CaseResult::value},
      {"error_estimate", &CaseResult::error_estimate},
      {"error", &CaseResult::error},
      {"certified", &CaseResult::certified},
      {"best_value", &CaseResult::best_value},
      {"best_time_s", &CaseResult::best_seconds},
      {"run_time_s", &CaseResult::run_seconds},
      {"total_time_s", &CaseResult::total_seconds},
      {"runs", &CaseResult::runs},
      {"advised_value", &CaseResult::advised_value},
      {"advised_error", &CaseResult::advised_error},
      {"advised_true_error", &CaseResult::advised_true_error},
      {"advised_time_s", &CaseResult::advised_seconds},
      {"advice_time_s", &CaseResult::advice_seconds}};
  return columns;
}

}  // namespace qddot::judged_advice
