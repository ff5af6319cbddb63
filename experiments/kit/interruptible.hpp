#pragma once

#include <string>
#include <thread>

#include "qddot/measure/motion/interruption.hpp"

namespace qddot::inline kit {

// Sets how long [s] an interruption waits for an answer, for a program that has results to save.
// The default is zero.
void wait_for_answer(double seconds);

// While it lives, SIGINT, SIGTERM and a time limit interrupt the process's work. A process that
// ignores these signals goes on ignoring them. The process ends at once after a second signal, or
// if nothing answers the first one or the time limit in time. An answer is a call of
// stop_if_interrupted() or interrupted(). Unfinished files are removed then; journals stay.
class Interruptible {
 public:
  // `program`: its name, for the message if nothing answers.
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

}  // namespace qddot::inline kit
