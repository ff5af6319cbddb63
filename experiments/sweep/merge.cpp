#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <omp.h>
#include <sstream>

#include <fmt/format.h>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/points.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/sweep/actions.hpp"
#include "experiments/sweep/results.hpp"
#include "experiments/sweep/status.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::sweep {

// The time [s] on one machine of each thing that methods count on a scene; zero where the scene has
// none of it.
struct WorkCosts {
  double force = 0, stiffness = 0, factorization = 0, solve = 0;
};
// nlohmann::json looks for it in the namespace of the type.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WorkCosts, force, stiffness, factorization, solve)

namespace {

namespace fs = std::filesystem;

// The whole tasks of one scene on one kind of machine, and the folder for their tables.
struct SceneTasks {
  std::string out;  // its folder
  std::vector<Task> tasks{};
  nlohmann::json machine{};  // of the points
};

// The scenes' parts in the order of the plan, made of the complete ones among these tasks.
std::vector<SceneTasks> parts_of(const std::vector<Task>& tasks, const MachineShare& share,
                                 const std::string& folder) {
  std::vector<SceneTasks> parts;
  std::map<std::string, std::size_t> numbers;
  const auto add = [&](const Task& task) {
    const auto [own, is_new] = numbers.try_emplace(task.folder, parts.size());
    if (is_new) parts.push_back({.out = folder + "/" + task.folder, .machine = share.machine});
    parts[own->second].tasks.push_back(task);
  };
  for (const Task* task : share.tasks) add(*task);
  for (const Task& task : tasks) {
    if (task.stage == references && task.state.kind == TaskState::whole &&
        numbers.contains(task.folder))
      add(task);
  }
  return parts;
}

// The value of an option among a program's words.
std::string value_of(const std::vector<std::string>& words, const std::string& option) {
  const auto found = std::ranges::find(words, option);
  return found == words.end() || found + 1 == words.end() ? "" : *(found + 1);
}

// Measures the costs on the scene of the task, as its program reduces it: f and K at the start, the
// numeric factorisation of M - h^2 K, and a solve with it. Each is the least of many calls.
// h = 1 / w_max makes the matrix positive definite if K allows.
WorkCosts measured_costs(const Task& task) {
  constexpr double seconds_each = 0.05;
  SceneChoice choice{.name = value_of(task.arguments, "--scene"), .no_reduce = {}};
  std::istringstream kept_as_drawn(value_of(task.arguments, "--no-reduce"));
  for (std::string one; std::getline(kept_as_drawn, one, ',');) choice.no_reduce.push_back(one);
  const Scene drawn = load(choice);
  const std::optional<Scene> settled = settled_if_asked(drawn, choice.name);
  const Model scene(settled ? *settled : drawn, reductions_of(choice));
  const System& system = scene.system();
  const Vec& q = scene.initial().q;
  Vec f(system.size());
  WorkCosts costs;
  costs.force = least_seconds(seconds_each, [&] { system.force(q, f); });
  if (!system.has_stiffness()) return costs;
  SymmetricMatrix k = system.stiffness_pattern();
  costs.stiffness = least_seconds(seconds_each, [&] { system.stiffness(q, k); });
  const double w = quick_frequency(system, q);
  const double h_squared = w > 0 ? 1 / (w * w) : 1;
  EffectiveMass matrix(system);
  costs.factorization = least_seconds(seconds_each, [&] { matrix.factorize(1, h_squared, k); });
  Vec x(system.size());
  costs.solve = least_seconds(seconds_each, [&] { matrix.solve(f, x); });
  return costs;
}

// The costs on the scene of the task, on this machine: kept in `folder`/costs.json, or measured and
// kept there.
WorkCosts costs_for(const Task& task, const std::string& folder) {
  const std::string path = folder + "/costs.json";
  const nlohmann::json key = {{"key", task.key}, {"machine", machine()}};
  std::ifstream file(path);
  const auto kept = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (kept.is_object() && kept.value("of", nlohmann::json()) == key)
    return kept.at("seconds").get<WorkCosts>();
  const WorkCosts costs = measured_costs(task);
  nlohmann::json json = provenance({});
  json["of"] = key;
  json["seconds"] = costs;
  write_whole(path, json.dump(1) + "\n");
  return costs;
}

// A piece that is a point (see record_of), its times replaced by counts times costs; anything else
// as it is. What a step does beside forces and solves counts nothing.
nlohmann::json by_work(nlohmann::json piece, const WorkCosts& costs) {
  if (!piece.is_object() || !piece.contains("counts") || !piece.contains("time")) return piece;
  const auto& counts = piece["counts"];
  const auto times = [&](const char* what) { return counts.at(what).get<double>(); };
  const double work = times("force_evaluations") * costs.force +
                      times("stiffness_evaluations") * costs.stiffness +
                      times("factorizations") * costs.factorization + times("solves") * costs.solve;
  piece["time"] = piece["time_min"] = work;
  piece["setup"] = 0;
  return piece;
}

// References that were made in the scene's own folder, beside other tables of it.
void copy_references(const std::string& from, const std::string& to) {
  std::error_code error;
  if (fs::equivalent(from, to, error)) return;
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    if (entry.path().filename() != "reference.json") continue;
    const fs::path copy = to / fs::relative(entry.path(), from);
    fs::create_directories(copy.parent_path());
    fs::copy_file(entry.path(), copy, fs::copy_options::overwrite_existing);
  }
}

