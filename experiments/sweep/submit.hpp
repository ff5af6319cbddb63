#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace qddot::sweep {

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

// Runs the lines by a shell, whose output is this process's. Returns the shell's status.
int go(const std::string& lines);

}  // namespace qddot::sweep
