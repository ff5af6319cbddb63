#pragma once

#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>

namespace qddot::inline measure {

// What asked the process to end before its work is done.
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
// The token that interrupt() requests a stop of. Runs take it, or that of a Deadline, which waits
// for it too.
std::stop_token interruption();
// Why the work is to end; empty as long as it may go on.
std::optional<Interruption> interrupted();
// Throws Interrupted once the work is to end.
void stop_if_interrupted();
// Whether one of the last two functions has reported the interruption.
bool is_interruption_noticed();

// Interrupts one thread: while this lives, interruption() and interrupted() in the thread that made
// it follow `stop` and no longer the process.
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
  OwnInterruption* outer_;  // the one that this one replaces; may be none
};

}  // namespace qddot::inline measure
