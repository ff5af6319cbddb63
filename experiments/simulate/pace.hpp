#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "qddot/measure/motion/simulation.hpp"

namespace qddot::simulate {

// Reports on stderr how long a run will take. A sleeping thread does that; the run only notes its
// time. A terminal shows one line that is updated from the first second on (see Progress).
// Elsewhere there is one message, if the pace after some seconds promises more than a minute.
class Pace {
 public:
  // `run` must outlive this and runs from time 0 to `until` [s].
  Pace(const Simulation& run, double until);
  // Removes the line.
  ~Pace();
  Pace(const Pace&) = delete;
  Pace& operator=(const Pace&) = delete;

 private:
  // Sleeps until `seconds` after the start; whether the run still goes on then.
  bool sleep_until(double seconds, const std::stop_token& over);
  void say_once(const std::stop_token& over);
  void follow(const std::stop_token& over);

  const Simulation& run_;
  const double until_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread watcher_;  // last: starts when all else is there
};

}  // namespace qddot::simulate
