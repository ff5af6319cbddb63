#include "experiments/sweep/task.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <poll.h>
#include <stdexcept>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {

// nlohmann::json looks for it in the namespace of the type.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Task, id, stage, folder, program, share, arguments, key, varied,
                                   entry, order)

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

namespace fs = std::filesystem;

std::string path_of(const std::string& folder) { return folder + "/tasks.jsonl"; }

std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

bool is_sound(const Task& task) {
  const auto is_name = [](const std::string& name) {
    return !name.empty() && name.find('/') == name.npos && !name.starts_with('.');
  };
  return (task.stage == references || task.stage == points) && is_name(task.folder) &&
         is_name(task.program) && task.id == id_of(task.key, task.share);
}

// Whether a process holds the lock of a journal; it does as long as it lives.
bool is_held(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool is = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return is;
}

// HOST.PID of tasks/begun/ID.HOST.PID.journal.
std::string where(const std::string& path, const Task& task) {
  return fs::path(path).stem().string().substr(task.id.size() + 1);
}

// Whether the scene's folder has the reference that the task made: somebody may have taken it away,
// or made another there.
bool has_reference(const Task& task, const std::string& folder) {
  std::ifstream file(folder + "/" + task.folder + "/reference.json");
  const auto json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("key")) return false;
  const auto &there = json["key"], &about = task.key.at("about");
  return there.value("scene_hash", "") == about.at("scene").get<std::string>() &&
         there.value("until", 0.0) == about.at("until").get<double>() &&
         there.value("source_hash", "") == task.key.at("build").at("code").get<std::string>();
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

std::string id_of(nlohmann::json key, const std::string& share) {
  key.erase("machine");
  key["share"] = share;
  return text_hash(text_of(key));
}

std::vector<Task> read_tasks(const std::string& folder) {
  const std::string path = path_of(folder);
  std::ifstream file(path);
  std::vector<Task> tasks;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto json = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    bool is_good = false;
    try {
      tasks.push_back(json.get<Task>());
      is_good = is_sound(tasks.back());
    } catch (const nlohmann::json::exception&) {  // written by somebody else
    }
    if (!is_good) {
      throw InvalidInput(fmt::format(
          "{}:{}: it is no task as sweep plan writes it; allowed is to plan the study again", path,
          number));
    }
  }
  if (tasks.empty()) {
    throw InvalidInput(fmt::format(
        "{}: it is missing or empty; allowed is a folder that sweep plan has filled", path));
  }
  if (const auto what = difference(tasks.front().key.value("build", nlohmann::json()), build());
      !what.empty()) {
    throw InvalidInput(fmt::format(
        "{}: it was planned by another build of qddot: {}; allowed are that build, or to plan the "
        "study again",
        path, what));
  }
  return tasks;
}

void write_tasks(const std::string& folder, std::vector<Task> tasks) {
  std::ranges::sort(tasks, {},
                    [](const Task& task) { return std::pair(task.stage != references, task.id); });
  // qddot may replace the file: its first line has the hash of the sources.
  WholeFile file(path_of(folder), R"({"arguments":)");
  for (const Task& task : tasks) file.write(text_of(task) + "\n");
  file.complete();
  file.commit();
}

Command command_of(const std::string& program, const std::vector<std::string>& arguments,
                   const std::string& out, const std::vector<std::string>& more) {
  Command command = {program_path(program)};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.insert(command.end(), {"--out", out});
  command.insert(command.end(), more.begin(), more.end());
  command.insert(command.end(), {"--progress", "none"});
  return command;
}

void write_whole(const std::string& path, const std::string& text, const std::string& beginning) {
  WholeFile file(path, beginning);
  file.write(text);
  file.complete();
  file.commit();
}

TaskFiles::TaskFiles(std::string folder, bool makes_folders) : folder_(std::move(folder)) {
  if (!makes_folders) return;
  for (const char* name : {"whole", "begun", "failed"}) require_folder(folder_ + "/tasks/" + name);
}

std::string TaskFiles::whole_path(const Task& task) const {
  return fmt::format("{}/tasks/whole/{}.journal", folder_, task.id);
}

