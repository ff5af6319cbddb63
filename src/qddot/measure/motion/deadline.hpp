#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "qddot/measure/motion/interruption.hpp"

namespace qddot::inline measure {

// Requests stops after given times, one at a time. A sleeping thread does so, and a timed run only
// reads a flag. The thread begins with the first time and serves all others: to start it takes
// longer than many a run.
class Alarm {
 public:
  // Requests a stop of the source after that many seconds on the clock in use, unless clear() or
  // another set() comes before.
  void set(const std::stop_source& source, double seconds);
  // No stop is requested from now on.
  void clear();

 private:
  // Sleeps until it is time, again and again.
  void watch(const std::stop_token& ended);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<std::stop_source> waiting_;
  std::chrono::steady_clock::time_point begin_;  // of the wait, on the clock in use
  double seconds_ = 0;
  std::chrono::steady_clock::time_point wakes_;  // the end of the thread's present sleep
  bool is_hurried_ = false;                      // whether it must wake before
  std::jthread watcher_;  // last: starts when the other members exist, and joins first
};

// Requests a stop after a number of seconds, or when the program is to end. An infinite time has no
// end. The destructor disarms it.
class Deadline {
 public:
  explicit Deadline(double seconds);
  // By an alarm that serves nothing else meanwhile.
  Deadline(double seconds, Alarm& alarm);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  std::stop_token token() const { return source_.get_token(); }
  bool passed() const { return source_.stop_requested(); }

 private:
  struct Ask {
    std::stop_source source;
    void operator()() { source.request_stop(); }
  };

  void set(double seconds, Alarm* alarm);

  std::stop_source source_;
  std::unique_ptr<Alarm> own_;  // empty if another serves, or none need be
  Alarm* alarm_ = nullptr;      // the one that is set; nullptr if none need be
  std::stop_callback<Ask> on_interruption_{interruption(), Ask{source_}};
};

}  // namespace qddot::inline measure
