#pragma once

#include <string>
#include <vector>

namespace qddot::sweep {

// A program by its path, and its arguments.
using Command = std::vector<std::string>;

// The command as a shell takes it.
std::string shell_line(const Command& command);

// The end of a program: its status, or the number of the signal that ended it, and its output.
struct ChildEnd {
  int status = -1, signal = 0;
  std::string out{}, err{};

  // The last line that it wrote to stderr, or the reason of its end.
  std::string cause() const;
};

// The path of a program of qddot, beside this one.
std::string program_path(const std::string& name);

// Runs a command to its end. It ends with this process, whatever ends that. If the work of this
// process is interrupted, the command is asked to end in order. Throws std::runtime_error if it
// cannot be started.
ChildEnd run_child(const Command& command);

}  // namespace qddot::sweep
