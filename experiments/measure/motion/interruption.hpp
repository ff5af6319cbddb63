#pragma once

#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace qddot::measure {

// What asked the process to end its work before that is done.
struct Interruption {
  std::string by;  // SIGINT, SIGTERM or --time-limit, as sidecars name it
  int status;      // what a program exits with
};

// Thrown where work stops for an interruption; says by what.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(const Interruption& why)
      : std::runtime_error("interrupted by " + why.by), status(why.status) {}
  int status;
};

// Ends all work of this process in order, now and from now on: runs stop after the step at hand.
void interrupt(const Interruption& why);
// Requested once interrupt() was called. Runs take it, or a Deadline, which waits for it as well.
std::stop_token interruption();
// Why the work is to end; nothing as long as it may go on.
std::optional<Interruption> interrupted();
// Throws Interrupted once the work is to end.
void stop_if_interrupted();
// Whether somebody has learned of the interruption by one of these two.
bool is_interruption_noticed();

// Ends the work of one thread: while this lives, interruption() and interrupted() of the thread
// that made it are those of `stop`, in the place of the process's.
class OwnInterruption {
 public:
  OwnInterruption(std::stop_token stop, Interruption why);
  ~OwnInterruption();
  OwnInterruption(const OwnInterruption&) = delete;
  OwnInterruption& operator=(const OwnInterruption&) = delete;

  const std::stop_token& stop() const { return stop_; }
  const Interruption& why() const { return why_; }

 private:
  std::stop_token stop_;
  Interruption why_;
  OwnInterruption* outer_;  // which this one stands before; may be none
};

}  // namespace qddot::measure
