// One run of one method on one scene: where it ends, how it gets there, what its energy does.
//
//   simulate --scene cloth --method verlet --step-size 5e-4 --until 0.1 --final end.csv
//   simulate --scene cloth --method arkode_dirk4 --rtol 1e-5 --trajectory path.csv --every 0.01
//   simulate --scene cloth --write-scene cloth.toml
//   simulate --scene cloth --explain
//   simulate --list-methods
//   simulate --list-scenes
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/command/allowed_options.hpp"
#include "experiments/command/catalogue.hpp"
#include "experiments/command/command_line.hpp"
#include "experiments/command/csv.hpp"
#include "experiments/command/interruptible.hpp"
#include "experiments/command/method_options.hpp"
#include "experiments/command/node_table.hpp"
#include "experiments/command/overwriting.hpp"
#include "experiments/command/pace.hpp"
#include "experiments/command/program.hpp"
#include "experiments/command/provenance.hpp"
#include "experiments/command/scene_choice.hpp"
#include "experiments/command/whole_file.hpp"
#include "experiments/simulate/background_observer.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/samples.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/stability/diagnosis.hpp"
#include "qddot/scene/explain.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "qddot/scene/scene_writer.hpp"

namespace qddot::simulate {

using namespace measure;
using namespace command;
namespace {

// Seconds that may be spent on why a run failed: some twenty times what the run took.
constexpr double shortest_patience = 1, longest_patience = 5;

// An interruption waits so long [s] for the step at hand.
constexpr double patience_with_a_step = 60;

struct Arguments {
  SceneChoice scene;
  std::string method, final_path, trajectory_path, energy_path, written_scene_path;
  double step_size = 0, rtol = 0, atol = 0, until = 0, trajectory_every = 0, energy_every = 0;
  Options options;
  std::vector<double> every;
  bool list_methods = false, list_scenes = false, csv = false, explain = false;
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option("--method", a.method, "a method's name (--list-methods)");
  line.add_option("--step-size", a.step_size, "h in s, for methods of fixed step");
  line.add_option("--rtol", a.rtol, "relative tolerance, for adaptive methods");
  line.add_option("--atol", a.atol,
                  "absolute tolerance in m and m/s (default: --rtol times the scene's extent, and "
                  "times the speed that it starts towards)");
  add_method_options(line, a.options);
  line.add_option("--until", a.until, "the time to run to in s (default: the scene's own)");
  line.add_option("--final", a.final_path, "CSV of all nodes at the end: node,x,y,z,vx,vy,vz");
  line.add_option("--trajectory", a.trajectory_path, "CSV of all nodes over time: t,node,x,...");
  line.add_option("--energy", a.energy_path, "CSV of t,kinetic,potential,total");
  line.add_option(
      "--write-scene", a.written_scene_path,
      "TOML of the scene as nodes and springs, to the last bit; without --method nothing "
      "else is done");
  line.add_option("--every", a.every,
                  "the time between samples in s, which change no steps of fixed size. Stands "
                  "behind the output it "
                  "is for, or once for both")
      .take_each();
  line.add_flag("--explain", a.explain,
                "say what need not be integrated of the scene and why, and run nothing");
  line.add_flag("--list-methods", a.list_methods, "print the methods there are");
  line.add_flag("--list-scenes", a.list_scenes, "print the scene generators and their parameters");
  line.add_flag("--csv", a.csv, "lists as CSV");
}

// Each --every belongs to the output option before it; the only one belongs to both outputs.
void assign_every(const CommandLine& line, Arguments& a) {
  double* owner = nullptr;
  std::size_t next = 0;
  for (const std::string& name : line.order()) {
    if (name == "--trajectory") owner = &a.trajectory_every;
    if (name == "--energy") owner = &a.energy_every;
    if (name == "--every") {
      require_positive(a.every[next], "--every", "the time between samples in s");
      if (a.every.size() > 1 && (!owner || *owner != 0)) {
        throw InvalidInput(
            fmt::format("--every {}: of several, each stands behind the --trajectory "
                        "or --energy that it is for, one for each",
                        a.every[next]));
      }
      if (owner) *owner = a.every[next];
      ++next;
    }
  }
  if (a.every.size() == 1) a.trajectory_every = a.energy_every = a.every[0];
  const auto require = [](const std::string& path, double every, const char* option) {
    if (!path.empty() && every == 0) {
      throw InvalidInput(
          fmt::format("--every is missing behind {}; it is the time between samples "
                      "in s, greater than 0",
                      option));
    }
  };
  require(a.trajectory_path, a.trajectory_every, "--trajectory");
  require(a.energy_path, a.energy_every, "--energy");
  if (!a.every.empty() && a.trajectory_path.empty() && a.energy_path.empty()) {
    throw InvalidInput("--every is given without --trajectory or --energy, which it belongs to");
  }
}

void require_distinct_outputs(const CommandLine& line, const Arguments& a) {
  std::set<std::filesystem::path> taken;
  for (const auto& [option, path] :
       {std::pair("--final", a.final_path), std::pair("--trajectory", a.trajectory_path),
        std::pair("--energy", a.energy_path)}) {
    if (!line.has(option)) continue;
    require_given(path, option, "the name of a CSV file");
    for (const std::string& file : {path, sidecar_of(path)}) {
      if (taken.insert(std::filesystem::absolute(file).lexically_normal()).second) continue;
      throw InvalidInput(
          fmt::format("{} {}: another output or its sidecar goes to {}; allowed is a "
                      "file for each",
                      option, path, file));
    }
  }
  if (!line.has("--write-scene")) return;
  require_given(a.written_scene_path, "--write-scene", "the name of a TOML file");
  if (taken.contains(std::filesystem::absolute(a.written_scene_path).lexically_normal())) {
    throw InvalidInput(fmt::format(
        "--write-scene {}: another output or its sidecar goes there; allowed is a file for each",
        a.written_scene_path));
  }
}

// Whether the command line asks for the scene as a file and has nothing that is for a run.
bool only_writes_scene(const CommandLine& line) {
  const auto given = [&](const char* option) { return line.has(option); };
  constexpr std::array of_a_run = {"--method", "--step-size",  "--rtol",   "--atol", "--until",
                                   "--final",  "--trajectory", "--energy", "--every"};
  return given("--write-scene") && std::ranges::none_of(of_a_run, given);
}

const Method& require_method(const std::string& name) {
  require_given(name, "--method", "a method's name (simulate --list-methods prints them)");
  if (const Method* method = find_method(name)) return *method;
  throw InvalidInput(
      fmt::format("--method: {} is not a method; allowed are {}", name, method_names()));
}

Options checked_options(const CommandLine& line, const Arguments& a, const Method& method) {
  const bool fixed = method.knob == Knob::step_size;
  const char* wanted = fixed ? "--step-size" : "--rtol";
  for (const char* other : {"--step-size", "--rtol", "--atol"}) {
    const bool allowed =
        fixed ? other == std::string("--step-size") : other != std::string("--step-size");
    if (line.has(other) && !allowed) {
      throw InvalidInput(
          fmt::format("{} is not for {}, which takes {}", other, method.name, wanted));
    }
  }
  if (!line.has(wanted)) {
    throw InvalidInput(
        fmt::format("{} is missing; {} needs it, greater than 0", wanted, method.name));
  }
  if (fixed) require_step_size(a.step_size, "--step-size");
  if (!fixed) require_rtol(a.rtol, "--rtol");
  if (line.has("--atol")) require_positive(a.atol, "--atol", "an absolute tolerance");
  require_options(line, a.options, method);
  Options options = a.options;
  options.step_size = a.step_size;
  options.rtol = a.rtol;
  options.atol = a.atol;
  return options;
}

// A place for the scene that is asked for, taken before anything else is done.
class WrittenScene {
 public:
  explicit WrittenScene(const std::string& path) {
    if (!path.empty()) file_ = std::make_unique<WholeFile>(path);
  }
  void commit(const Scene& scene) {
    if (!file_) return;
    file_->write(signed_text(to_toml(scene)));
    file_->commit();
  }

