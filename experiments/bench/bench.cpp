// Comparison with other people's solvers (peers): how many times as long as our methods do they
// take to the same accuracy? All run on the same scenes, in one process, on one thread.
//
//   bench --out results/bench
//   bench cloth@0.5 my.toml --point-limit 5 --out results/mine
//
//  1. Each peer is set up as its users would, compiled with the same flags, and runs over its
//     tolerances or step sizes. It runs with the f that a user writes, a loop over springs (in
//     Python NumPy with a sparse matrix), and with ours, if it can take one. It gets the scene
//     without reductions: only pinned nodes are no unknowns.
//  2. Our explicit methods run on the smallest system of the scene (reduced: all), and on the one
//     that the peers get (pins).
//  3. A ratio is the time of the peer's fastest run that reaches the accuracy, over that of our
//     fastest run with at most the same error. If the peer was over budget before, its time so far
//     over our fastest run is a lower bound of the ratio. Times are the processor's.
//  4. A peer that takes the same steps as one of our methods, as LAMMPS and verlet, is compared at
//     one step size: time of a step, springs a second, and distance of the ends.
//  5. bench.csv has every point, ratios.csv the ratios with their two runs, same_steps.csv the
//     results of step 4. `left_out` in their sidecars says which peers are missing and why.
#include <algorithm>
#include <charconv>
#include <exception>
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/bench/peer_choice.hpp"
#include "experiments/bench/peers.hpp"
#include "experiments/bench/ratio_table.hpp"
#include "experiments/bench/same_steps.hpp"
#include "experiments/kit/catalogue.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::bench {

// What nlohmann::json looks for by this name.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Measured, solver, force, unknowns, knob, value, outcome, error,
                                   seconds, timed, steps, force_evaluations)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SameSteps, solver, method, is_smallest, unknowns, springs,
                                   step_size, steps, peer_outcome, outcome, peer_step, step,
                                   distance, difference)

namespace {

const std::vector<double> accuracies = {1e-4, 1e-5, 1e-6, 1e-7, 1e-8};

// The names of our explicit methods that any scene can have, those of high order first.
std::vector<std::string> explicit_methods() {
  std::vector<const Method*> list;
  for (const Method& method : methods()) {
    const bool is_ours = method.family == Family::hand_written && !method.is(Trait::implicit);
    const bool asks_for_more = method.asks(Need::stiffness) ||
                               method.asks(Need::constant_stiffness) ||
                               method.asks(Need::split_forces);
    if (is_ours && !asks_for_more && method.order > 1) list.push_back(&method);
  }
  std::ranges::stable_sort(list, std::greater(), &Method::order);
  std::vector<std::string> names;
  for (const Method* method : list) names.push_back(method->name);
  return names;
}

struct Arguments {
  std::vector<std::string> scenes = {"cloth@0.1", "cloth@0.5", "chain", "lattice"};
  std::vector<std::string> methods = explicit_methods();
  std::vector<std::string> peers;
  std::string out;
  Pace pace;
};

void declare(CommandLine& line, Arguments& a) {
  line.add_option("scenes", a.scenes,
                  "generators' names or scene files; @T after a name runs it to T s")
      .capture_default_str();
  line.add_option("--methods", a.methods,
                  "a,b,...: our methods; naming the most accurate first saves time")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--peers", a.peers,
                  "a,b,...: the other solvers, by the beginnings of their names (default: all)")
      .delimiter(',');
  line.add_option("--repeats", a.pace.repeats, "timed runs of a point that takes under a second")
      .take_last()
      .capture_default_str();
  line.add_option("--point-limit", a.pace.limit, "seconds that one run may take")
      .take_last()
      .capture_default_str();
  line.add_option("--out", a.out, "the folder for bench.csv, ratios.csv and same_steps.csv");
}

// A scene and its end time [s].
struct Entry {
  SceneChoice choice;
  Scene drawn;
  double until;
};

