#pragma once

#include <ctime>

namespace qddot::bench {

// The time [s] that work() takes of this thread's processor. With nothing else on the machine it is
// the wall time; where others take turns it leaves theirs out, which would count long runs alone.
template <class Work>
double processor_seconds_of(const Work& work) {
  const auto now = [] {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

}  // namespace qddot::bench
