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
//  1. plan asks the study's program which shares of each scene can be measured independently. They
//     are the reference and each method; or each stiffness ratio of crossover, or each case of
//     advice. A task's name is a hash of all that decides its results: scene, end time, method,
//     options, code and flags.
//  2. run measures the tasks of a shard. Each task has a process of the program, and a file that
//     appears whole or not at all. Tasks that are done are skipped, so the same command goes on
//     after a process was killed. Two processes that measure the same task do no harm.
//  3. merge gives each scene's files to the program, which makes its tables as if it had measured
//     them by itself. Times of unlike machines are never compared.
#include <cstdlib>
#include <map>
#include <sys/wait.h>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/sweep/actions.hpp"
#include "experiments/sweep/status.hpp"
#include "experiments/sweep/task.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {
namespace {

// The options that each action takes.
const std::map<std::string, std::vector<std::string>>& actions() {
  static const std::map<std::string, std::vector<std::string>> all = {
      {"plan", {"--out"}},
      {"run", {"--stage", "--shard", "--task", "--again"}},
      {"merge", {"--per-machine", "--by", "--no-pictures"}},
      {"submit", {"--slurm", "--parallel", "--shards", "--go"}},
      {"status", {}}};
  return all;
}

void require_action(const Program& program, const std::string& action, const std::string& where) {
  if (!actions().contains(action)) {
    throw InvalidInput(
        fmt::format("{}; allowed are plan, run, merge, submit and status",
                    action.empty() ? "the action is missing" : action + " is no action of sweep"));
  }
  for (const auto& [other, options] : actions()) {
    for (const std::string& option : options) {
      if (other == action || !program.has(option)) continue;
      throw InvalidInput(
          fmt::format("{} is for sweep {}, not for sweep {}", option, other, action));
    }
  }
  require_given(where, action == "plan" ? "STUDY.toml" : "the sweep's folder",
                action == "plan" ? "the study's file" : "what sweep plan --out made");
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
  using namespace qddot;
  using namespace qddot::sweep;
  const Words words = parted(argc, argv);
  std::vector<char*> own;
  for (const std::string& word : words.own) own.push_back(const_cast<char*>(word.c_str()));
  Program p("sweep", "Divides a study of many scenes among processes and merges the results.");
  auto action = p.word("action", "plan, run, merge, submit or status");
  auto where = p.word("where", "plan: the study's file; others: the sweep's folder");
  auto out = p.word("--out", "plan: the sweep's folder").last();
  auto stage = p.word("--stage", "run: references or points").last();
  auto shard = p.word("--shard", "run: I/N, one of N shards of the stage (default: 1/1)").last();
  auto task = p.word("--task", "run: the id of a single task").last();
  auto again =
      p.flag("--again", "run: measure again tasks that another kind of machine has measured");
  auto per_machine = p.flag("--per-machine", "merge: a folder for each kind of machine");
  auto by = p.word("--by", "merge: work, to replace times by counts times costs").last();
  auto has_no_pictures = p.flag("--no-pictures", "merge: make tables, but no pictures");
  auto slurm =
      p.flag("--slurm", "submit: print three lines of sbatch; all words after it go to sbatch");
  auto parallel = p.flag(
      "--parallel", "submit: print three lines of GNU parallel; all words after it go to parallel");
  auto shards =
      p.whole("--shards", 100, "submit: the largest number of jobs for the points").last();
  auto go_on = p.flag("--go", "submit: run these lines");
  return p.run(static_cast<int>(own.size()), own.data(), [&] {
    require_action(p, action, where);
    if (*action == "plan") {
      require_given(out, "--out", "the sweep's folder");
      return plan(where, out);
    }
    if (*action == "run") {
      if (*stage != references && *stage != points) {
        throw InvalidInput(fmt::format("--stage {}; allowed are references and points",
                                       stage->empty() ? "is missing" : *stage + " is not one"));
      }
      if (shard.is_given() && task.is_given())
        throw InvalidInput("--task is not allowed with --shard; allowed is either");
      return run_tasks(where, {*stage, *shard, *task, again});
    }
    if (*action == "merge") {
      if (by.is_given() && *by != "work")
        throw InvalidInput(fmt::format("--by {} is not allowed; allowed is work", *by));
      if (by.is_given() && per_machine)
        throw InvalidInput("--by is not allowed with --per-machine; allowed is either");
      return merge(
          where,
          {.per_machine = per_machine, .by_work = by.is_given(), .has_pictures = !has_no_pictures});
    }
    if (*action == "status") return print_status(where);
    if (slurm == parallel)
      throw InvalidInput("submit takes --slurm or --parallel; allowed is exactly one of the two");
    require_within(shards, 1, 100000, "--shards");
    const Submission how{.shards = static_cast<std::size_t>(*shards), .options = words.passed_on};
    const std::string lines = slurm ? slurm_lines(where, how) : parallel_lines(where, how);
    fmt::print("{}", lines);
    if (!go_on) return static_cast<int>(done);
    std::fflush(stdout);
    const int status = std::system(lines.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : failed;
  });
}
