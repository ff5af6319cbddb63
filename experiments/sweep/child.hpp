#pragma once

#include <string>
#include <utility>
#include <vector>

namespace qddot::sweep {

// A program to be run beside this one, with its arguments and what it finds in its environment
// beside what this one has.
struct Command {
  std::string program;  // its path
  std::vector<std::string> arguments{};
  std::vector<std::pair<std::string, std::string>> environment{};
};

// The command as a shell takes it.
std::string shell_line(const Command& command);

// How a program ended: its status, or the number of the signal that ended it, and what it wrote.
struct ChildEnd {
  int status = -1, signal = 0;
  std::string out{}, err{};

  // What it said last on stderr, or what ended it, in one line.
  std::string cause() const;
};

// The path of a program of qddot, beside this one.
std::string program_path(const std::string& name);

// Runs it to its end. It ends with this process, whatever ends that; where the work of this process
// is to end it is asked to end in order. Throws std::runtime_error where it cannot be started.
ChildEnd run_child(const Command& command);

}  // namespace qddot::sweep
