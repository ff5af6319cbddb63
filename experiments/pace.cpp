#include "experiments/pace.hpp"

#include <array>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "experiments/timing.hpp"

namespace qddot {
namespace {

constexpr double worth_a_word = 60;  // [s]
constexpr std::array looks = {1., 3., 9., 27.};
// A run without a first step after this long [s] is said to be one.
constexpr double patience = 9;

}  // namespace

std::string duration_in_words(double seconds) {
  constexpr double minute = 60, hour = 60 * minute, day = 24 * hour, year = 365.25 * day;
  if (seconds < 2 * minute) return fmt::format("{:.2g} s", seconds);
  if (seconds < 2 * hour) return fmt::format("{:.2g} minutes", seconds / minute);
  if (seconds < 2 * day) return fmt::format("{:.2g} hours", seconds / hour);
  if (seconds < 2 * year) return fmt::format("{:.3g} days", seconds / day);
  return fmt::format("{:.2g} years", seconds / year);
}

std::string pace_in_words(double t, double until, double seconds) {
  if (!(t > 0)) {
    return seconds < patience ? "" : fmt::format("no step has ended after {:.2g} s", seconds);
  }
  const double whole = seconds * (until / t);
  if (whole <= worth_a_word) return "";
  return fmt::format("t = {:.3g} of {:g} s is reached after {:.2g} s: the run will take about {}",
                     t, until, seconds, duration_in_words(whole));
}

Pace::Pace(std::string program, const Integrator& integrator, double until)
    : watcher_([this, program = std::move(program), &integrator, until](std::stop_token over) {
        const auto start = std::chrono::steady_clock::now();
        for (const double look : looks) {
          std::unique_lock lock(mutex_);
          wake_.wait_until(lock, over,
                           start + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                       std::chrono::duration<double>(look)),
                           [] { return false; });
          if (over.stop_requested()) return;
          const std::string words =
              pace_in_words(integrator.reached(), until, seconds_since(start));
          if (words.empty()) continue;
          fmt::print(stderr, "{}: {}\n", program, words);
          return;
        }
      }) {}

}  // namespace qddot
