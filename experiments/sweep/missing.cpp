#include "experiments/sweep/missing.hpp"

#include <map>

#include <fmt/format.h>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/shares.hpp"

namespace qddot::sweep {
namespace {

constexpr std::size_t most_shown = 10;

struct Missing {
  std::string state, cause, command;
};

// The references that points wait for, by the folder of their scene.
std::map<std::string, const TaskState*> absent_references(const std::vector<Task>& tasks,
                                                          const std::vector<TaskState>& states) {
  std::map<std::string, const TaskState*> absent;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].share == reference_share && states[i].kind != TaskState::whole)
      absent[tasks[i].folder] = &states[i];
  }
  return absent;
}

Missing missing(const std::string& folder, const Task& task, const TaskState& state,
                const TaskState* reference) {
  const std::string command =
      shell_line({.program = program_path("sweep"),
                  .arguments = {"run", folder, "--stage", task.stage, "--task", task.id}});
  if (task.share != reference_share && reference && reference->kind == TaskState::without_reference)
    return {"skipped", "no reference: " + reference->cause, ""};
  if (task.share != reference_share && reference)
    return {"waiting", "its reference is not made", command};
  switch (state.kind) {
    case TaskState::without_reference:
      return {"no reference", state.cause, ""};
    case TaskState::running:
      return {"running", "at work on " + state.where, ""};
    case TaskState::begun:
      return {"begun", state.cause, command};
    case TaskState::failed:
      return {"failed", state.cause, command};
    default:
      return {"missing", "it was not begun", command};
  }
}

}  // namespace

bool report_missing(const std::string& folder, const std::vector<Task>& tasks,
                    const std::vector<TaskState>& states) {
  CsvFile csv(folder + "/missing.csv", {"scene", "share", "id", "state", "cause", "command"});
  const auto absent = absent_references(tasks, states);
  std::size_t count = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const auto reference = absent.find(tasks[i].folder);
    if (states[i].kind == TaskState::whole) continue;
    const Missing what = missing(folder, tasks[i], states[i],
                                 reference == absent.end() ? nullptr : reference->second);
    csv.row(tasks[i].folder, tasks[i].share, tasks[i].id, what.state, what.cause, what.command);
    if (++count > most_shown) continue;
    fmt::print("{}, {}: {}: {}{}{}\n", tasks[i].folder, tasks[i].share, what.state, what.cause,
               what.command.empty() ? "" : "; to measure it: ", what.command);
  }
  if (count > most_shown) fmt::print("and {} more in {}/missing.csv\n", count - most_shown, folder);
  csv.commit(provenance({"sweep", "merge", folder}));
  return count == 0;
}

}  // namespace qddot::sweep
