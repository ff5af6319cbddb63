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

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/catalogue.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/method_options.hpp"
#include "experiments/kit/pace.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/simulate/answer.hpp"
#include "experiments/simulate/arguments.hpp"
#include "experiments/simulate/outputs.hpp"
#include "experiments/simulate/written_scene.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/stability/diagnosis.hpp"
#include "qddot/scene/explain.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::simulate {
namespace {

// The time [s] for explaining why a run failed: some twenty times the run's, between these limits.
constexpr double shortest_patience = 1, longest_patience = 5;

// The time [s] that an interruption waits for the present step.
constexpr double patience_with_a_step = 60;

std::string counts_in_words(const Counts& c) {
  std::string words =
      fmt::format("{} steps, {} force and {} stiffness evaluations, {} factorisations", c.steps,
                  c.force_evaluations, c.stiffness_evaluations, c.factorizations);
  if (c.indefinite_factorizations > 0) {
    words += fmt::format(", {} of them indefinite", c.indefinite_factorizations);
  }
  if (c.order_sum > 0) {
    words +=
        fmt::format(", mean order {:.2f}, lowered {} times", order_mean(c), c.order_reductions);
  }
  if (c.stability_limited_steps > 0) {
    words += fmt::format(", {} steps held to the stability limit", c.stability_limited_steps);
  }
  return words;
}

int explain_only(const Arguments& a) {
  const Scene start = started(load(a.scene), a.scene);
  fmt::print("{}", explanation_in_words(explain(start, ReducedScene(start, reductions_of(a.scene))),
                                        start));
  return done;
}

int simulate(const CommandLine& line, Arguments& a, const std::vector<std::string>& command_line) {
  if (a.list_methods) {
    print_methods(a.csv);
    return done;
  }
  if (a.list_scenes) {
    print_generators(a.csv);
    return done;
  }
  require_given(a.scene.name, "--scene", "a generator's name or a scene file");
  if (only_writes_scene(line)) {
    require_distinct_outputs(line, a);
    WrittenScene(a.written_scene_path).commit(load(a.scene));
    return done;
  }
  if (a.explain) return explain_only(a);
  if (line.has("--accuracy")) return answer(line, a, command_line);
  if (line.has("--accuracy-of")) {
    throw InvalidInput("--accuracy-of is given without --accuracy, which it belongs to");
  }
  const Method& method = require_method(a.method);
  const Options options = checked_options(line, a, method);
  assign_every(line, a);
  require_distinct_outputs(line, a);
  const Scene drawn = load(a.scene);
  const double until = end_time(a.until, line.has("--until"), drawn);
  if (method.knob == Knob::step_size) require_step_size(a.step_size, "--step-size", until);
  const Scene start = started(drawn, a.scene);
  Reductions reductions = reductions_of(a.scene);
  // Springs in series are one in tension only: who takes the node between them need not care.
  if (method.is(Trait::accepts_massless)) reductions = reductions.without(Reduction::massless);
  const ReducedScene scene(start, reductions);
  require_fit(method, scene, a.scene.name);
  const Options scaled = with_tolerance_scales(options, scene);
  require_atol(scaled);

  WrittenScene written_scene(a.written_scene_path);
  Outputs output(a, start, scene, until);
  written_scene.commit(drawn);
  State state = scene.initial();
  output.see(state);
  const auto warn = [](const std::string& warning) {
    if (!warning.empty()) fmt::print(stderr, "simulate: warning: {}\n", warning);
  };
  warn(tolerance_warning(scaled));
  const auto integrator = make_integrator(method, scene.system(), scaled);
  Summary summary;
  wait_for_answer(patience_with_a_step);
  const double seconds = seconds_of([&] {
    const Pace pace("simulate", *integrator, until);
    summary = integrator->advance(state, until, output.observer(), interruption());
  });
  const auto why = summary.outcome == Outcome::over_budget ? interrupted() : std::nullopt;

  if (output.is_asked_for()) {
    nlohmann::json origin = provenance(command_line, drawn, start, scene);
    origin["outcome"] = name(summary.outcome);
    origin["t_reached"] = summary.t_reached;
    origin["energy_growth"] = summary.energy_growth;
    origin["seconds"] = seconds;
    origin["interrupted"] = why ? nlohmann::json(why->by) : nullptr;
    output.finish(state, origin);
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
  using namespace qddot::simulate;
  return qddot::kit::enter<Arguments>(
      {.name = "simulate", .summary = "Runs one integrator on one scene.", .has_threads = true},
      declare, simulate, argc, argv);
}
