#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/sweep/actions.hpp"
#include "experiments/sweep/task.hpp"

namespace qddot::sweep {
namespace {

// How many shards each stage is divided into: no more than it has tasks.
struct Division {
  Division(const std::string& folder, std::size_t most) {
    for (const Task& task : read_tasks(folder)) {
      std::size_t& shards = task.stage == sweep::references ? references : points;
      shards = std::min(shards + 1, most);
    }
  }
  std::size_t references = 0, points = 0;
};

std::string absolute(const std::string& folder) {
  return std::filesystem::absolute(folder).lexically_normal().string();
}

std::string joined(const std::vector<std::string>& options) {
  std::string text;
  for (const std::string& word : options) text += " " + shell_word(word);
  return text;
}

Command run_of(const std::string& folder, const std::string& stage) {
  return {program_path("sweep"), "run", absolute(folder), "--stage", stage, "--progress", "plain"};
}

std::string merge_of(const std::string& folder) {
  return shell_line({program_path("sweep"), "merge", absolute(folder), "--progress", "plain"});
}

// One sbatch, whose job's number goes into a variable of its name.
std::string sbatch(const std::string& folder, const std::string& name, const std::string& own,
                   const Submission& how, const std::string& script) {
  const std::string log =
      absolute(folder) + "/log/" + name + (own.find("--array") == own.npos ? "" : "-%a") + ".txt";
  return fmt::format(
      "{0}=$(sbatch --parsable --job-name=qddot-{0} --ntasks=1 --cpus-per-task=1 "
      "--threads-per-core=1 --requeue --open-mode=append --output={1}{2}{3} --wrap={4}) && echo "
      "\"{0}: job ${0}\"\n",
      name, shell_word(log), own, joined(how.options), shell_word(script));
}

std::string array_script(const std::string& folder, const std::string& stage, std::size_t count) {
  return fmt::format("exec {} --shard \"$SLURM_ARRAY_TASK_ID/{}\"",
                     shell_line(run_of(folder, stage)), count);
}

}  // namespace

std::string slurm_lines(const std::string& folder, const Submission& how) {
  const Division division(folder, how.shards);
  kit::require_folder(folder + "/log");
  std::string lines, after;
  if (division.references > 0) {
    lines += sbatch(folder, "references", fmt::format(" --array=1-{}", division.references), how,
                    array_script(folder, references, division.references));
    after = " --dependency=afterok:\"$references\" --kill-on-invalid-dep=yes";
  }
  lines += sbatch(folder, "points", fmt::format(" --array=1-{}{}", division.points, after), how,
                  array_script(folder, points, division.points));
  lines += sbatch(folder, "merge", " --dependency=afterany:\"$points\"", how,
                  "exec " + merge_of(folder));
  return lines;
}

std::string parallel_lines(const std::string& folder, const Submission& how) {
  const Division division(folder, how.shards);
  const auto line = [&](const std::string& stage, std::size_t count) {
    return fmt::format(
        "seq {0} | parallel --use-cores-instead-of-threads --line-buffer{1} {2}", count,
        joined(how.options),
        shell_word(fmt::format("{} --shard {{}}/{}", shell_line(run_of(folder, stage)), count)));
  };
  std::string lines;
  if (division.references > 0) lines += line(references, division.references) + " &&\n";
  return lines + line(points, division.points) + "\n" + merge_of(folder) + "\n";
}

}  // namespace qddot::sweep
