#include "experiments/advice/case_result.hpp"

#include "experiments/advice/hindsight.hpp"
#include "qddot/measure/advice/advise.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::judged_advice {
namespace {

// Fraction of the accuracy that the reference may be off by.
constexpr double good_reference = 0.3;

void measure_worth(CaseResult& result, const ReducedScene& model, const Reference& reference,
                   const Answer& answer, int repeats) {
  result.certified = reference.certified.position;
  result.error =
      errors_between(model, answer.end, reference.end, reference.energy, reference.scales).position;
  const Hindsight found = hindsight(model, result.until, result.accuracy, reference, repeats);
  if (found.best.outcome == Outcome::reached_end) {
    result.best_method = found.best.method->name;
    result.best_value = found.best.value;
    result.best_seconds = found.best.time;
  }
  const Point own = measure_point(*answer.method, answer.value, model, result.until, reference,
                                  {.seconds = 60, .repeats = repeats});
  result.run_seconds = own.time;
}

}  // namespace

CaseResult result_of(const Case& drawn, double reference_seconds, int repeats) {
  const ReducedScene model(drawn.scene);
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
  const Answer answer = solve(model, drawn.until, {.accuracy = drawn.accuracy});
  result.is_claimed = answer.is_reached;
  result.method = answer.method ? answer.method->name : "";
  result.kind_of_estimate = name(answer.error_estimate_kind);
  result.why = answer.why;
  result.value = answer.value;
  result.error_estimate = answer.error_estimate;
  result.total_seconds = answer.seconds.total();
  result.runs = answer.runs;
  const Advices advices = advise(model, drawn.until, {drawn.accuracy});
  result.advice_seconds = advices.seconds;
  if (const auto& take = advices.for_each.front().take) {
    result.advised = take->method->name;
    result.advised_error = take->error;
    result.advised_seconds = take->seconds;
  }
  try {
    const Reference reference = make_reference(model, drawn.until, reference_seconds);
    if (reference.certified.position > good_reference * drawn.accuracy) {
      result.left_out = "the reference is not certified to three tenths of the accuracy";
      result.certified = reference.certified.position;
    } else if (answer.method) {
      measure_worth(result, model, reference, answer, repeats);
    }
  } catch (const NoReference& error) {
    result.left_out = error.what();
  }
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
      {"advised_error", &CaseResult::advised_error},
      {"advised_time_s", &CaseResult::advised_seconds},
      {"advice_time_s", &CaseResult::advice_seconds}};
  return columns;
}

}  // namespace qddot::judged_advice
