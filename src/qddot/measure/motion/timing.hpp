#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace qddot::inline measure {

// Wall time [s] since `start`.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The wall time of work() [s].
template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
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

}  // namespace qddot::inline measure
