#include <charconv>
#include <chrono>
#include <cstdlib>
#include <map>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/sweep/actions.hpp"
#include "experiments/sweep/task.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {
namespace {

// A child is given as long as a study waits for a step, and then this process has to say so.
constexpr double patience_with_child = 45;  // [s]

// One of so many shards, from 1 on; they take the tasks of a stage in turn.
struct Shard {
  int number = 1, count = 1;
};

// The time for which a task is looked at again that another process is at, and between the looks.
constexpr std::chrono::milliseconds longest_after_a_kill{2000}, between_looks{50};

// How many tasks of a shard came to each end.
struct ShardEnd {
  std::size_t done = 0;       // before or now
  std::size_t skipped = 0;    // there is no reference, as its task says
  std::size_t elsewhere = 0;  // another process is at them
  std::size_t waiting = 0;    // for a reference that is not made
  std::size_t failed = 0;
};

void say_of(const Task& task, const std::string& what) {
  say(fmt::format("sweep: {}, {} ({}): {}", task.folder, task.share, task.id, what));
}

// Measures one, or says and keeps why it failed.
bool measure_task(const TaskFiles& files, const Task& task, bool replaces) {
  const std::string journal = files.begin(task);
  const ChildEnd end =
      run_child(command_of(task.program, task.arguments, files.folder() + "/" + task.folder,
                           {"--share", task.share, "--journal", journal}));
  if (files.finish(task, journal, replaces)) return true;
  stop_if_interrupted();
  say_of(task, end.cause());
  files.fail(task, end.cause());
  return false;
}

// Reads "2/8".
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

// The tasks of the stage in the shard, or the one task of that id.
std::vector<Task> chosen(const std::string& folder, const std::vector<Task>& tasks,
                         const TaskChoice& choice) {
  const Shard shard = choice.shard.empty() ? Shard() : shard_of(choice.shard);
  std::vector<Task> mine;
  int number = 0;  // in the stage
  for (const Task& task : tasks) {
    if (task.stage != choice.stage) continue;
    const bool is_in_shard = number++ % shard.count == shard.number - 1;
    if (choice.task.empty() ? is_in_shard : task.id == choice.task) mine.push_back(task);
  }
  if (mine.empty() && !choice.task.empty()) {
    throw InvalidInput(fmt::format("--task: {} is no task of {} in {}/tasks.jsonl", choice.task,
                                   choice.stage, folder));
  }
  return mine;
}

// Measures the unfinished tasks of `mine` one after the other. `all` tells which references there
// are.
ShardEnd run_all(const TaskFiles& files, const std::vector<Task>& mine,
                 const std::vector<Task>& all, bool again) {
  const nlohmann::json here = machine();
  std::map<std::string, const Task*> references_of;  // by the folder of the scene
  for (const Task& task : all) {
    if (task.share == reference_share) references_of[task.folder] = &task;
  }
  // The state of the reference that a task needs; whole if it needs none.
  const auto reference_of = [&](const Task& task) {
    const auto own = references_of.find(task.folder);
    return own == references_of.end() || own->second->id == task.id
               ? TaskState{.kind = TaskState::whole}
               : files.state(*own->second);
  };
  ShardEnd end;
  // False if another process is at it.
  const auto take = [&](const Task& task) {
    stop_if_interrupted();
    progress().now_at(fmt::format("{}, {}", task.folder, task.share));
    const TaskState state = files.state(task);
    if (state.kind == TaskState::running) return false;
    const bool is_of_others = again && state.kind == TaskState::whole && state.machine != here;
    if (state.is_done() && !is_of_others) {
      files.tidy(task);
      ++end.done;
    } else if (const TaskState reference = reference_of(task); !reference.is_done()) {
      if (end.waiting++ == 0)
        say_of(task, "its reference is not made; sweep run --stage references makes it");
    } else if (reference.kind == TaskState::without_reference) {
      ++end.skipped;
    } else {
      ++(measure_task(files, task, is_of_others) ? end.done : end.failed);
    }
    progress().finish(fmt::format("{}, {}", task.folder, task.share));
    return true;
  };
  progress().begin(mine.size());
  std::vector<const Task*> of_others;
  for (const Task& task : mine) {
    if (!take(task)) of_others.push_back(&task);
  }
  // The child of a process that was killed holds its task a moment longer.
  const auto last_look = std::chrono::steady_clock::now() + longest_after_a_kill;
  for (const Task* task : of_others) {
    while (!take(*task)) {
      if (std::chrono::steady_clock::now() > last_look) {
        ++end.elsewhere;
        break;
      }
      std::this_thread::sleep_for(between_looks);
    }
  }
  progress().wipe();
  return end;
}

}  // namespace

int run_tasks(const std::string& folder, const TaskChoice& choice) {
  const auto tasks = read_tasks(folder);
  const auto mine = chosen(folder, tasks, choice);
  wait_for_answer(patience_with_child);
  // A core each: others measure beside it.
  for (const char* threads : {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"}) ::setenv(threads, "1", 1);
  const TaskFiles files(folder, /*makes_folders=*/true);
  const ShardEnd end = run_all(files, mine, tasks, choice.again);
  fmt::print("{} of {} tasks are done", end.done, mine.size());
  for (const auto& [count, what] :
       {std::pair(end.skipped, "are skipped, as there is no reference"),
        std::pair(end.elsewhere, "are measured elsewhere"),
        std::pair(end.waiting, "wait for a reference"), std::pair(end.failed, "failed")}) {
    if (count > 0) fmt::print(", {} {}", count, what);
  }
  fmt::print("\n");
  return end.elsewhere + end.waiting + end.failed == 0 ? done : end_not_reached;
}

}  // namespace qddot::sweep
