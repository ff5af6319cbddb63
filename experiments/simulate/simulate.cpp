// One run of one method on one scene: its end, its motion and its energy. If an accuracy is given
// in place of a method, the fastest run that reaches it.
//
//   simulate --scene cloth --method verlet --step-size 5e-4 --until 0.1 --final end.csv
//   simulate --scene cloth --method arkode_dirk4 --rtol 1e-5 --trajectory path.csv --every 0.01
//   simulate --scene cloth --accuracy 1e-4 --final end.csv
//   simulate --scene cloth --accuracy 1e-4 --motion cloth.vtkhdf --every 0.001
//   simulate --scene cloth --write-scene cloth.toml
//   simulate --scene cloth --explain
//   simulate --list-methods
//   simulate --list-scenes
#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/catalogue.hpp"
#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/simulate/answer.hpp"
#include "experiments/simulate/arguments.hpp"
#include "experiments/simulate/outputs.hpp"
#include "experiments/simulate/pace.hpp"
#include "experiments/simulate/written_scene.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/stability/diagnosis.hpp"
#include "qddot/scene/explain.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::simulate {
namespace {

// The time [s] for explaining why a run failed: some twenty times the run's, between these limits.
constexpr double shortest_patience = 1, longest_patience = 5;

// The time [s] that an interruption waits for the present step.
constexpr double patience_with_a_step = 60;

int simulate(const Arguments& a) {
  if (a.list_methods) {
    print_methods(a.csv);
    return done;
  }
  if (a.list_scenes) {
    print_generators(a.csv);
    return done;
  }
  require_given(a.scene->name, "--scene", "a generator's name or a scene file");
  if (only_writes_scene(a.p)) {
    require_distinct_outputs(a);
    WrittenScene(a.written_scene_path).commit(load(a.scene));
    return done;
  }
  if (a.explain) {
    const Subject subject = subject_of(a.scene);
    fmt::print("{}", explanation_in_words(explain(subject.start, subject.reduced), subject.start));
    return done;
  }
  if (a.accuracy.is_given()) return answer(a);
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
  const Scene start = started(drawn, a.scene);
  const auto model =
      std::make_shared<const ReducedScene>(reduced_for(method, start, reductions_of(a.scene)));
  const ReducedScene& scene = *model;
  require_fit(method, scene, a.scene->name);
  Simulation run(model, method, options);
  require_atol(run.options());

  WrittenScene written_scene(a.written_scene_path);
  Outputs output(a, every, start, scene, until);
  written_scene.commit(drawn);
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
    origin["seconds"] = seconds;
    origin["interrupted"] = why ? nlohmann::json(why->by) : nullptr;
    output.finish(run.state(), origin);
  }
  fmt::print("{} on {}: {} at t = {:g} s after {}, in {:.3g} s\n", method.name,
             in_one_line(drawn.name), why ? "interrupted" : name(summary.outcome),
             summary.t_reached, counts_in_words(summary.counts), seconds);
  if (why) {
    fmt::print(stderr, "simulate: interrupted by {}: {} of {} s reached\n", why->by,
               summary.t_reached, until);
    return why->status;
  }
  if (summary.outcome != Outcome::diverged) warn(growth_warning(method, summary));
  if (summary.outcome == Outcome::reached_end) {
    warn(step_warning(method, options, scene));
    return done;
  }
  const double patience = std::clamp(20 * seconds, shortest_patience, longest_patience);
  const std::string more = diagnosis(method, options, scene, until, summary, patience);
  fmt::print(stderr, "simulate: {} of {} s reached: {}{}{}\n", summary.t_reached, until,
             summary.message, more.empty() ? "" : "; ", more);
  return end_not_reached;
}

}  // namespace
}  // namespace qddot::simulate

int main(int argc, char** argv) {
  using namespace qddot;
  Program p(
      {.name = "simulate", .summary = "Runs one integrator on one scene.", .has_threads = true});
  const simulate::Arguments arguments{p};
  return p.run(argc, argv, [&] { return simulate::simulate(arguments); });
}
