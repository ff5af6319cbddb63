#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/kit/journal.hpp"
#include "experiments/sweep/task.hpp"

namespace qddot::sweep {

using kit::Journal;

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
