#pragma once

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

// Says once on stderr how long a run will take, where its pace after a second, or a few, lets one
// expect more than a minute. A sleeping thread looks; the run only notes its time.
class Pace {
 public:
  // `integrator` must outlive this and runs from time 0 to `until` [s].
  Pace(std::string program, const Integrator& integrator, double until);

 private:
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread watcher_;  // last: starts when all else is there, and joins first
};

}  // namespace qddot::command
