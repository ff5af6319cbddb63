#pragma once

#include <string>

namespace qddot::sweep {

// Tasks of a sweep.
struct TaskChoice {
  std::string stage;   // references or points
  std::string shard;   // I/N, one of N shards of the stage; empty: all
  std::string task;    // the id of a single one; may be empty
  bool again = false;  // also those that another kind of machine has measured
};

// Measures these tasks of the sweep in `folder`, unless they are done, one after the other, each in
// a process of its own, and prints how many came to which end. Returns the exit status. Throws
// InvalidInput for a wrong shard or id, and Interrupted if the work is to end; the present task
// keeps its points.
int run_tasks(const std::string& folder, const TaskChoice& choice);

}  // namespace qddot::sweep
