#include "experiments/sweep/status.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/progress_words.hpp"
#include "experiments/sweep/machines.hpp"

namespace qddot::sweep {
namespace {

constexpr std::size_t most_shown = 10;

// Expected times of tasks, from finished ones: the mean of all, times two factors for tasks of the
// same scene and of the same method.
class Durations {
 public:
  void add(const Task& task, double seconds) {
    all_.add(seconds);
    scenes_[task.folder].add(seconds);
    shares_[task.share].add(seconds);
  }
  bool is_empty() const { return all_.count == 0; }
  double sum() const { return all_.sum; }
  double expected(const Task& task) const {
    return all_.mean() * ratio(scenes_, task.folder) * ratio(shares_, task.share);
  }

 private:
  struct Mean {
    double sum = 0;
    int count = 0;

    void add(double x) {
      sum += x;
      ++count;
    }
    double mean() const { return sum / count; }
  };

  double ratio(const std::map<std::string, Mean>& means, const std::string& name) const {
    const auto own = means.find(name);
    return own == means.end() || all_.sum == 0 ? 1 : own->second.mean() / all_.mean();
  }

  Mean all_;
  std::map<std::string, Mean> scenes_, shares_;
};

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
double longest_shard(const std::vector<Task>& tasks, const std::vector<TaskState>& states,
                     const std::string& stage, std::size_t shards) {
  std::vector<double> sums(shards);
  std::size_t number = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].stage == stage) sums[number++ % shards] += states[i].seconds;
  }
  return std::ranges::max(sums);
}

// How long the stages take on so many cores, by what their tasks took: a stage ends with its
// longest shard, or task.
void print_division(const std::vector<Task>& tasks, const std::vector<TaskState>& states) {
  for (const std::size_t cores : {1, 2, 10, 100}) {
    const double first = longest_shard(tasks, states, references, cores),
                 then = longest_shard(tasks, states, points, cores);
    fmt::print("on {:>3} core{} references {}, points {}\n", cores,
               cores == 1 ? ": " : "s:", clock_words(first), clock_words(then));
  }
}

}  // namespace

int print_status(const std::string& folder) {
  const std::vector<Task> tasks = read_tasks(folder);
  const TaskFiles files(folder);
  std::map<std::string, std::map<TaskState::Kind, int>> counts;  // by stage
  std::vector<const Task*> left;
  std::set<std::string> workers, without_reference;
  Durations durations;
  std::size_t failures = 0, skipped = 0;
  std::vector<TaskState> states;
  for (const Task& task : tasks) {
    const TaskState& state = states.emplace_back(files.state(task));
    if (without_reference.contains(task.folder)) {
      ++skipped;
      continue;
    }
    if (state.kind == TaskState::without_reference) without_reference.insert(task.folder);
    ++counts[task.stage][state.kind];
    if (state.is_done()) {
      durations.add(task, state.seconds);
      continue;
    }
    left.push_back(&task);
    if (state.kind == TaskState::running) workers.insert(state.where);
    if (state.kind == TaskState::failed && ++failures <= most_shown)
      fmt::print("failed: {}, {} ({}): {}\n", task.folder, task.share, task.id, state.cause);
  }
  for (const std::string& stage : {references, points}) print_stage(stage, counts[stage]);
  if (skipped > 0) fmt::print("{} tasks are skipped, as there is no reference\n", skipped);
  if (const auto machines = machines_of(tasks, states); machines.size() > 1)
    fmt::print("measured on unlike machines: {}\n", in_words(machines));
  for (const std::string& worker : workers) fmt::print("at work: {}\n", worker);
  if (left.empty()) {
    fmt::print("all is done, in {} of one core\n", clock_words(durations.sum()));
    print_division(tasks, states);
    return done;
  }
  if (durations.is_empty()) {
    fmt::print("how long the rest takes is not known yet\n");
    return done;
  }
  double seconds = 0;
  for (const Task* task : left) seconds += durations.expected(*task);
  fmt::print("the rest takes some {} of one core", clock_words(seconds));
  if (workers.size() > 1) {
    fmt::print(", {} of the {} at work", clock_words(seconds / static_cast<double>(workers.size())),
               workers.size());
  }
  fmt::print("\n");
  return done;
}

}  // namespace qddot::sweep
