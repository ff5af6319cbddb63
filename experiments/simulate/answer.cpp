#include "experiments/simulate/answer.hpp"

#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/simulate/outputs.hpp"
#include "experiments/simulate/written_scene.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::simulate {
namespace {

// The time [s] that an interruption waits for the results found so far.
constexpr double patience = 60;

nlohmann::json finite_or_null(double x) {
  return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(nullptr);
}

void refuse_choices(const Program& program) {
  for (const char* option :
       {"--method", "--step-size", "--rtol", "--atol", "--max-order", "--stability-detection",
        "--iterations", "--solve-tolerance", "--spectral-radius", "--solver"}) {
    if (program.has(option)) {
      throw InvalidInput(fmt::format(
          "{} is not for --accuracy, which chooses the method and its knob: leave out one of both",
          option));
    }
  }
}

// Repeats the method's run for the outputs on its way; returns its end.
State seen(const Answer& answer, const std::shared_ptr<const ReducedScene>& model, double until,
           Outputs& output) {
  Simulation run(model, *answer.method, options_for(*answer.method, answer.value, *model));
  output.see(run.state());
  run.advance(until, output.observer(), interruption());
  return run.state();
}

nlohmann::json about(const Answer& answer, const Arguments& a) {
  return {{"accuracy", *a.accuracy},
          {"accuracy_of", a.accuracy_of->empty() ? "positions" : *a.accuracy_of},
          {"is_reached", answer.is_reached},
          {"why", answer.why},
          {"method", answer.method->name},
          {"knob", knob_name(answer.method->knob)},
          {"value", answer.value},
          {"error_estimate", finite_or_null(answer.error_estimate)},
          {"error_estimate_kind", name(answer.error_estimate_kind)},
          {"horizon", finite_or_null(answer.horizon)},
          {"lyapunov", answer.lyapunov},
          {"advised_by", name(answer.advised_by)},
          {"runs", answer.runs},
          {"seconds", answer.seconds.total()},
          {"seconds_by_phase",
           {{"pilots", answer.seconds.pilots},
            {"run", answer.seconds.run},
            {"check", answer.seconds.check}}}};
}

std::string estimate_in_words(const Answer& answer) {
  switch (answer.error_estimate_kind) {
    case EstimateKind::compared:
      return fmt::format("error at most {:.1e}, as a more accurate run says",
                         answer.error_estimate);
    case EstimateKind::refined:
      return fmt::format("error at most {:.1e}, as a coarser run of the same method says",
                         answer.error_estimate);
    case EstimateKind::conserved:
      return fmt::format("energy error at most {:.1e}, as seen on the way", answer.error_estimate);
    case EstimateKind::rounding:
      return fmt::format("error at most {:.1e}, which is rounding", answer.error_estimate);
    case EstimateKind::none:
      break;
  }
  return "error unknown";
}

}  // namespace

int answer(const Arguments& a) {
  refuse_choices(a.p);
  require_allowed_accuracy(a.accuracy);
  const AccuracyOf of = accuracy_of(a.accuracy_of);
  const Every every = every_of(a);
  require_distinct_outputs(a);
  Subject subject = subject_of(a.scene, a.until);
  const auto model = std::make_shared<const ReducedScene>(std::move(subject.reduced));
  const double until = subject.until;

  WrittenScene written_scene(a.written_scene_path);
  Outputs output(a, every, subject.start, *model, until);
  written_scene.commit(subject.drawn);
  wait_for_answer(patience);
  progress().stage("looking for the fastest run");
  const Answer answer = solve(*model, until, {.accuracy = a.accuracy, .of = of});
  progress().wipe();
  const auto why = answer.is_reached ? std::nullopt : interrupted();
  if (!answer.method) {  // no run was begun
    fmt::print(stderr, "simulate: {}\n", answer.why);
    return why ? why->status : end_not_reached;
  }
  if (output.is_asked_for()) {
    State end = answer.end;
    if (output.looks_on_the_way()) end = seen(answer, model, until, output);
    nlohmann::json origin = provenance(a.p.command_line(), subject.drawn, subject.start, *model);
    origin["outcome"] = name(answer.summary.outcome);
    origin["t_reached"] = end.t;
    origin["energy_growth"] = answer.summary.energy_growth;
    origin["interrupted"] = why ? nlohmann::json(why->by) : nullptr;
    origin.update(about(answer, a));
    output.finish(end, origin);
  }
  fmt::print(
      "{} to t = {:g} s: {} at {}; {}; {} for the run, {} for its check, {} to find them "
      "({} run{} in all)\n",
      in_one_line(subject.drawn.name), until, answer.method->name,
      knob_in_words(*answer.method, answer.value), estimate_in_words(answer),
      time_in_words(answer.seconds.run), time_in_words(answer.seconds.check),
      time_in_words(answer.seconds.pilots), answer.runs, answer.runs == 1 ? "" : "s");
  if (answer.is_reached) return done;
  fmt::print(stderr, "simulate: --accuracy {:g} was not reached: {}\n", *a.accuracy, answer.why);
  return why ? why->status : end_not_reached;
}

}  // namespace qddot::simulate
