#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

namespace qddot::inline measure {

// The clock that measurements and their limits go by: that of the wall, unless another is set, as
// the processor's.
inline std::atomic<std::chrono::steady_clock::time_point (*)()> clock_in_use =
    std::chrono::steady_clock::now;
// The processor's time for this process, which stands still while other programs run.
std::chrono::steady_clock::time_point processor_time();
// The time on the clock in use.
inline std::chrono::steady_clock::time_point clock_now() { return clock_in_use.load()(); }

// The time [s] since `start`.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(clock_now() - start).count();
}

// The time that work() takes [s].
template <class Work>
double seconds_of(const Work& work) {
  const auto start = clock_now();
  work();
  return seconds_since(start);
}

// The least wall time [s] of one call of work(): its time without disturbances. It is the least of
// passes of a millisecond or more, which take `seconds` together.
template <class Work>
double least_seconds(double seconds, const Work& work) {
  constexpr double pass_length = 1e-3;
  double least = seconds_of(work);
  const int calls = static_cast<int>(std::ceil(std::clamp(pass_length / least, 1., 1e6)));
  for (double spent = 0; spent < seconds;) {
    const double pass = seconds_of([&] {
      for (int i = 0; i < calls; ++i) work();
    });
    least = std::min(least, pass / calls);
    spent += pass;
  }
  return least;
}

// The median of at least one value; for an even number, the mean of the middle two.
inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

// A duration [s] in words, from "5.2 s" to "3.1e+05 years" and "an infinite time".
std::string duration_in_words(double seconds);

}  // namespace qddot::inline measure