 private:
  std::unique_ptr<WholeFile> file_;
};

class Output {
 public:
  Output(const Arguments& a, const ReducedScene& scene, double until)
      : scene_(scene),
        trajectory_times_(samples(a.trajectory_every, until)),
        energy_times_(samples(a.energy_every, until)) {
    const int d = scene.dimension();
    if (!a.final_path.empty()) {
      final_ = std::make_unique<CsvFile>(a.final_path, node_header(d, {}));
    }
    if (!a.trajectory_path.empty()) {
      trajectory_ = std::make_unique<CsvFile>(a.trajectory_path, node_header(d, {"t"}));
    }
    if (!a.energy_path.empty()) {
      energy_ = std::make_unique<CsvFile>(
          a.energy_path, std::vector<std::string>{"t", "kinetic", "potential", "total"});
    }
    if (trajectory_ || energy_) aside_.emplace([this](const State& state) { see(state); });
  }

  Observer observer() {
    return {merged(trajectory_times_, energy_times_),
            [this](const State& state) { aside_->see(state); }};
  }

  // Takes the state at time 0, before the run, or one that the observer asked for.
  void see(const State& state) {
    if (trajectory_ && is_sample(trajectory_times_, state.t)) {
      const auto nodes = scene_.expand(state);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        trajectory_->field(state.t);
        write_node(*trajectory_, i, nodes[i], scene_.dimension());
      }
      trajectory_->flush_if_large();
    }
    if (energy_ && is_sample(energy_times_, state.t)) {
      const double kinetic = scene_.kinetic(state);
      const double potential = scene_.potential(state);
      energy_->row(state.t, kinetic, potential, kinetic + potential);
      energy_->flush_if_large();
    }
  }

  bool is_asked_for() const { return final_ || trajectory_ || energy_; }
  void finish(const State& state, const nlohmann::json& origin) {
    if (aside_) aside_->finish();
    if (final_) {
      const auto nodes = scene_.expand(state);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        write_node(*final_, i, nodes[i], scene_.dimension());
      }
    }
    const std::array files = {final_.get(), trajectory_.get(), energy_.get()};
    for (CsvFile* file : files) {
      if (file) file->complete(origin);
    }
    for (CsvFile* file : files) {
      if (file) file->commit();
    }
  }

 private:
  const ReducedScene& scene_;
  std::vector<double> trajectory_times_, energy_times_;
  std::unique_ptr<CsvFile> final_, trajectory_, energy_;
  std::optional<BackgroundObserver> aside_;
};

std::string in_words(const Counts& c) {
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
  fmt::print("{}", in_words(explain(start, ReducedScene(start, reductions_of(a.scene))), start));
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
  Output output(a, scene, until);
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
             summary.t_reached, in_words(summary.counts), seconds);
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
  qddot::command::CommandLine line("Runs one integrator on one scene.", "simulate");
  qddot::simulate::Arguments arguments;
  qddot::simulate::declare(line, arguments);
  qddot::command::add_threads_option(line);
  return qddot::command::run_program(line, argc, argv, [&] {
    return qddot::simulate::simulate(line, arguments, {argv, argv + argc});
  });
}