Entry entry_of(const std::string& word) {
  const auto at = word.rfind('@');
  SceneChoice choice{.name = word.substr(0, at), .no_reduce = {}};
  const Scene drawn = load(choice);
  if (at == word.npos) return {choice, drawn, end_time(0, false, drawn)};
  double until = 0;
  const char *first = word.data() + at + 1, *last = word.data() + word.size();
  if (const auto [end, error] = std::from_chars(first, last, until);
      error != std::errc() || end != last) {
    throw InvalidInput(fmt::format("{}: after @ comes the time to run to in s, a number", word));
  }
  return {choice, drawn, end_time(until, true, drawn)};
}

// The library through which Python calls our f, where it was built.
std::string force_library() {
  std::error_code error;
  return std::filesystem::exists(FORCE_LIBRARY, error) ? FORCE_LIBRARY : "";
}

// Points that are pieces of the study.
Recall recall_by(Study& study, std::string prefix) {
  return [&study, prefix = std::move(prefix)](const std::string& name, const auto& take) {
    progress().now_at(name);
    return study.piece(prefix + name, [&] { return nlohmann::json(take()); })
        .template get<Measured>();
  };
}

std::size_t forces_of(const std::vector<Peer*>& peers) {
  std::size_t count = 0;
  for (const Peer* peer : peers) count += peer->forces().size();
  return count;
}

// Adds the sweeps to `sweeps` as they come.
void add_sweeps(Study& study, const std::string& prefix, const Problem& problem,
                const std::vector<Peer*>& peers, const Arguments& a, std::vector<Sweep>& sweeps) {
  const auto report = [](const Measured&) {};  // recall has said it before
  progress().begin(2 * a.methods.size() + forces_of(peers));
  for (const bool smallest : {true, false}) {
    const Recall recall = recall_by(study, prefix + (smallest ? "reduced " : "as drawn "));
    Pace own = a.pace;
    own.finest_error = accuracies.back() / 30;  // a peer's run may be better than it need be
    for (const std::string& method : a.methods) {
      const auto solver = our_method(method, smallest);
      sweeps.push_back(measure_ladder(*solver, ForceKind::ours, problem, own, recall, report));
      progress().finish(method + " is done");
      Sweep& last = sweeps.back();
      last.is_ours = true;
      last.is_smallest = smallest;
      for (Measured& point : last.points) {
        if (smallest) point.unknowns = problem.smallest.system().size();
        // What takes several times as long as the most accurate run is nowhere the fastest.
        if (point.is_good() && point.error <= own.finest_error) {
          own.limit = std::min(own.limit, 4 * point.seconds);
        }
      }
    }
  }
  Pace theirs = a.pace;
  theirs.finest_error = accuracies.back();
  const Recall recall = recall_by(study, prefix);
  for (Peer* peer : peers) {
    for (const ForceKind force : peer->forces()) {
      sweeps.push_back(measure_ladder(*peer, force, problem, theirs, recall, report));
      progress().finish(peer->name() + " is done");
    }
  }
}

struct Tables {
  CsvFile points, ratios, same_steps;

  explicit Tables(const std::string& folder)
      : points(folder + "/bench.csv", point_columns()),
        ratios(folder + "/ratios.csv", ratio_columns()),
        same_steps(folder + "/same_steps.csv", same_steps_columns()) {}
};

// Peers beside the method of ours that takes the same steps.
void compare_steps(Study& study, const std::string& prefix, const Entry& entry,
                   const Problem& problem, const std::vector<Peer*>& peers, const Pace& pace,
                   CsvFile& table) {
  for (Peer* peer : peers) {
    if (peer->twin().empty()) continue;
    for (const bool smallest : {true, false}) {
      progress().stage(fmt::format("{} beside {}", peer->name(), peer->twin()));
      const std::string piece =
          fmt::format("{}{} beside {} {}", prefix, peer->name(), peer->twin(), smallest);
      const auto same = study
                            .piece(piece,
                                   [&] {
                                     return nlohmann::json(same_steps(*peer, smallest, problem,
                                                                      pace.repeats, pace.limit));
                                   })
                            .get<SameSteps>();
      progress().wipe();
      same_steps_row(table, entry.drawn.name, entry.until, same);
      print_same_steps(entry.drawn.name, entry.until, same);
    }
  }
}

