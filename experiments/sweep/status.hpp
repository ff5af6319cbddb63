#pragma once

#include <string>
#include <vector>

#include "experiments/sweep/task.hpp"

namespace qddot::sweep {

// A kind of machine, and which tasks were measured on it.
struct MachineShare {
  nlohmann::json machine;
  std::vector<const Task*> tasks{};
};

// The kinds of machines on which the points among the tasks were measured, each once; the times of
// references count nowhere. `as_one`: all count as the first. Borrows the tasks, whose states are
// known.
std::vector<MachineShare> machines_of(const std::vector<Task>& tasks, bool as_one = false);

// The machines in words, each with its tasks: its processor and whatever else is not the same on
// all.
std::string in_words(const std::vector<MachineShare>& machines);

// Prints by stage how many tasks of a sweep are done, running, begun but ended, failed and missing.
// Prints which failed and why, and the expected time of the rest. Returns the exit status.
int print_status(const std::string& folder);

// Writes what is missing of a sweep to `folder`/missing.csv, and the first of it to stdout: scene,
// share, cause, and the command that measures it. Points whose reference cannot be made have no
// command. Returns whether nothing is missing.
bool report_missing(const std::string& folder, const std::vector<Task>& tasks);

}  // namespace qddot::sweep
