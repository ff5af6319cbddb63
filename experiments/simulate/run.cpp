#include "experiments/simulate/run.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/simulate/outputs.hpp"
#include "experiments/simulate/pace.hpp"
#include "qddot/integrators/option_table.hpp"
#include "qddot/integrators/spring_changes.hpp"
#include "qddot/measure/advice/lesser_answer.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/samples.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/measure/stability/diagnosis.hpp"
#include "qddot/measure/stability/energy_loss.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::simulate {
namespace {

// The time [s] for explaining why a run failed: some twenty times the run's, between these limits.
constexpr double shortest_patience = 1, longest_patience = 5;
// The least time [s] for explaining what energy a run lost; it is three times the run's.
constexpr double shortest_look = 0.5;

// The time [s] that an interruption waits for the present step.
constexpr double patience_with_a_step = 60;

// The time [s] that an interruption waits for the results found so far.
constexpr double patience_with_an_answer = 60;

void refuse_choices(const Program& program) {
  std::vector<std::string> chosen = {"--method"};
  for (const OptionRow& row : option_rows()) {
    if (row.is_of_programs) chosen.push_back(row.program_name());
  }
  for (const std::string& option : chosen) {
    if (program.has(option)) {
      throw InvalidInput(fmt::format(
          "{} is not for --accuracy, which chooses the method and its knob: leave out one of both",
          option));
    }
  }
}

// The scene's choice. Strains are seen at each step, and parts have steps of their own.
SceneChoice choice_of(const Arguments& a) {
  SceneChoice choice = *a.scene;
  if (a.strain_path.is_given()) choice.no_reduce.emplace_back("parts");
  return choice;
}

// The changes of springs' phases in a run, in words; empty if there were none.
std::string changes_in_words(const Method& method, const Model& scene, const Summary& summary) {
  const auto count = [](std::size_t n, const char* one) {
    return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
  };
  std::string words;
  const std::size_t breaks = summary.breaks.size();
  if (breaks > 0)
    words = fmt::format("{} broke, the first at t = {:.6g} s", count(breaks, "spring"),
                        summary.breaks.front().t);
  const std::size_t others = static_cast<std::size_t>(summary.phase_changes) - breaks;
  if (others > 0)
    words += fmt::format("{}cables went slack or taut at {}, where steps ended",
                         words.empty() ? "" : "; ", count(others, "moment"));
  if (steps_over_slack(method.order, scene.system()))
    words += fmt::format(
        "{}{} steps over the moments at which cables go slack or taut, with an "
        "error of its own order, {}",
        words.empty() ? "" : "; ", method.name, method.order);
  return words;
}

// Repeats the run that was judged for the outputs on its way. Steps may end at these, and then the
// end is another one. So that of the answer is shown in its place.
void show_way(const Answer& answer, const std::shared_ptr<const Model>& model, double until,
              Outputs& output) {
  Simulation run(model, *answer.method, options_for(*answer.method, answer.value, *model));
  output.see(run.state());
  Observer observer = output.observer();
  observer.times = merged({observer.times, answer.looks});
  observer.see = [&answer, see = std::move(observer.see)](const State& state) {
    see(state.t == answer.end.t ? answer.end : state);
  };
  run.advance(until, observer, interruption());
}

// Numbers that are not finite become null where this is written.
nlohmann::json about(const Answer& answer, const Arguments& a) {
  return {{"accuracy", *a.accuracy},
          {"accuracy_of", a.accuracy_of->empty() ? "positions" : *a.accuracy_of},
          {"is_reached", answer.is_reached},
          {"why", answer.why},
          {"method", answer.method->name},
          {"knob", knob_name(answer.method->knob)},
          {"value", answer.value},
          {"error_estimate", answer.error_estimate},
          {"error_estimate_kind", name(answer.error_estimate_kind)},
          {"horizon", answer.horizon},
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
    case EstimateKind::neglected:
      return fmt::format("error at most {:.1e}, as the forces that are left out say",
                         answer.error_estimate);
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
  Subject subject = subject_of(choice_of(a), a.until);
  auto model = std::make_shared<const Model>(std::move(subject.model));
  const double until = subject.until;

  std::optional<Outputs> made(std::in_place, a, every, subject.drawn, subject.start(), *model,
                              until);
  wait_for_answer(patience_with_an_answer);
  progress().stage("looking for the fastest run");
  const Wanted wanted{.accuracy = a.accuracy, .of = of};
  const auto lesser = solve_with_less(subject.start(), reductions_of(choice_of(a)), until, wanted);
  if (lesser) {
    model = lesser->model;
    made.reset();
    made.emplace(a, every, subject.drawn, lesser->scene, *model, until);
  }
  Outputs& output = *made;
  const Answer answer = lesser ? lesser->answer : solve(*model, until, wanted, &subject.start());
  progress().wipe();
  const auto why = answer.is_reached ? std::nullopt : interrupted();
  if (!answer.method) {  // no run was begun
    fmt::print(stderr, "simulate: {}\n", answer.why);
    return why ? why->status : end_not_reached;
  }
  if (output.is_asked_for()) {
    if (output.looks_on_the_way()) show_way(answer, model, until, output);
    nlohmann::json origin = provenance(a.p.command_line(), subject.drawn, subject.start(), *model);
    origin["outcome"] = name(answer.summary.outcome);
    origin["t_reached"] = answer.end.t;
    origin["energy_growth"] = answer.summary.energy_growth;
    origin["energy_loss"] = answer.summary.energy_loss;
    origin["interrupted"] = why ? nlohmann::json(why->by) : nullptr;
    origin.update(about(answer, a));
    if (lesser && lesser->by == Reduction::rods)
      origin["rods"] = {{"count", lesser->rods}, {"change", lesser->change}};
    if (lesser && lesser->by == Reduction::linear) origin["linear"] = {{"change", lesser->change}};
    output.finish(answer.end, answer.summary.breaks, answer.break_errors, origin);
  }
  fmt::print(
      "{} to t = {:g} s: {} at {}; {}; {} for the run, {} for its check, {} to find them "
      "({} run{} in all)\n",
      in_one_line(subject.drawn.name), until, answer.method->name,
      knob_in_words(*answer.method, answer.value), estimate_in_words(answer),
      time_in_words(answer.seconds.run), time_in_words(answer.seconds.check),
      time_in_words(answer.seconds.pilots), answer.runs, answer.runs == 1 ? "" : "s");
  if (lesser) fmt::print("{}\n", lesser->in_words());
  if (answer.is_reached) return done;
  fmt::print(stderr, "simulate: --accuracy {:g} was not reached: {}\n", *a.accuracy, answer.why);
  return why ? why->status : end_not_reached;
}

int run_method(const Arguments& a) {
  if (a.accuracy_of.is_given()) {
    throw InvalidInput("--accuracy-of is given without --accuracy, which it belongs to");
  }
  const Method& method = require_method(a.method);
  const Options options = checked_options(a, method);
  const Every every = every_of(a);
  require_distinct_outputs(a);
  const Scene drawn = load(a.scene);
  const double until = end_time(a.until, a.until.is_given(), drawn);
  if (method.knob == Knob::step_size) require_step_size(a.step_size, "--step-size", until);
  const std::optional<Scene> settled = settled_if_asked(drawn, a.scene->name);
  const Scene& start = settled ? *settled : drawn;
  const auto model = [&] {
    const Reducing reducing(start);
    return std::make_shared<const Model>(reduced_for(method, start, reductions_of(choice_of(a))));
  }();
  const Model& scene = *model;
  require_fit(method, scene, a.scene->name);
  Simulation run(model, method, options);
  require_atol(run.options());

  Outputs output(a, every, drawn, start, scene, until);
  output.see(run.state());
  const auto warn = [](const std::string& warning) {
    if (!warning.empty()) fmt::print(stderr, "simulate: warning: {}\n", warning);
  };
  warn(tolerance_warning(run.options()));
  Summary summary;
  wait_for_answer(patience_with_a_step);
  const double seconds = seconds_of([&] {
    const Pace pace(run, until);
    summary = run.advance(until, output.observer(), interruption());
  });
  const auto why = summary.outcome == Outcome::over_budget ? interrupted() : std::nullopt;

  if (output.is_asked_for()) {
    nlohmann::json origin = provenance(a.p.command_line(), drawn, start, scene);
    origin["outcome"] = name(summary.outcome);
    origin["t_reached"] = summary.t_reached;
    origin["energy_growth"] = summary.energy_growth;
    origin["energy_loss"] = summary.energy_loss;
    origin["seconds"] = seconds;
    origin["interrupted"] = why ? nlohmann::json(why->by) : nullptr;
    output.finish(run.state(), summary.breaks, {}, origin);
  }
  fmt::print("{} on {}: {} at t = {:g} s after {}, in {:.3g} s\n", method.name,
             in_one_line(drawn.name), why ? "interrupted" : name(summary.outcome),
             summary.t_reached, counts_in_words(summary.counts), seconds);
  if (const std::string words = changes_in_words(method, scene, summary); !words.empty())
    fmt::print("{}\n", words);
  if (why) {
    fmt::print(stderr, "simulate: interrupted by {}: {} of {} s reached\n", why->by,
               summary.t_reached, until);
    return why->status;
  }
  if (summary.outcome != Outcome::diverged) warn(growth_warning(method, summary));
  if (summary.outcome == Outcome::reached_end) {
    warn(step_warning(method, options, scene));
    warn(loss_warning(method, options, scene, summary, until,
                      std::clamp(3 * seconds, shortest_look, longest_patience)));
    return done;
  }
  const double patience = std::clamp(20 * seconds, shortest_patience, longest_patience);
  const std::string more = diagnosis(method, options, scene, until, summary, patience);
  fmt::print(stderr, "simulate: {} of {} s reached: {}{}{}\n", summary.t_reached, until,
             summary.message, more.empty() ? "" : "; ", more);
  return end_not_reached;
}

}  // namespace qddot::simulate
