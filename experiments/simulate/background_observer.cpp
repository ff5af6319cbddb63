#include "experiments/simulate/background_observer.hpp"

#include <utility>

namespace qddot::simulate {
namespace {

// The numbers in the states of a batch: so many that waking the thread costs little beside copying,
// so few that they stay in the cache.
constexpr Index batch_size = 1 << 15;

}  // namespace

BackgroundObserver::BackgroundObserver(std::function<void(const State&)> look)
    : look_(std::move(look)), thread_([this] { run(); }) {}

BackgroundObserver::~BackgroundObserver() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundObserver::see(const State& state) {
  if (gathered_.count == gathered_.states.size()) gathered_.states.emplace_back();
  gathered_.states[gathered_.count++] = state;
  size_ += 2 * state.q.size() + 1;
  if (size_ >= batch_size) hand_over();
}

void BackgroundObserver::finish() {
  hand_over();
  std::unique_lock lock(mutex_);
  wait(lock);
}

void BackgroundObserver::hand_over() {
  {
    std::unique_lock lock(mutex_);
    wait(lock);
    std::swap(gathered_, at_hand_);
  }
  changed_.notify_all();
  size_ = 0;
}

void BackgroundObserver::wait(std::unique_lock<std::mutex>& lock) {
  changed_.wait(lock, [this] { return at_hand_.count == 0; });
  if (error_) std::rethrow_exception(error_);
}

void BackgroundObserver::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return is_over_ || at_hand_.count > 0; });
    if (is_over_) return;
    lock.unlock();
    std::exception_ptr error;
    try {
      for (std::size_t i = 0; i < at_hand_.count; ++i) look_(at_hand_.states[i]);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    error_ = error;
    at_hand_.count = 0;
    changed_.notify_all();
  }
}

}  // namespace qddot::simulate
