#pragma once

#include <ctime>

#include "qddot/measure/motion/timing.hpp"

namespace qddot {
inline namespace tests {

// While this lives, the time of measurements is that of the processor for this process, so that
// they find the same beside other processes.
struct ProcessorClock {
  ProcessorClock() { clock_in_use = now; }
  ~ProcessorClock() { clock_in_use = std::chrono::steady_clock::now; }
  ProcessorClock(const ProcessorClock&) = delete;
  ProcessorClock& operator=(const ProcessorClock&) = delete;

  static std::chrono::steady_clock::time_point now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return std::chrono::steady_clock::time_point(std::chrono::seconds(t.tv_sec) +
                                                 std::chrono::nanoseconds(t.tv_nsec));
  }
};

// While this lives, time passes by what a test says alone.
struct MadeClock {
  MadeClock() { clock_in_use = now; }
  ~MadeClock() { clock_in_use = std::chrono::steady_clock::now; }
  MadeClock(const MadeClock&) = delete;
  MadeClock& operator=(const MadeClock&) = delete;

  static void pass(double seconds) {
    time = time.load() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                             std::chrono::duration<double>(seconds));
  }
  static std::chrono::steady_clock::time_point now() { return time; }

 private:
  static inline std::atomic<std::chrono::steady_clock::time_point> time;
};

}  // namespace tests
}  // namespace qddot
