#pragma once

#include <string>
#include <utility>

namespace qddot::bench {

// A fresh folder for what another program reads and writes, gone at its end. Throws
// std::runtime_error where none can be made.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  // The path of a file of that name in it.
  std::string path(const std::string& name) const { return path_ + "/" + name; }
  // Writes that file, and gives its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::string path_;
};

// The output of a shell's command and its exit status, or -1 if it has none.
std::pair<std::string, int> output_of(const std::string& command);

// The status with which `timeout` says that a command was out of time.
constexpr int timed_out = 124;

}  // namespace qddot::bench
