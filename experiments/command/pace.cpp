#include "experiments/command/pace.hpp"

#include <array>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "qddot/measure/motion/duration.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::command {

using namespace measure;
namespace {

constexpr double worth_a_word = 60;  // [s]
constexpr std::array looks = {1., 3., 9., 27.};
// A run without a first step after this long [s] is said to be one.
constexpr double patience = 9;

}  // namespace

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
    : watcher_(
          [this, program = std::move(program), &integrator, until](const std::stop_token& over) {
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

}  // namespace qddot::command
