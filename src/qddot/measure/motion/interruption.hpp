#pragma once

#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace qddot::inline measure {

// The cause that asks the process to end before its work is done.
struct Interruption {
  std::string by;  // SIGINT, SIGTERM or --time-limit, as in sidecars
  int status;      // exit status of the program
};

// Thrown when work stops for an interruption; names its cause.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(const Interruption& why)
      : std::runtime_error("interrupted by " + why.by), status(why.status) {}
  int status;
};

// Ends all work of this process in order, now and from now on: runs stop after the step at hand.
void interrupt(const Interruption& why);
// The token that interrupt() requests a stop of. Runs take this token, or that of a Deadline, which
// also follows it.
std::stop_token interruption();
// The cause of the interruption; empty as long as work may go on.
std::optional<Interruption> interrupted();
// Throws Interrupted once the work is to end.
void stop_if_interrupted();
// Whether one of the last two functions has reported the interruption.
bool is_interruption_noticed();

// Interrupts one thread. While this lives, interruption() and interrupted() of the thread that made
// it follow `stop` and not the process.
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
  OwnInterruption* outer_;  // the one that this one replaces, or nullptr
};

}  // namespace qddot::inline measure
