#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "qddot/integrators/integrator.hpp"

namespace qddot::inline kit {

// A sentence on the time that a run will take in all, from the time `t` of `until` [s] that it
// reached in `seconds` of wall time. Empty if that is a minute or less.
std::string pace_in_words(double t, double until, double seconds);

// Reports on stderr how long a run will take. A sleeping thread does that; the run only notes its
// time. A terminal shows one line that is updated from the first second on (see Progress).
// Elsewhere there is one message, if the pace after some seconds promises more than a minute.
class Pace {
 public:
  // `integrator` must outlive this and runs from time 0 to `until` [s].
  Pace(std::string program, const Integrator& integrator, double until);
  // Removes the line.
  ~Pace();
  Pace(const Pace&) = delete;
  Pace& operator=(const Pace&) = delete;

 private:
  // Sleeps until `seconds` after the start; whether the run still goes on then.
  bool sleep_until(double seconds, const std::stop_token& over);
  void say_once(const std::string& program, const Integrator& integrator, double until,
                const std::stop_token& over);
  void follow(const Integrator& integrator, double until, const std::stop_token& over);

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread watcher_;  // last: starts when all else is there
};

}  // namespace qddot::inline kit