std::string TaskFiles::failed_path(const Task& task) const {
  return fmt::format("{}/tasks/failed/{}.json", folder_, task.id);
}

std::vector<std::string> TaskFiles::begun_paths(const Task& task) const {
  std::vector<std::string> paths;
  std::error_code error;
  fs::directory_iterator entry(folder_ + "/tasks/begun", error), end;
  for (; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(task.id + ".") && name.ends_with(".journal"))
      paths.push_back(entry->path().string());
  }
  return paths;
}

std::optional<Journal::Contents> TaskFiles::contents(const Task& task) const {
  Journal::Contents contents = Journal::read(whole_path(task));
  const auto mark = contents.pieces.find(whole_mark(task.share));
  if (mark == contents.pieces.end()) return {};
  if (id_of(contents.key, task.share) != task.id) return {};  // of other code, or somebody else's
  const bool made_reference = task.share == reference_share && mark->second.at("failure").is_null();
  if (made_reference && !has_reference(task, folder_)) return {};
  return contents;
}

TaskState TaskFiles::state(const Task& task) const {
  if (const auto whole = contents(task)) {
    const auto& mark = whole->pieces.at(whole_mark(task.share));
    TaskState state{.kind = TaskState::whole,
                    .where = mark.value("host", ""),
                    .seconds = mark.value("seconds", 0.0),
                    .machine = whole->key.value("machine", nlohmann::json())};
    if (const auto failure = mark.find("failure"); failure != mark.end() && failure->is_string()) {
      state.kind = TaskState::without_reference;
      state.cause = *failure;
    }
    return state;
  }
  const auto begun = begun_paths(task);
  for (const std::string& path : begun) {
    if (is_held(path)) return {.kind = TaskState::running, .where = where(path, task)};
  }
  std::ifstream file(failed_path(task));
  const auto failure = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (failure.is_object())
    return {.kind = TaskState::failed, .cause = failure.value("cause", "unknown")};
  if (begun.empty()) return {};
  return {.kind = TaskState::begun,
          .cause = fmt::format("its process was ended ({})", where(begun.front(), task)),
          .where = where(begun.front(), task)};
}

std::string TaskFiles::begin(const Task& task) const {
  std::string path =
      fmt::format("{}/tasks/begun/{}.{}.{}.journal", folder_, task.id, host(), ::getpid());
  nlohmann::json key = task.key;
  key["machine"] = machine();
  key["share"] = task.share;
  std::vector<Journal::Contents> all;
  for (const std::string& other : begun_paths(task)) all.push_back(Journal::read(other));
  Journal journal(path, key, /*goes_on=*/false);
  for (const Journal::Contents& kept : all) {
    if (kept.key != key) continue;  // seconds of another machine
    for (const auto& [name, value] : kept.pieces) {
      if (!journal.find(name)) journal.keep(name, value);
    }
  }
  return path;
}

bool TaskFiles::finish(const Task& task, const std::string& journal, bool replaces) const {
  const Journal::Contents own = Journal::read(journal);
  if (!own.pieces.contains(whole_mark(task.share)) || id_of(own.key, task.share) != task.id)
    return false;
  const std::string place = whole_path(task);
  const bool is_damaged = fs::exists(place) && !contents(task);
  const bool is_linked =
      !replaces && !is_damaged && (::link(journal.c_str(), place.c_str()) == 0 || errno == EEXIST);
  // Some file systems have no links.
  if (!is_linked && std::rename(journal.c_str(), place.c_str()) != 0) {
    throw CannotWrite(
        fmt::format("{}: cannot be written: {}", place, std::generic_category().message(errno)));
  }
  ::unlink(journal.c_str());
  tidy(task);
  return true;
}

void TaskFiles::tidy(const Task& task) const {
  for (const std::string& path : begun_paths(task)) {
    if (!is_held(path)) ::unlink(path.c_str());
  }
  ::unlink(failed_path(task).c_str());
}

void TaskFiles::fail(const Task& task, const std::string& cause) const {
  const nlohmann::json record = {{"cause", cause}, {"host", host()}, {"date", date_now()}};
  write_whole(failed_path(task), text_of(record) + "\n", "{\"cause\":");
}

}  // namespace qddot::sweep
