#include "experiments/sweep/run.hpp"

#include <charconv>
#include <map>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/shares.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {
namespace {

void say_of(const Task& task, const std::string& what) {
  say(fmt::format("sweep: {}, {} ({}): {}", task.folder, task.share, task.id, what));
}

// Measures one, or says and keeps why it failed.
bool measure_task(const TaskFiles& files, const Task& task, bool replaces) {
  const std::string journal = files.begin(task);
  const ChildEnd end = run_child(command_of(task, files.folder(), journal));
  if (files.finish(task, journal, replaces)) return true;
  measure::stop_if_interrupted();
  say_of(task, end.cause());
  files.fail(task, end.cause());
  return false;
}

// The references that tasks measure against, by the folder of the scene.
class References {
 public:
  References(const TaskFiles& files, const std::vector<Task>& all) : files_(files) {
    for (const Task& task : all) {
      if (task.share == reference_share) tasks_[task.folder] = &task;
    }
  }
  // Its state; whole where none is needed.
  const TaskState& of(const Task& task) {
    const auto own = tasks_.find(task.folder);
    TaskState& state = states_[task.folder];
    if (own == tasks_.end() || task.share == reference_share) return needs_none_;
    if (!state.is_done()) state = files_.state(*own->second);
    return state;
  }

 private:
  const TaskFiles& files_;
  std::map<std::string, const Task*> tasks_;
  std::map<std::string, TaskState> states_;
  TaskState needs_none_{.kind = TaskState::whole};
};

}  // namespace

Shard shard_of(const std::string& text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, shard.number);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == '/') {
    const auto second = std::from_chars(first.ptr + 1, end, shard.count);
    if (second.ec == std::errc() && second.ptr == end && shard.number >= 1 &&
        shard.number <= shard.count)
      return shard;
  }
  throw InvalidInput(
      fmt::format("--shard {} is not allowed; it is I/N, one of N shards, from 1/N to N/N", text));
}

std::vector<Task> chosen(const std::vector<Task>& tasks, const std::string& stage,
                         const Shard& shard) {
  std::vector<Task> mine;
  int number = 0;  // in the stage
  for (const Task& task : tasks) {
    if (task.stage == stage && number++ % shard.count == shard.number - 1) mine.push_back(task);
  }
  return mine;
}

ShardEnd run_tasks(const TaskFiles& files, const std::vector<Task>& mine,
                   const std::vector<Task>& all, bool again) {
  const nlohmann::json here = machine();
  References needed(files, all);
  ShardEnd end;
  progress().begin(mine.size());
  for (const Task& task : mine) {
    measure::stop_if_interrupted();
    progress().now_at(fmt::format("{}, {}", task.folder, task.share));
    const TaskState state = files.state(task);
    const bool is_of_others = again && state.kind == TaskState::whole && state.machine != here;
    if (state.is_done() && !is_of_others) {
      files.tidy(task);
      ++end.done;
    } else if (state.kind == TaskState::running) {
      ++end.elsewhere;
    } else if (const TaskState& reference = needed.of(task); !reference.is_done()) {
      if (end.waiting++ == 0)
        say_of(task, "its reference is not made; sweep run --stage references makes it");
    } else if (reference.kind == TaskState::without_reference) {
      ++end.skipped;
    } else {
      ++(measure_task(files, task, is_of_others) ? end.done : end.failed);
    }
    progress().finish(fmt::format("{}, {}", task.folder, task.share));
  }
  progress().wipe();
  return end;
}

}  // namespace qddot::sweep
