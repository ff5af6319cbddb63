// Studies of many scenes, divided among processes, machines or a cluster, and merged again.
//
//   sweep plan STUDY.toml --out S              # writes S/tasks.jsonl (format: study_file.hpp)
//   sweep run S --stage references             # measures all references here
//   sweep run S --stage points --shard 3/100   # a hundredth of the points
//   sweep status S
//   sweep merge S                              # tables, charts, reports, fastest methods
//   sweep submit S --slurm --partition=short --go       # all of that by Slurm
//   sweep submit S --parallel --sshlogin a,b --go       # or by GNU parallel
//
//  1. plan asks the study's program which shares of each scene can be measured independently: the
//     reference, then a task for each method (or for a stiffness ratio of crossover, or a case of
//     advice). A task's name is a hash of all that decides its results: scene, end time, method,
//     options, code and flags.
//  2. run measures the tasks of a shard. Each task has a process of the program, and a file that
//     appears whole or not at all. Tasks that are done are skipped: the same command goes on after
//     a process was killed, and two processes that measure the same task do no harm.
//  3. merge gives each scene's files to the program, which makes its tables as if it had measured
//     them by itself. Times of unlike machines are never compared.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/command_line.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/overwriting.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/sweep/merge.hpp"
#include "experiments/sweep/plan.hpp"
#include "experiments/sweep/run.hpp"
#include "experiments/sweep/status.hpp"
#include "experiments/sweep/submit.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {
namespace {

// A child is given as long as a study waits for a step, and then this process has to say so.
constexpr double patience = 45;  // [s]
constexpr int most_shards = 100000;

struct Arguments {
  std::string action, where;  // STUDY.toml of plan, the sweep's folder of all others
  std::string out, stage, shard, task, by;
  bool again = false, per_machine = false, has_no_pictures = false, slurm = false, parallel = false,
       go = false;
  int shards = 100;
};

// The options that each action takes.
struct Action {
  std::string_view name;
  std::vector<std::string> options;
};
const std::vector<Action>& actions() {
  static const std::vector<Action> all = {{"plan", {"--out"}},
                                          {"run", {"--stage", "--shard", "--task", "--again"}},
                                          {"merge", {"--per-machine", "--by", "--no-pictures"}},
                                          {"submit", {"--slurm", "--parallel", "--shards", "--go"}},
                                          {"status", {}}};
  return all;
}

void declare(CommandLine& line, Arguments& a) {
  line.add_option("action", a.action, "plan, run, merge, submit or status");
  line.add_option("where", a.where, "plan: the study's file; others: the sweep's folder");
  line.add_option("--out", a.out, "plan: the sweep's folder").take_last();
  line.add_option("--stage", a.stage, "run: references or points").take_last();
  line.add_option("--shard", a.shard, "run: I/N, one of N shards of the stage (default: 1/1)")
      .take_last();
  line.add_option("--task", a.task, "run: the id of a single task").take_last();
  line.add_flag("--again", a.again,
                "run: measure again tasks that another kind of machine has measured");
  line.add_flag("--per-machine", a.per_machine, "merge: a folder for each kind of machine");
  line.add_option("--by", a.by, "merge: work, to replace times by counts times costs").take_last();
  line.add_flag("--no-pictures", a.has_no_pictures, "merge: make tables, but no pictures");
  line.add_flag("--slurm", a.slurm,
                "submit: print three lines of sbatch; all words after it go to sbatch");
  line.add_flag("--parallel", a.parallel,
                "submit: print three lines of GNU parallel; all words after it go to parallel");
  line.add_option("--shards", a.shards, "submit: the largest number of jobs for the points")
      .take_last()
      .capture_default_str();
  line.add_flag("--go", a.go, "submit: run these lines");
}

void require_action(const CommandLine& line, const Arguments& a) {
  const auto own = std::ranges::find(actions(), a.action, &Action::name);
  if (own == actions().end()) {
    throw InvalidInput(fmt::format(
        "{}; allowed are plan, run, merge, submit and status",
        a.action.empty() ? "the action is missing" : a.action + " is no action of sweep"));
  }
  for (const Action& other : actions()) {
    for (const std::string& option : other.options) {
      if (&other == &*own || !line.has(option)) continue;
      throw InvalidInput(
          fmt::format("{} is for sweep {}, not for sweep {}", option, other.name, own->name));
    }
  }
  require_given(a.where, a.action == "plan" ? "STUDY.toml" : "the sweep's folder",
                a.action == "plan" ? "the study's file" : "what sweep plan --out made");
}

int plan_study(const Arguments& a) {
  require_given(a.out, "--out", "the sweep's folder");
  protect_input(a.where);
  const StudyFile study = read_study(a.where);
  const std::string folder = std::filesystem::absolute(a.out).lexically_normal().string();
  const std::string scenes = folder + "/scenes";
  const bool is_new = !std::filesystem::exists(folder),
             had_scenes = std::filesystem::exists(scenes);
  std::vector<Task> tasks;
  try {
    tasks = plan(study, a.where, folder);
    require_folder(folder);
  } catch (...) {  // nothing half planned is left behind
    if (!had_scenes) std::filesystem::remove_all(scenes);
    if (is_new) std::filesystem::remove_all(folder);
    throw;
  }
  write_tasks(folder, tasks);
  const TaskFiles files(folder, /*makes_folders=*/true);
  const auto kept = std::ranges::count_if(
      tasks, [&](const Task& task) { return files.contents(task).has_value(); });
  const auto first = std::ranges::count(tasks, references, &Task::stage);
  fmt::print("{}: {} scenes, {} references, {} tasks of points", folder, study.scenes.size(), first,
             std::ssize(tasks) - first);
  if (kept > 0) fmt::print("; {} of these are measured already", kept);
  fmt::print("\n");
  return done;
}

int run_shard(const CommandLine& line, const Arguments& a) {
  if (a.stage != references && a.stage != points) {
    throw InvalidInput(fmt::format("--stage {}; allowed are references and points",
                                   a.stage.empty() ? "is missing" : a.stage + " is not one"));
  }
  if (line.has("--shard") && line.has("--task"))
    throw InvalidInput("--task is not allowed with --shard; allowed is either");
  const Shard shard = line.has("--shard") ? shard_of(a.shard) : Shard();
  const auto tasks = read_tasks(a.where);
  auto mine = chosen(tasks, a.stage, shard);
  if (line.has("--task")) {
    std::erase_if(mine, [&](const Task& task) { return task.id != a.task; });
    if (mine.empty()) {
      throw InvalidInput(
          fmt::format("--task: {} is no task of {} in {}/tasks.jsonl", a.task, a.stage, a.where));
    }
  }
  wait_for_answer(patience);
  const TaskFiles files(a.where, /*makes_folders=*/true);
  const ShardEnd end = run_tasks(files, mine, tasks, a.again);
  fmt::print("{} of {} tasks are done", end.done, mine.size());
  for (const auto& [count, what] :
       {std::pair(end.skipped, "are skipped, as there is no reference"),
        std::pair(end.elsewhere, "are measured elsewhere"),
        std::pair(end.waiting, "wait for a reference"), std::pair(end.failed, "failed")}) {
    if (count > 0) fmt::print(", {} {}", count, what);
  }
  fmt::print("\n");
  return end.is_complete() ? done : end_not_reached;
}

int merge_all(const CommandLine& line, const Arguments& a) {
  if (line.has("--by") && a.by != "work")
    throw InvalidInput(fmt::format("--by {} is not allowed; allowed is work", a.by));
  if (line.has("--by") && a.per_machine)
    throw InvalidInput("--by is not allowed with --per-machine; allowed is either");
  return merge(a.where, {.per_machine = a.per_machine,
                         .by_work = line.has("--by"),
                         .has_pictures = !a.has_no_pictures});
}

int submit(const Arguments& a, const std::vector<std::string>& passed_on) {
  if (a.slurm == a.parallel)
    throw InvalidInput("submit takes --slurm or --parallel; allowed is exactly one of the two");
  require_within(a.shards, 1, most_shards, "--shards");
  const Submission how{.shards = static_cast<std::size_t>(a.shards), .options = passed_on};
  const std::string lines = a.slurm ? slurm_lines(a.where, how) : parallel_lines(a.where, how);
  fmt::print("{}", lines);
  if (!a.go) return done;
  std::fflush(stdout);
  return go(lines);
}

int sweep(const CommandLine& line, const Arguments& a, const std::vector<std::string>& passed_on) {
  require_action(line, a);
  if (a.action == "plan") return plan_study(a);
  if (a.action == "run") return run_shard(line, a);
  if (a.action == "merge") return merge_all(line, a);
  if (a.action == "submit") return submit(a, passed_on);
  return print_status(a.where);
}

// The words after --slurm or --parallel that are not sweep's own go to those as they are.
struct Words {
  std::vector<std::string> own, passed_on;
};
Words parted(int argc, char** argv) {
  Words words;
  bool is_passed_on = false;
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    const bool is_of_submit = argc > 1 && std::string_view(argv[1]) == "submit";
    const bool has_value = word == "--shards" || word == "--progress" || word == "--time-limit";
    const bool is_own = has_value || word == "--go" || word.starts_with("--shards=") ||
                        word.starts_with("--progress=") || word.starts_with("--time-limit=") ||
                        word == "--help" || word == "--force";
    (is_passed_on && !is_own ? words.passed_on : words.own).push_back(word);
    if (is_passed_on && has_value && i + 1 < argc) words.own.emplace_back(argv[++i]);
    is_passed_on |= is_of_submit && (word == "--slurm" || word == "--parallel");
  }
  return words;
}

}  // namespace
}  // namespace qddot::sweep

int main(int argc, char** argv) {
  using namespace qddot::sweep;
  const Words words = parted(argc, argv);
  std::vector<char*> own;
  for (const std::string& word : words.own) own.push_back(const_cast<char*>(word.c_str()));
  return qddot::kit::enter<Arguments>(
      {.name = "sweep",
       .summary = "Divides a study of many scenes among processes and merges the results."},
      declare,
      [&](const auto& line, const Arguments& a, const auto&) {
        return sweep(line, a, words.passed_on);
      },
      static_cast<int>(own.size()), own.data());
}
