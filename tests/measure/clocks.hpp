#pragma once

#include "qddot/measure/motion/timing.hpp"

namespace qddot {
inline namespace tests {

// While this lives, measurements go by a clock of the test's.
struct ClockOfTest {
  explicit ClockOfTest(std::chrono::steady_clock::time_point (*now)()) { clock_in_use = now; }
  ~ClockOfTest() { clock_in_use = std::chrono::steady_clock::now; }
  ClockOfTest(const ClockOfTest&) = delete;
  ClockOfTest& operator=(const ClockOfTest&) = delete;
};

// The processor's time for this process, so that measurements find the same beside other processes.
struct ProcessorClock : ClockOfTest {
  ProcessorClock() : ClockOfTest(processor_time) {}
};

// Each look at the clock takes a microsecond and nothing else takes time, so that measurements find
// the same on every machine. Each thread has its own time.
struct CountedClock : ClockOfTest {
  CountedClock() : ClockOfTest(now) {}
  static std::chrono::steady_clock::time_point now() {
    static thread_local std::chrono::steady_clock::time_point time;
    return time += std::chrono::microseconds(1);
  }
};

// Time passes by what a test says alone.
struct MadeClock : ClockOfTest {
  MadeClock() : ClockOfTest(now) {}
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
