#pragma once

#include <cstddef>
#include <string>
#include <vector>

// Actions of sweep, in the folder of a sweep. Those that return an int return the exit status.
namespace qddot::sweep {

// Plans the study of a file: writes its tasks, and scene files that it asks for, into the folder
// `out`. Prints how many there are. Throws InvalidInput if there would be too many tasks or, in the
// program's own words, if it does not take a scene, a method or an option.
int plan(const std::string& study_path, const std::string& out);

// Tasks of a sweep.
struct TaskChoice {
  std::string stage;   // references or points
  std::string shard;   // I/N, one of N shards of the stage; empty: all
  std::string task;    // the id of a single one; may be empty
  bool again = false;  // also those that another kind of machine has measured
};

// Measures those of these tasks that are not done, one after the other, each in a process of its
// own. Prints how many came to which end. Throws InvalidInput for a wrong shard or id, and
// Interrupted if the work is to end; the present task keeps its points.
int run_tasks(const std::string& folder, const TaskChoice& choice);

// How results of several processes become one.
struct Merging {
  bool per_machine = false;  // a folder for each kind of machine
  bool by_work = false;      // counts times costs on this machine in place of the times
  bool has_pictures = true;
};

// Makes a folder for each scene, with the outputs of the study's program from the results of the
// tasks: tables, a chart, a report. If the program is work_precision, also makes
// fastest.csv, crossovers.csv and a picture of them from the points.csv of all scenes. missing.csv
// and stdout name missing results, the reason, and the command that measures them. Throws
// InvalidInput if times of unlike machines would be compared.
int merge(const std::string& folder, const Merging& how);

// How a sweep is divided among processes.
struct Submission {
  std::size_t shards = 100;            // at most, of points
  std::vector<std::string> options{};  // of sbatch, or of parallel
};

// Three lines of a shell that make Slurm run a sweep:
// - an array of jobs for the references,
// - an array for the points, which waits for the success of all references,
// - the merge, which waits for the end of the points, successful or not: a shard with a failed task
//   is a failed job to Slurm.
// Each job gets a core of its own, without another thread on it. The user's options for sbatch come
// last and override these.
std::string slurm_lines(const std::string& folder, const Submission& how);
// The same with GNU parallel: one process a core, here or, with --sshlogin, on others that see the
// folder under the same path.
std::string parallel_lines(const std::string& folder, const Submission& how);

}  // namespace qddot::sweep
