#include "experiments/sweep/machines.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace qddot::sweep {

std::vector<MachineShare> machines_of(const std::vector<Task>& tasks,
                                      const std::vector<TaskState>& states) {
  std::vector<MachineShare> machines;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].stage != points || states[i].kind != TaskState::whole) continue;
    auto own = std::ranges::find(machines, states[i].machine, &MachineShare::machine);
    if (own == machines.end()) own = machines.insert(own, {.machine = states[i].machine});
    own->tasks.push_back(i);
  }
  return machines;
}

std::string in_words(const std::vector<MachineShare>& machines) {
  std::vector<std::string> all;
  for (const MachineShare& one : machines) {
    std::vector<std::string> words = {one.machine.value("cpu", "an unknown processor")};
    for (const auto& entry : one.machine.items()) {
      const bool differs = std::ranges::any_of(machines, [&](const MachineShare& other) {
        return other.machine.value(entry.key(), nlohmann::json()) != entry.value();
      });
      if (differs && entry.key() != "cpu")
        words.push_back(fmt::format("{} {}", entry.key(), entry.value().dump()));
    }
    all.push_back(fmt::format("{} ({} tasks)", fmt::join(words, ", "), one.tasks.size()));
  }
  return fmt::format("{}", fmt::join(all, " and "));
}

}  // namespace qddot::sweep
