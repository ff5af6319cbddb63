#include "experiments/sweep/merge.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <omp.h>

#include <fmt/format.h>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/points.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/sweep/machines.hpp"
#include "experiments/sweep/results.hpp"
#include "experiments/sweep/scene_folder.hpp"
#include "experiments/sweep/status.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {
namespace {

// The scenes' parts in the order of the plan, made of the complete ones among these tasks.
std::vector<SceneTasks> parts_of(const std::vector<Task>& tasks,
                                 const std::vector<TaskState>& states, const MachineShare& share,
                                 const std::string& folder) {
  std::vector<SceneTasks> parts;
  std::map<std::string, std::size_t> numbers;
  const auto add = [&](const Task& task) {
    const auto [own, is_new] = numbers.try_emplace(task.folder, parts.size());
    if (is_new) parts.push_back({.out = folder + "/" + task.folder, .machine = share.machine});
    parts[own->second].tasks.push_back(task);
  };
  for (const std::size_t i : share.tasks) add(tasks[i]);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].stage == references && states[i].kind == TaskState::whole &&
        numbers.contains(tasks[i].folder))
      add(tasks[i]);
  }
  return parts;
}

// Calls work(part) on all cores. Returns the causes of failures by the part's folder.
template <class Work>
std::map<std::string, std::string> on_all(const std::vector<SceneTasks>& parts, const char* what,
                                          const Work& work) {
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
  return failures;
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

nlohmann::json origin_of(const std::string& folder, const MachineShare& share, bool by_work) {
  nlohmann::json origin = provenance({"sweep", "merge", folder});
  if (!by_work) origin.update(share.machine);
  origin["times"] = by_work ? "work" : "measured";
  return origin;
}

// Writes the tables over all scenes into `folder`.
void write_overview(const std::string& folder, const std::vector<SceneTasks>& parts,
                    const nlohmann::json& origin) {
  std::vector<SceneResult> results;
  for (const SceneTasks& part : parts) results.push_back(read_result(part.tasks.front(), part.out));
  const auto accuracies = accuracies_of(parts.front().tasks.front());
  write_points(folder + "/points.csv", parts, origin);
  write_fastest(folder + "/fastest.csv", results, accuracies, origin);
  write_crossovers(folder + "/crossovers.csv", results, accuracies, origin);
  WholeFile about(folder + "/sweep.json");
  nlohmann::json words = origin;
  words["processor"] = origin.at("cpu");
  about.write(text_of_sidecar(words));
  about.complete();
  about.commit();
  print_winners(results, accuracies);
}

// Tables, pictures and overview of one kind of machine. False where something failed, which is
// said.
bool merge_machine(const TaskFiles& files, const std::string& folder, std::vector<SceneTasks> parts,
                   const MachineShare& share, const Merging& how) {
  if (parts.empty()) return true;
  const auto say = [](const std::map<std::string, std::string>& failures) {
    for (const auto& [out, cause] : failures) fmt::print(stderr, "sweep: {}: {}\n", out, cause);
    return failures.empty();
  };
  // Costs are measured where nothing runs beside.
  if (how.by_work) omp_set_num_threads(1);
  const auto failures = on_all(parts, "tables", [&](const SceneTasks& part) {
    return make_tables(files, part, how.by_work);
  });
  bool is_good = say(failures);
  std::erase_if(parts, [&](const SceneTasks& part) { return failures.contains(part.out); });
  if (parts.empty()) return false;
  const bool has_points = parts.front().tasks.front().program == "work_precision";
  if (has_points) write_overview(folder, parts, origin_of(folder, share, how.by_work));
  if (!how.has_pictures) return is_good;
  omp_set_num_threads(omp_get_num_procs());
  set_environment_of_scripts();
  is_good = say(on_all(parts, "pictures", draw)) && is_good;
  if (!has_points) return is_good;
  const std::string cause = run_script("sweep/sweep.py", folder);
  return say(cause.empty() ? std::map<std::string, std::string>()
                           : std::map<std::string, std::string>{{folder, cause}}) &&
         is_good;
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
  std::vector<TaskState> states;
  for (const Task& task : tasks) states.push_back(files.state(task));
  std::vector<MachineShare> machines = machines_of(tasks, states);
  if (machines.size() > 1 && !how.per_machine && !how.by_work) {
    throw InvalidInput(
        fmt::format("{}: its seconds were measured on unlike machines, {}, and do not compare; "
                    "allowed are --per-machine and --by work",
                    folder, in_words(machines)));
  }
  if (how.by_work && machines.size() > 1) {  // times are measured on none of them
    for (std::size_t k = 1; k < machines.size(); ++k)
      machines[0].tasks.insert(machines[0].tasks.end(), machines[k].tasks.begin(),
                               machines[k].tasks.end());
    machines.resize(1);
    std::ranges::sort(machines[0].tasks);
  }
  bool is_good = true;
  for (std::size_t k = 0; k < machines.size(); ++k) {
    std::string out = folder;
    if (how.per_machine) {
      out = fmt::format("{}/machines/{}", folder, k + 1);
      fmt::print("{}: {}\n", out, in_words({machines[k]}));
    }
    is_good =
        merge_machine(files, out, parts_of(tasks, states, machines[k], out), machines[k], how) &&
        is_good;
  }
  const bool is_complete = report_missing(folder, tasks, states);
  return is_good && is_complete ? done : end_not_reached;
}

}  // namespace qddot::sweep
