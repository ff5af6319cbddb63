#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/task_files.hpp"

namespace qddot::sweep {

// One of so many shards, from 1 on; they take the tasks of a stage in turn.
struct Shard {
  int number = 1, count = 1;
};

// Reads "2/8". Throws InvalidInput unless it is 1/N to N/N.
Shard shard_of(const std::string& text);

// What became of the tasks of a shard.
struct ShardEnd {
  std::size_t done = 0;       // before or now
  std::size_t skipped = 0;    // there is no reference, as its task says
  std::size_t elsewhere = 0;  // another process is at them
  std::size_t waiting = 0;    // for a reference that is not made
  std::size_t failed = 0;

  // Whether nothing of the shard is left to measure.
  bool is_complete() const { return elsewhere + waiting + failed == 0; }
};

// The tasks of a stage in the shard, or the one task of an id if that is given.
std::vector<Task> chosen(const std::vector<Task>& tasks, const std::string& stage,
                         const Shard& shard);

// Measures the unfinished tasks of `mine` one after the other, each in a process of its own.
// `again`: whether to replace results that another kind of machine measured. `all` tells which
// references there are. Throws Interrupted if the work is to end; the present task keeps its
// points.
ShardEnd run_tasks(const TaskFiles& files, const std::vector<Task>& mine,
                   const std::vector<Task>& all, bool again = false);

}  // namespace qddot::sweep
