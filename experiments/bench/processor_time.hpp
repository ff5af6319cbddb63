#pragma once

#include <ctime>

namespace qddot::bench {

// Adds the time [s] that this thread's processor spends on it from its construction to its end, be
// that by an exception. With nothing else on the machine it is the wall time; where others take
// turns it leaves theirs out, which would count long runs alone.
class ProcessorTime {
 public:
  explicit ProcessorTime(double& seconds) : seconds_(seconds), start_(now()) {}
  ~ProcessorTime() { seconds_ += now() - start_; }
  ProcessorTime(const ProcessorTime&) = delete;
  ProcessorTime& operator=(const ProcessorTime&) = delete;

 private:
  static double now() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }

  double& seconds_;
  double start_;
};

}  // namespace qddot::bench
