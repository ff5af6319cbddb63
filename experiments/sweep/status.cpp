#include "experiments/sweep/status.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"

namespace qddot::sweep {
namespace {

constexpr std::size_t most_shown = 10;

void print_stage(const std::string& stage, const std::map<TaskState::Kind, int>& counts) {
  constexpr std::pair<TaskState::Kind, const char*> words[] = {
      {TaskState::whole, "done"},      {TaskState::without_reference, "without a reference"},
      {TaskState::running, "running"}, {TaskState::begun, "begun and ended"},
      {TaskState::failed, "failed"},   {TaskState::missing, "not begun"}};
  int all = 0;
  std::vector<std::string> parts;
  for (const auto& [kind, word] : words) {
    const auto own = counts.find(kind);
    if (own == counts.end()) continue;
    all += own->second;
    parts.push_back(fmt::format("{} {}", own->second, word));
  }
  if (all > 0) fmt::print("{:<11} {} tasks: {}\n", stage, all, fmt::join(parts, ", "));
}

// The longest of so many shards of a stage [s].
double longest_shard(const std::vector<Task>& tasks, const std::string& stage, std::size_t shards) {
  std::vector<double> sums(shards);
  std::size_t number = 0;
  for (const Task& task : tasks) {
    if (task.stage == stage) sums[number++ % shards] += task.state.seconds;
  }
  return std::ranges::max(sums);
}

// How long the stages take on so many cores, by what their tasks took: a stage ends with its
// longest shard, or task.
void print_division(const std::vector<Task>& tasks) {
  for (const std::size_t cores : {1, 2, 10, 100}) {
    const double first = longest_shard(tasks, references, cores),
                 then = longest_shard(tasks, points, cores);
    fmt::print("on {:>3} core{} references {}, points {}\n", cores,
               cores == 1 ? ": " : "s:", clock_words(first), clock_words(then));
  }
}

struct Missing {
  std::string state, cause, command;
};

// `reference`: the state of the one that the task waits for; nullptr if it waits for none.
Missing missing(const std::string& folder, const Task& task, const TaskState* reference) {
  const std::string command =
      shell_line({program_path("sweep"), "run", folder, "--stage", task.stage, "--task", task.id});
  if (reference && reference->kind == TaskState::without_reference)
    return {"skipped", "no reference: " + reference->cause, ""};
  if (reference) return {"waiting", "its reference is not made", command};
  switch (task.state.kind) {
    case TaskState::without_reference:
      return {"no reference", task.state.cause, ""};
    case TaskState::running:
      return {"running", "at work on " + task.state.where, ""};
    case TaskState::begun:
      return {"begun", task.state.cause, command};
    case TaskState::failed:
      return {"failed", task.state.cause, command};
    default:
      return {"missing", "it was not begun", command};
  }
}

}  // namespace

std::vector<MachineShare> machines_of(const std::vector<Task>& tasks, bool as_one) {
  std::vector<MachineShare> machines;
  for (const Task& task : tasks) {
    if (task.stage != points || task.state.kind != TaskState::whole) continue;
    auto own = as_one ? machines.begin()
                      : std::ranges::find(machines, task.state.machine, &MachineShare::machine);
    if (own == machines.end()) own = machines.insert(own, {.machine = task.state.machine});
    own->tasks.push_back(&task);
  }
  return machines;
}

std::string in_words(const std::vector<MachineShare>& machines) {
  std::vector<std::string> all;
  for (const MachineShare& one : machines) {
    std::vector<std::string> words = {one.machine.value("cpu", "an unknown processor")};
    for (const auto& entry : one.machine.items()) {
      const bool differs = std::ranges::any_of(machines, [&](const MachineShare& other) {
        return other.machine.value(entry.key(), nlohmann::json()) != entry.value();
      });
      if (differs && entry.key() != "cpu")
        words.push_back(fmt::format("{} {}", entry.key(), entry.value().dump()));
    }
    all.push_back(fmt::format("{} ({} tasks)", fmt::join(words, ", "), one.tasks.size()));
  }
  return fmt::format("{}", fmt::join(all, " and "));
}

int print_status(const std::string& folder) {
  std::vector<Task> tasks = read_tasks(folder);
  const TaskFiles files(folder);
  std::map<std::string, std::map<TaskState::Kind, int>> counts;  // by stage
  std::map<std::string, std::vector<double>> seconds;            // of whole tasks, likewise
  std::map<std::string, std::size_t> left;
  std::set<std::string> workers, without_reference;
  std::size_t failures = 0, skipped = 0;
  for (Task& task : tasks) {
    const TaskState& state = task.state = files.state(task);
    if (without_reference.contains(task.folder)) {
      ++skipped;
      continue;
    }
    if (state.kind == TaskState::without_reference) without_reference.insert(task.folder);
    ++counts[task.stage][state.kind];
    if (state.is_done()) {
      seconds[task.stage].push_back(state.seconds);
      continue;
    }
    ++left[task.stage];
    if (state.kind == TaskState::running) workers.insert(state.where);
    if (state.kind == TaskState::failed && ++failures <= most_shown)
      fmt::print("failed: {}, {} ({}): {}\n", task.folder, task.share, task.id, state.cause);
  }
  for (const std::string& stage : {references, points}) print_stage(stage, counts[stage]);
  if (skipped > 0) fmt::print("{} tasks are skipped, as there is no reference\n", skipped);
  if (const auto machines = machines_of(tasks); machines.size() > 1)
    fmt::print("measured on unlike machines: {}\n", in_words(machines));
  for (const std::string& worker : workers) fmt::print("at work: {}\n", worker);
  double spent = 0, rest = 0;
  for (const auto& [stage, own] : seconds) spent += std::accumulate(own.begin(), own.end(), 0.0);
  if (left.empty()) {
    fmt::print("all is done, in {} of one core\n", clock_words(spent));
    print_division(tasks);
    return done;
  }
  // Tasks are in a random order, so that the mean of those that are done is that of the rest.
  for (const auto& [stage, count] : left) {
    const std::vector<double>& own = seconds[stage];
    if (own.empty()) {
      fmt::print("how long the rest takes is not known yet\n");
      return done;
    }
    rest += static_cast<double>(count) * std::accumulate(own.begin(), own.end(), 0.0) /
            static_cast<double>(own.size());
  }
  fmt::print("the rest takes some {} of one core", clock_words(rest));
  if (workers.size() > 1) {
    fmt::print(", {} of the {} at work", clock_words(rest / static_cast<double>(workers.size())),
               workers.size());
  }
  fmt::print("\n");
  return done;
}

bool report_missing(const std::string& folder, const std::vector<Task>& tasks) {
  CsvFile csv(folder + "/missing.csv", {"scene", "share", "id", "state", "cause", "command"});
  std::map<std::string, const TaskState*> absent;  // references, by the folder of their scene
  for (const Task& task : tasks) {
    if (task.share == reference_share && task.state.kind != TaskState::whole)
      absent[task.folder] = &task.state;
  }
  std::size_t count = 0;
  for (const Task& task : tasks) {
    if (task.state.kind == TaskState::whole) continue;
    const auto reference = absent.find(task.folder);
    const bool waits = task.share != reference_share && reference != absent.end();
    const Missing what = missing(folder, task, waits ? reference->second : nullptr);
    csv.row(task.folder, task.share, task.id, what.state, what.cause, what.command);
    if (++count > most_shown) continue;
    fmt::print("{}, {}: {}: {}{}{}\n", task.folder, task.share, what.state, what.cause,
               what.command.empty() ? "" : "; to measure it: ", what.command);
  }
  if (count > most_shown) fmt::print("and {} more in {}/missing.csv\n", count - most_shown, folder);
  csv.commit(provenance({"sweep", "merge", folder}));
  return count == 0;
}

}  // namespace qddot::sweep