// Why that command failed; empty if it did not.
std::string failure_of(const Command& command) {
  const ChildEnd end = run_child(command);
  const bool is_done = end.status == done || end.status == end_not_reached;
  return is_done && end.signal == 0 ? "" : end.cause();
}

// Lets the program make its tables from the results of the tasks, as if it had measured all by
// itself. `is_by_work`: whether times are counts times costs on this machine. Returns why that
// failed; empty on success. Throws CannotWrite.
std::string make_tables(const TaskFiles& files, const SceneTasks& part, bool is_by_work) {
  const Task& first = part.tasks.front();
  require_folder(part.out);
  const std::string own = files.folder() + "/" + first.folder;
  copy_references(own, part.out);
  nlohmann::json key = first.key;
  key["machine"] = is_by_work ? machine() : part.machine;
  if (is_by_work) key["machine"]["times"] = "work";  // for who draws them
  {
    const WorkCosts costs = is_by_work ? costs_for(first, own) : WorkCosts();
    Journal journal(fmt::format("{}/{}.journal", part.out, first.program), key, /*goes_on=*/false);
    for (const Task& task : part.tasks) {
      const auto contents = files.contents(task);
      if (!contents) continue;  // somebody took it away meanwhile
      for (const auto& [name, piece] : contents->pieces)
        journal.keep(name, is_by_work ? by_work(piece, costs) : piece);
    }
  }
  return failure_of(command_of(first.program, first.arguments, part.out, {"--kept"}));
}

// Runs a script of the project's Python on a folder. Empty, or why that failed.
std::string run_script(const std::string& script, const std::string& folder) {
  // Debian's own Python, which has matplotlib.
  return failure_of(
      {"/usr/bin/python3", "-B", fmt::format("{}/{}", QDDOT_EXPERIMENTS, script), folder});
}

// Draws the program's picture of the folder and, of work_precision, its page. Empty, or why that
// failed.
std::string draw(const SceneTasks& part) {
  const std::string program = part.tasks.front().program;
  std::string cause = run_script(fmt::format("{0}/{0}.py", program), part.out);
  if (cause.empty() && program == "work_precision")
    cause = run_script("report/report.py", part.out);
  return cause;
}

// Calls work(part), which returns why it failed, on all cores. Says what failed and leaves these
// parts out from then on. Returns whether nothing failed.
template <class Work>
bool on_all(std::vector<SceneTasks>& parts, const char* what, const Work& work) {
  std::vector<std::string> causes(parts.size());
  progress().begin(parts.size());
  side_by_side(parts.size(), [&](std::size_t i) {
    stop_if_interrupted();
    causes[i] = work(parts[i]);
    progress().finish(fmt::format("{}: {}", what, parts[i].out));
  });
  progress().wipe();
  std::map<std::string, std::string> failures;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!causes[i].empty()) failures[parts[i].out] = causes[i];
  }
  for (const auto& [out, cause] : failures) say(fmt::format("sweep: {}: {}", out, cause));
  std::erase_if(parts, [&](const SceneTasks& part) { return failures.contains(part.out); });
  return failures.empty();
}

