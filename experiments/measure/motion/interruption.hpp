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

}  // namespace qddot::measure
