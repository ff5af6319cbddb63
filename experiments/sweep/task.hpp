#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/kit/journal.hpp"

namespace qddot::sweep {

using kit::Journal;

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

// The state of a task.
struct TaskState {
  enum Kind {
    whole,              // it is measured
    without_reference,  // and there is no reference, which `cause` says
    running,            // a process measures it, `where`
    begun,              // one did, and was ended: some of its pieces are kept
    failed,             // for a cause that may go away
    missing,
  };
  Kind kind = missing;
  std::string cause{}, where{};
  double seconds = 0;        // that a whole one took
  nlohmann::json machine{};  // that it was measured on

  bool is_done() const { return kind == whole || kind == without_reference; }
};

// A share of the study of one scene, which one process measures by itself.
struct Task {
  std::string id;       // 16 hexadecimal digits, see id_of
  std::string stage;    // references or points
  std::string folder;   // of the scene's results, in that of the sweep
  std::string program;  // by its name
  std::string share;
  std::vector<std::string> arguments;      // of the program, but for --out, --share and --journal
  nlohmann::json key;                      // of the study, see Study
  std::map<std::string, double> varied{};  // what tells the scene from others of its entry
  std::size_t entry = 0;                   // of the list of scenes
  std::size_t order = 0;                   // scene by scene and, of each, as its program says
  TaskState state{};                       // where somebody has looked; not kept
};

inline const std::string references = "references", points = "points";

// The hash, 16 hexadecimal digits, of all that decides the results of a share: scene, end time,
// method, options, code, compiler and flags. The machine is not part of it; it decides only the
// times.
std::string id_of(nlohmann::json key, const std::string& share);

// All tasks in the order of measurement: references first, and each stage by its ids, which is a
// random order. So no shard gets all tasks of one scene or method, and finished tasks predict the
// time of the rest without bias. Throws InvalidInput, which names file and line, if
// `folder`/tasks.jsonl is missing or damaged, or was planned by other code.
std::vector<Task> read_tasks(const std::string& folder);
// Writes them in that order, a line each.
void write_tasks(const std::string& folder, std::vector<Task> tasks);

// The command of a program of qddot with these arguments that writes into the folder `out`;
// `more`: its last arguments but for --progress.
Command command_of(const std::string& program, const std::vector<std::string>& arguments,
                   const std::string& out, const std::vector<std::string>& more);

// Writes a file that appears whole or not at all; see WholeFile for `beginning`.
void write_whole(const std::string& path, const std::string& text,
                 const std::string& beginning = {});

// The files of the tasks of a sweep, in its folder:
//   tasks/whole/ID.journal           what a task measured, never written again
//   tasks/begun/ID.HOST.PID.journal  what a process is measuring, or measured until it was ended
//   tasks/failed/ID.json             why a task failed last
// Writing needs no locks: each process writes a file of its own. A link makes it ID.journal at
// once, and fails if another process was first. Locks only tell whether a process is at work.
class TaskFiles {
 public:
  // Makes the folders if asked to. Throws InvalidInput where that cannot be done.
  explicit TaskFiles(std::string folder, bool makes_folders = false);

  const std::string& folder() const { return folder_; }
  TaskState state(const Task& task) const;
  // The results of a task, if it is whole, as its mark says.
  std::optional<Journal::Contents> contents(const Task& task) const;

  // The file for this process to measure the task into, with the pieces that ended processes have
  // kept. Throws InvalidInput or CannotWrite as Journal does.
  std::string begin(const Task& task) const;
  // Gives a complete file of begin() its final name, unless another process was first and
  // `replaces` is false. Removes the record of a failure and other unfinished files of the task.
  // Returns false, and does nothing, if the file is not complete.
  bool finish(const Task& task, const std::string& journal, bool replaces = false) const;
  // Removes what ended processes have kept of a task that is done.
  void tidy(const Task& task) const;
  // Why it failed.
  void fail(const Task& task, const std::string& cause) const;

 private:
  std::string whole_path(const Task& task) const;
  std::string failed_path(const Task& task) const;
  std::vector<std::string> begun_paths(const Task& task) const;

  std::string folder_;
};

}  // namespace qddot::sweep