// points.csv of all scenes: the rows of theirs, named by their folders.
void write_points(const std::string& path, const std::vector<SceneTasks>& parts,
                  const nlohmann::json& origin) {
  const std::vector<std::string> columns = point_columns().header();
  CsvFile csv(path, columns);
  for (const SceneTasks& part : parts) {
    const WrittenTable table(part.out + "/points.csv", columns);
    for (std::size_t row = 0; row < table.size(); ++row) {
      for (const std::string& column : columns)
        csv.field(column == "scene" ? part.tasks.front().folder : table.text(row, column));
      csv.end_row();
    }
    csv.flush_if_large();
  }
  csv.commit(origin);
}

// Writes the tables over all scenes into `folder`.
void write_overview(const std::string& folder, const std::vector<SceneTasks>& parts,
                    nlohmann::json origin) {
  std::vector<SceneResult> results;
  for (const SceneTasks& part : parts) results.push_back(read_result(part.tasks.front(), part.out));
  const auto accuracies = accuracies_of(parts.front().tasks.front());
  write_points(folder + "/points.csv", parts, origin);
  write_fastest(folder + "/fastest.csv", results, accuracies, origin);
  write_crossovers(folder + "/crossovers.csv", results, accuracies, origin);
  origin["processor"] = origin.at("cpu");
  write_whole(folder + "/sweep.json", text_of_sidecar(origin));
  print_winners(results, accuracies);
}

// Tables, pictures and overview of one kind of machine. False where something failed, which is
// said.
bool merge_machine(const TaskFiles& files, const std::string& folder, std::vector<SceneTasks> parts,
                   const MachineShare& share, const Merging& how) {
  if (parts.empty()) return true;
  // Costs are measured where nothing runs beside.
  if (how.by_work) omp_set_num_threads(1);
  bool is_good = on_all(parts, "tables", [&](const SceneTasks& part) {
    return make_tables(files, part, how.by_work);
  });
  if (parts.empty()) return false;
  const bool has_points = parts.front().tasks.front().program == "work_precision";
  if (has_points) {
    nlohmann::json origin = provenance({"sweep", "merge", folder});
    if (!how.by_work) origin.update(share.machine);
    origin["times"] = how.by_work ? "work" : "measured";
    write_overview(folder, parts, origin);
  }
  if (!how.has_pictures) return is_good;
  omp_set_num_threads(omp_get_num_procs());
  const std::string experiments = QDDOT_EXPERIMENTS;
  ::setenv("PYTHONPATH", (experiments + "/plot:" + experiments + "/report").c_str(), 1);
  ::setenv("LC_ALL", "C", 1);
  is_good &= on_all(parts, "pictures", draw);
  if (!has_points) return is_good;
  const std::string cause = run_script("sweep/sweep.py", folder);
  if (!cause.empty()) say(fmt::format("sweep: {}: {}", folder, cause));
  return is_good && cause.empty();
}

}  // namespace

int merge(const std::string& folder, const Merging& how) {
  std::vector<Task> tasks = read_tasks(folder);
  std::ranges::sort(tasks, {}, &Task::order);
  if (how.by_work && tasks.front().program != "work_precision") {
    throw InvalidInput(fmt::format("--by work is not allowed with {}; allowed is work_precision",
                                   tasks.front().program));
  }
  const TaskFiles files(folder, /*makes_folders=*/true);
  for (Task& task : tasks) task.state = files.state(task);
  // Times that are computed are measured on none of them.
  const std::vector<MachineShare> machines = machines_of(tasks, how.by_work);
  if (machines.size() > 1 && !how.per_machine) {
    throw InvalidInput(
        fmt::format("{}: its seconds were measured on unlike machines, {}, and do not compare; "
                    "allowed are --per-machine and --by work",
                    folder, in_words(machines)));
  }
  bool is_good = true;
  for (std::size_t k = 0; k < machines.size(); ++k) {
    std::string out = folder;
    if (how.per_machine) {
      out = fmt::format("{}/machines/{}", folder, k + 1);
      fmt::print("{}: {}\n", out, in_words({machines[k]}));
    }
    is_good &= merge_machine(files, out, parts_of(tasks, machines[k], out), machines[k], how);
  }
  const bool is_complete = report_missing(folder, tasks);
  return is_good && is_complete ? done : end_not_reached;
}

}  // namespace qddot::sweep
