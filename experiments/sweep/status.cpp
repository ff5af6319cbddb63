#include "experiments/sweep/status.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/command/program.hpp"
#include "experiments/sweep/machines.hpp"
#include "qddot/measure/motion/duration.hpp"

namespace qddot::sweep {

using namespace command;
namespace {

constexpr std::size_t most_shown = 10;

// The mean of what tasks took, by their share, and of all.
class Durations {
 public:
  void add(const std::string& share, double seconds) {
    for (const std::string& of : {share, std::string()}) {
      sums_[of] += seconds;
      ++counts_[of];
    }
  }
  bool is_empty() const { return counts_.empty(); }
  double mean(const std::string& share) const {
    const std::string of = counts_.contains(share) ? share : "";
    return sums_.at(of) / counts_.at(of);
  }
  double sum() const { return is_empty() ? 0 : sums_.at(""); }

 private:
  std::map<std::string, double> sums_;
  std::map<std::string, int> counts_;
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
      durations.add(task.share, state.seconds);
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
    fmt::print("all is done, in {} of one core\n", measure::duration_in_words(durations.sum()));
    return done;
  }
  if (durations.is_empty()) {
    fmt::print("how long the rest takes is not known yet\n");
    return done;
  }
  double seconds = 0;
  for (const Task* task : left) seconds += durations.mean(task->share);
  fmt::print("the rest takes some {} of one core", measure::duration_in_words(seconds));
  if (workers.size() > 1) {
    fmt::print(", {} of the {} at work",
               measure::duration_in_words(seconds / static_cast<double>(workers.size())),
               workers.size());
  }
  fmt::print("\n");
  return done;
}

}  // namespace qddot::sweep