// Throws Interrupted, once what was measured of the scene is in the tables.
void compare(Study& study, const Entry& entry, const std::vector<Peer*>& peers, const Arguments& a,
             const nlohmann::json& origin, Tables& tables) {
  const Scene start = started(entry.drawn, entry.choice);
  const std::string folder = fmt::format("{}/{}_{:g}", a.out, entry.drawn.name, entry.until);
  require_folder(folder);
  progress().stage("making the reference");
  const Problem problem(entry.drawn, start, entry.until, folder, origin);
  std::vector<Sweep> sweeps;
  const std::string prefix = fmt::format("{} {:.17g} ", content_hash(entry.drawn), entry.until);
  std::exception_ptr end;
  try {
    add_sweeps(study, prefix, problem, peers, a, sweeps);
  } catch (const Interrupted&) {
    end = std::current_exception();
  }
  progress().wipe();
  for (const Sweep& sweep : sweeps) {
    for (const Measured& point : sweep.points) {
      point_row(tables.points, entry.drawn.name, entry.until, sweep, point);
    }
  }
  if (end) std::rethrow_exception(end);  // ratios would be of a part of the points
  compare_steps(study, prefix, entry, problem, peers, a.pace, tables.same_steps);
  for (const bool smallest : {true, false}) {
    const auto all = ratios(sweeps, smallest, accuracies);
    for (const Ratio& ratio : all) {
      ratio_row(tables.ratios, entry.drawn.name, entry.until, smallest, ratio);
    }
    const Index n = (smallest ? problem.smallest : problem.scene).system().size();
    print_ratios(all, accuracies,
                 fmt::format("{}, {:g} s: time of a peer ({} unknowns) over ours ({} unknowns)",
                             entry.drawn.name, entry.until, problem.scene.system().size(), n));
  }
}

int bench(const CommandLine& line, const Arguments& a,
          const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  require_positive(a.pace.limit, "--point-limit", "the seconds a run may take");
  require_repeats(a.pace.repeats);
  for (const std::string& method : a.methods) {
    if (find_method(method)) continue;
    throw InvalidInput(
        fmt::format("--methods: {} is not a method; allowed are {}", method, method_names()));
  }
  std::vector<Entry> entries;
  for (const std::string& word : a.scenes) entries.push_back(entry_of(word));
  require_folder(a.out);
  nlohmann::json about = nlohmann::json::array();
  for (const Entry& entry : entries) about.push_back({content_hash(entry.drawn), entry.until});
  Study study(line, a.out, {"bench.csv", "ratios.csv", "same_steps.csv"}, about);
  if (const auto status = study.completed()) return *status;
  Tables tables(a.out);
  LeftOut left_out;
  const auto peers = selected_peers(a.peers, force_library(), left_out);

  nlohmann::json origin = provenance(command_line, entries.front().drawn);
  origin.erase("scene");
  origin["scenes"] = nlohmann::json::array();
  for (const Entry& entry : entries) {
    origin["scenes"].push_back(
        {{"scene", provenance(command_line, entry.drawn).at("scene")}, {"until", entry.until}});
  }
  study.measure([&] {
    for (const Entry& entry : entries) {
      nlohmann::json own = provenance(command_line, entry.drawn);
      own["until"] = entry.until;
      compare(study, entry, fitting(peers, entry.drawn, left_out), a, own, tables);
    }
  });
  origin["left_out"] = left_out.sentences();
  return study.finish({&tables.points, &tables.ratios, &tables.same_steps}, origin, done);
}

}  // namespace
}  // namespace qddot::bench

int main(int argc, char** argv) {
  using namespace qddot::bench;
  return qddot::kit::enter<Arguments>(
      {.name = "bench",
       .summary =
           "Measures how many times as long as our methods other solvers take to an accuracy.",
       .has_resume = true},
      declare, bench, argc, argv);
}
