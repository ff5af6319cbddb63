#pragma once

#include <string>
#include <thread>

#include "qddot/measure/motion/interruption.hpp"

namespace qddot::command {

using namespace measure;

// Lets an interruption wait so long [s] for an answer: for a program that has results to save. It
// waits for none at first.
void wait_for_answer(double seconds);

// While it lives, SIGINT, SIGTERM and a time limit request the interruption. A process that ignores
// these signals goes on doing so. A second signal ends the process at once, and so does the first
// one, or the time limit, where nothing answers it in time: by stop_if_interrupted() or
// interrupted(). Unfinished files go then, what is in journals stays.
class Interruptible {
 public:
  // `program` names it where nothing answers.
  explicit Interruptible(std::string program);
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  // Sets the time limit [s] from now on.
  void end_after(double seconds);

 private:
  void watch();
  [[noreturn]] void give_up(const Interruption& why) const;

  std::string program_;
  std::thread watcher_;
};

}  // namespace qddot::command
