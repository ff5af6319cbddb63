#include "qddot/measure/motion/deadline.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/measure/motion/timing.hpp"

namespace qddot::inline measure {
namespace {

using Duration = std::chrono::duration<double>;

// Waits are no longer than a clock can count.
constexpr double longest_sleep = 1e6;  // [s]

std::chrono::steady_clock::time_point wall_time_after(double seconds) {
  return std::chrono::steady_clock::now() +
         std::chrono::duration_cast<std::chrono::steady_clock::duration>(
             Duration(std::min(seconds, longest_sleep)));
}

}  // namespace

void Alarm::set(const std::stop_source& source, double seconds) {
  bool is_earlier = false;
  {
    const std::lock_guard lock(mutex_);
    waiting_ = source;
    begin_ = clock_now();
    seconds_ = seconds;
    is_earlier = wall_time_after(seconds) < wakes_;
    is_hurried_ |= is_earlier;
  }
  if (!watcher_.joinable()) {
    watcher_ = std::jthread([this](const std::stop_token& ended) { watch(ended); });
  } else if (is_earlier) {
    wake_.notify_one();
  }
}

void Alarm::clear() {
  const std::lock_guard lock(mutex_);
  waiting_.reset();
}

void Alarm::watch(const std::stop_token& ended) {
  std::unique_lock lock(mutex_);
  while (!ended.stop_requested()) {
    const double left = waiting_ ? seconds_ - seconds_since(begin_) : longest_sleep;
    if (waiting_ && !(left > 0)) {
      waiting_->request_stop();
      waiting_.reset();
      continue;
    }
    wakes_ = wall_time_after(left);
    wake_.wait_until(lock, ended, wakes_, [this] { return is_hurried_; });
    is_hurried_ = false;
  }
}

Deadline::Deadline(double seconds) { set(seconds, nullptr); }

Deadline::Deadline(double seconds, Alarm& alarm) { set(seconds, &alarm); }

Deadline::~Deadline() {
  if (alarm_) alarm_->clear();
}

void Deadline::set(double seconds, Alarm* alarm) {
  if (!(seconds > 0)) source_.request_stop();
  if (!(seconds > 0) || std::isinf(seconds)) return;
  if (!alarm) own_ = std::make_unique<Alarm>();
  alarm_ = alarm ? alarm : own_.get();
  alarm_->set(source_, seconds);
}

}  // namespace qddot::inline measure
