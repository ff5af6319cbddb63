#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/sweep/task_files.hpp"

namespace qddot::sweep {

// A kind of machine, and which tasks were measured on it.
struct MachineShare {
  nlohmann::json machine;
  std::vector<std::size_t> tasks{};
};

// The kinds of machines on which the points among the tasks were measured, each once; the times of
// references count nowhere.
std::vector<MachineShare> machines_of(const std::vector<Task>& tasks,
                                      const std::vector<TaskState>& states);

// The machines in words, each with its tasks: its processor and whatever else is not the same on
// all.
std::string in_words(const std::vector<MachineShare>& machines);

}  // namespace qddot::sweep
