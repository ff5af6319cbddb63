#include "experiments/sweep/child.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "qddot/measure/motion/interruption.hpp"

namespace qddot::sweep {
namespace {

constexpr int pause = 250;       // [ms]: rare enough to disturb no timed run
constexpr int patience = 40000;  // [ms]: longer than a study waits for a step

// The output of a child, in memory.
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

// Waits for the end of the child, which is asked for it if this process is interrupted.
void wait_for_end(pid_t child) {
  const auto end = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
  bool is_told = false;
  for (int waited = 0; end >= 0 && waited < patience;) {
    pollfd ended{end, POLLIN, 0};
    if (::poll(&ended, 1, pause) > 0) break;
    if (!interrupted()) continue;
    if (!is_told) ::kill(child, SIGTERM);
    is_told = true;
    waited += pause;
    if (waited >= patience) ::kill(child, SIGKILL);
  }
  ::close(end);
}

}  // namespace

std::string shell_line(const Command& command) {
  std::string line;
  for (const std::string& word : command) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

std::string ChildEnd::cause() const {
  if (signal != 0)
    return fmt::format("it was ended by signal {} ({})", signal, ::strsignal(signal));
  std::size_t end = err.find_last_not_of(" \n");
  if (end == err.npos) return fmt::format("it ended with status {}", status);
  const std::size_t start = err.rfind('\n', end);
  return in_one_line(err.substr(start == err.npos ? 0 : start + 1, end - start));
}

std::string program_path(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

ChildEnd run_child(const Command& command) {
  Command words = command;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const Output out, err;
  const pid_t self = ::getpid(), child = ::fork();
  if (child == 0) {  // only what a child of a process with threads may call
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != self) ::_exit(127);
    ::setpgid(0, 0);  // a terminal's Ctrl-C is for the parent, which tells it
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(out.file(), STDOUT_FILENO);
    ::dup2(err.file(), STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  if (child < 0) throw std::runtime_error("no process can be started");
  wait_for_end(child);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw std::runtime_error(fmt::format("{} cannot be run", command.front()));
  return {.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
          .out = out.text(),
          .err = err.text()};
}

}  // namespace qddot::sweep
