#include "experiments/sweep/child.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/shell_word.hpp"
#include "qddot/measure/motion/interruption.hpp"

namespace qddot::sweep {
namespace {

constexpr int pause = 250;       // [ms]: rare enough to disturb no timed run
constexpr int patience = 40000;  // [ms]: longer than a study waits for a step

// What a child writes, in memory.
class Output {
 public:
  Output() : file_(::memfd_create("output", MFD_CLOEXEC)) {
    if (file_ < 0) throw std::runtime_error("no file in memory can be made");
  }
  ~Output() { ::close(file_); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  int file() const { return file_; }
  std::string text() const {
    const off_t size = ::lseek(file_, 0, SEEK_END);
    std::string all(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
    if (::pread(file_, all.data(), all.size(), 0) != std::ssize(all)) all.clear();
    return all;
  }

 private:
  int file_;
};

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

// This process's environment with some entries replaced.
std::vector<std::string> environment_of(const Command& command) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    bool is_replaced = false;
    for (const auto& [name, value] : command.environment)
      is_replaced |= text.starts_with(name + "=");
    if (!is_replaced) all.push_back(text);
  }
  for (const auto& [name, value] : command.environment) all.push_back(name + "=" + value);
  return all;
}

// Waits until nobody holds the other end of the pipe, which is when the child has ended.
void wait_for_end(int pipe, pid_t child) {
  bool is_told = false;
  for (int waited = 0; waited < patience;) {
    pollfd end{pipe, POLLIN, 0};
    if (::poll(&end, 1, pause) > 0) return;
    if (!measure::interrupted()) continue;
    if (!is_told) ::kill(child, SIGTERM);
    is_told = true;
    waited += pause;
  }
  ::kill(child, SIGKILL);
}

}  // namespace

std::string shell_line(const Command& command) {
  std::string line;
  for (const auto& [name, value] : command.environment)
    line += fmt::format("{}={} ", name, kit::shell_word(value));
  line += kit::shell_word(command.program);
  for (const std::string& word : command.arguments) line += " " + kit::shell_word(word);
  return line;
}

std::string ChildEnd::cause() const {
  if (signal != 0)
    return fmt::format("it was ended by signal {} ({})", signal, ::strsignal(signal));
  std::size_t end = err.find_last_not_of(" \n");
  if (end == err.npos) return fmt::format("it ended with status {}", status);
  const std::size_t start = err.rfind('\n', end);
  return kit::in_one_line(err.substr(start == err.npos ? 0 : start + 1, end - start));
}

std::string program_path(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

ChildEnd run_child(const Command& command) {
  std::vector<std::string> words = command.arguments, entries = environment_of(command);
  words.insert(words.begin(), command.program);
  const auto argv = pointers(words), envp = pointers(entries);
  const Output out, err;
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe can be opened");
  const pid_t self = ::getpid(), child = ::fork();
  if (child == 0) {  // only what a child of a process with threads may call
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != self) ::_exit(127);
    ::setpgid(0, 0);  // a terminal's Ctrl-C is for the parent, which tells it
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(out.file(), STDOUT_FILENO);
    ::dup2(err.file(), STDERR_FILENO);
    ::fcntl(pipe[1], F_SETFD, 0);
    ::execve(argv[0], argv.data(), envp.data());
    ::_exit(127);
  }
  ::close(pipe[1]);
  if (child < 0) {
    ::close(pipe[0]);
    throw std::runtime_error("no process can be started");
  }
  wait_for_end(pipe[0], child);
  ::close(pipe[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw std::runtime_error(fmt::format("{} cannot be run", command.program));
  return {.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
          .out = out.text(),
          .err = err.text()};
}

}  // namespace qddot::sweep
