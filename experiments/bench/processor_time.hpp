#pragma once

#include <ctime>

namespace qddot::bench {

// Adds the processor time [s] of this thread from construction to destruction, also after an
// exception. It is the wall time if nothing else runs. Time of other processes does not count; else
// it would be added to long runs alone.
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
