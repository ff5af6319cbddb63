#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::inline measure {

// Requests a stop after a number of seconds, or when the program is to end. A sleeping thread does
// so, and the timed run only reads a flag. The destructor disarms it.
class Deadline {
 public:
  explicit Deadline(double seconds)
      : watcher_([this, seconds](const std::stop_token& disarmed) {
          std::unique_lock lock(mutex_);
          const auto start = clock_now();
          // In waits that are no longer than a clock can count.
          for (double left = seconds; left > 0 && !disarmed.stop_requested();
               left = seconds - seconds_since(start))
            wake_.wait_for(lock, disarmed, std::chrono::duration<double>(std::min(left, 1e6)),
                           [] { return false; });
          if (!disarmed.stop_requested()) source_.request_stop();
        }) {}

  std::stop_token token() const { return source_.get_token(); }
  bool passed() const { return source_.stop_requested(); }

 private:
  struct Ask {
    std::stop_source source;
    void operator()() { source.request_stop(); }
  };

  std::stop_source source_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::stop_callback<Ask> on_interruption_{interruption(), Ask{source_}};
  std::jthread watcher_;  // last: starts when the other members exist, and joins first
};

}  // namespace qddot::inline measure
