#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "qddot/integrators/integrator.hpp"

namespace qddot::command {

// That a run which has come to `t` of `until` [s] in so many seconds takes more than a minute in
// all, and how long; empty where it takes less.
std::string pace_in_words(double t, double until, double seconds);

// Says on stderr how long a run will take, from a sleeping thread; the run only notes its time. A
// terminal's line is written over from the first second on (see Progress). Elsewhere it is said
// once, where the pace after a second, or a few, lets one expect more than a minute.
class Pace {
 public:
  // `integrator` must outlive this and runs from time 0 to `until` [s].
  Pace(std::string program, const Integrator& integrator, double until);
  // Takes the line away.
  ~Pace();
  Pace(const Pace&) = delete;
  Pace& operator=(const Pace&) = delete;

 private:
  // Whether the run goes on still after so many seconds.
  bool sleep_until(double seconds, const std::stop_token& over);
  void say_once(const std::string& program, const Integrator& integrator, double until,
                const std::stop_token& over);
  void follow(const Integrator& integrator, double until, const std::stop_token& over);

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread watcher_;  // last: starts when all else is there
};

}  // namespace qddot::command
