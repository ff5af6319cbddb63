#include "qddot/measure/motion/timing.hpp"

#include <cmath>
#include <ctime>

#include <fmt/format.h>

namespace qddot::inline measure {

std::chrono::steady_clock::time_point processor_time() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return std::chrono::steady_clock::time_point(std::chrono::seconds(t.tv_sec) +
                                               std::chrono::nanoseconds(t.tv_nsec));
}

std::string duration_in_words(double seconds) {
  constexpr double minute = 60, hour = 60 * minute, day = 24 * hour, year = 365.25 * day;
  if (std::isinf(seconds)) return "an infinite time";
  if (seconds < 99.5) return fmt::format("{:.2g} s", seconds);
  if (seconds < 2 * minute) return fmt::format("{:.0f} s", seconds);
  if (seconds < 2 * hour) return fmt::format("{:.2g} minutes", seconds / minute);
  if (seconds < 2 * day) return fmt::format("{:.2g} hours", seconds / hour);
  if (seconds < 2 * year) return fmt::format("{:.3g} days", seconds / day);
  return fmt::format("{:.2g} years", seconds / year);
}

}  // namespace qddot::inline measure
