#pragma once

#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>

namespace qddot {

// What asked a program to end before its work is done.
struct Interruption {
  std::string by;  // SIGINT, SIGTERM or --time-limit, as sidecars name it
  int status;      // what the program exits with
};

// Thrown where work stops for an interruption; says by what.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(const Interruption& why)
      : std::runtime_error("interrupted by " + why.by), status(why.status) {}
  int status;
};

// Requested once the program is to end. Runs take it, or a Deadline, which waits for it as well.
std::stop_token interruption();
// By what the program is to end; nothing as long as it may go on.
std::optional<Interruption> interrupted();
// Throws Interrupted once the program is to end.
void stop_if_interrupted();
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

}  // namespace qddot
