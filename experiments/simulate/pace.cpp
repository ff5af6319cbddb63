#include "experiments/simulate/pace.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "experiments/kit/progress.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::simulate {
namespace {

constexpr double worth_a_word = 60;  // [s]
constexpr std::array looks = {1., 3., 9., 27.};
// A run without a first step after this long [s] is said to be one.
constexpr double longest_silence = 9;
// A terminal's line is written after a second, and again after each such part of the time, but at
// most every second. The thread wakes for microseconds each time.
constexpr double first_look = 1, look_again = 0.01;

// A sentence on the time that a run will take in all. It reached the time `t` of `until` [s] in
// `seconds` of wall time. Empty if that is a minute or less.
std::string pace_in_words(double t, double until, double seconds) {
  if (!(t > 0)) {
    return seconds < longest_silence ? ""
                                     : fmt::format("no step has ended after {:.2g} s", seconds);
  }
  const double whole = seconds * (until / t);
  if (whole <= worth_a_word) return "";
  return fmt::format("t = {:.3g} of {:g} s is reached after {:.2g} s: the run will take about {}",
                     t, until, seconds, duration_in_words(whole));
}

}  // namespace

Pace::Pace(const Simulation& run, double until)
    : run_(run), until_(until), watcher_([this](const std::stop_token& over) {
        if (progress().form() == Progress::Form::line) follow(over);
        if (progress().form() == Progress::Form::plain) say_once(over);
      }) {}

Pace::~Pace() {
  watcher_.request_stop();
  watcher_.join();
  progress().wipe();
}

bool Pace::sleep_until(double seconds, const std::stop_token& over) {
  std::unique_lock lock(mutex_);
  wake_.wait_until(lock, over,
                   start_ + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                std::chrono::duration<double>(seconds)),
                   [] { return false; });
  return !over.stop_requested();
}

void Pace::say_once(const std::stop_token& over) {
  for (const double look : looks) {
    if (!sleep_until(look, over)) return;
    const std::string words = pace_in_words(run_.reached(), until_, seconds_since(start_));
    if (words.empty()) continue;
    fmt::print(stderr, "simulate: {}\n", words);
    return;
  }
}

void Pace::follow(const std::stop_token& over) {
  for (double look = first_look; sleep_until(look, over);
       look += std::max(first_look, look_again * look)) {
    const double t = run_.reached(), seconds = seconds_since(start_);
    if (t > 0) progress().left_about(seconds * (until_ / t - 1));
    progress().stage(fmt::format("t = {:.3g} of {:g} s", t, until_));
  }
}

}  // namespace qddot::simulate
