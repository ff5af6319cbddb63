#include "experiments/advice/hard_result.hpp"

#include <exception>

#include "experiments/advice/judged_motion.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/advise.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::judged_advice {
namespace {

constexpr double longest_answer = 20;  // [s]

const char* name(AccuracyOf of) {
  constexpr const char* names[] = {"positions", "path", "energy"};
  return names[static_cast<int>(of)];
}

}  // namespace

HardResult result_of(const HardCase& hard) {
  const Model model = hard.model();
  HardResult result{.number = static_cast<double>(hard.number),
                    .name = hard.scene.name,
                    .kind = hard.kind,
                    .of = name(hard.of),
                    .unknowns = static_cast<double>(model.system().size()),
                    .until = hard.until,
                    .accuracy = hard.accuracy};
  Answer answer;
  try {
    answer =
        solve(model, hard.until,
              {.accuracy = hard.accuracy, .of = hard.of, .seconds = longest_answer}, &hard.scene);
  } catch (const std::exception& error) {
    answer.why = error.what();
  }
  result.is_claimed = answer.is_reached;
  result.method = answer.method ? answer.method->name : "";
  result.kind_of_estimate = name(answer.error_estimate_kind);
  result.why = answer.why;
  result.value = answer.value;
  result.error_estimate = answer.error_estimate;
  result.seconds = answer.seconds.total();
  result.runs = answer.runs;

  const auto begin = clock_now();
  const JudgedMotion motion(hard);
  const TrueMotion& truth = motion.truth();
  result.truth_seconds = seconds_since(begin);
  result.left_out = truth.unknown_because;
  if (!truth.is_known()) return result;
  result.fine_error = motion.fine_error();
  result.conditioning = motion.conditioning();
  if (answer.method && answer.summary.outcome == Outcome::reached_end) {
    result.error = hard.of == AccuracyOf::positions
                       ? position_error(answer.nodes, truth.path.back(), motion.scales())
                       : motion.error_of(*answer.method, answer.value);
  }
  try {
    const Advices advices = advise(model, hard.until, {hard.accuracy}, hard.of, &hard.scene);
    result.advice_seconds = advices.seconds;
    const auto& take = advices.for_each.front().take;
    if (!take) return result;
    result.advised = take->method->name;
    result.advised_value = take->value;
    result.advised_error = motion.error_of(*take->method, take->value);
  } catch (const std::exception&) {  // no advice; an answer's exception is told
  }
  return result;
}

const Columns<HardResult>& hard_columns() {
  using R = HardResult;
  static const Columns<HardResult> columns = {
      {"case", &R::name},
      {"kind", &R::kind},
      {"of", &R::of},
      {"left_out", &R::left_out},
      {"is_claimed", [](const R& r) { return r.is_claimed ? 1 : 0; }},
      {"is_well_posed", [](const R& r) { return r.is_well_posed() ? 1 : 0; }},
      {"method", &R::method},
      {"error_estimate_kind", &R::kind_of_estimate},
      {"why", &R::why},
      {"advised", &R::advised},
      {"unknowns", &R::unknowns},
      {"until", &R::until},
      {"accuracy", &R::accuracy},
      {"value", &R::value},
      {"error_estimate", &R::error_estimate},
      {"error", &R::error},
      {"conditioning", &R::conditioning},
      {"fine_error", &R::fine_error},
      {"runs", &R::runs},
      {"seconds", &R::seconds},
      {"truth_seconds", &R::truth_seconds},
      {"advised_value", &R::advised_value},
      {"advised_error", &R::advised_error},
      {"advice_seconds", &R::advice_seconds}};
  return columns;
}

}  // namespace qddot::judged_advice
