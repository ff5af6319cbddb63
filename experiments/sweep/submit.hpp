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

// Three lines of a shell that have Slurm run a sweep: an array of jobs for the references, one for
// the points that waits until all of these went well, and the merge, which waits until the points
// have ended, however: a shard of which a task failed is a failed job to Slurm. Each job gets a
// core of its own, no thread beside it; what the user gives sbatch comes last and counts.
std::string slurm_lines(const std::string& folder, const Submission& how);

// The same with GNU parallel: one process a core, here or, with --sshlogin, on others that see the
// folder under the same path.
std::string parallel_lines(const std::string& folder, const Submission& how);

// Runs the lines by a shell, whose output is this process's. Returns the shell's status.
int go(const std::string& lines);

}  // namespace qddot::sweep
