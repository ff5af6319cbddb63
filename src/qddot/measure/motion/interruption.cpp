#include "qddot/measure/motion/interruption.hpp"

#include <atomic>
#include <mutex>
#include <utility>

namespace qddot::inline measure {
namespace {

struct Shared {
  std::stop_source source;
  std::mutex mutex;  // guards `why`
  std::optional<Interruption> why;
  std::atomic<bool> is_noticed = false;
};

Shared& shared() {
  static Shared all;
  return all;
}

thread_local OwnInterruption* innermost = nullptr;

}  // namespace

void interrupt(const Interruption& why) {
  {
    const std::lock_guard lock(shared().mutex);
    shared().why = why;
  }
  shared().source.request_stop();
}

std::stop_token interruption() {
  return innermost ? innermost->stop() : shared().source.get_token();
}

std::optional<Interruption> interrupted() {
  if (innermost)
    return innermost->stop().stop_requested() ? std::optional(innermost->why()) : std::nullopt;
  if (!shared().source.stop_requested()) return {};
  shared().is_noticed = true;
  const std::lock_guard lock(shared().mutex);
  return shared().why;
}

void stop_if_interrupted() {
  if (const auto why = interrupted()) throw Interrupted(*why);
}

bool is_interruption_noticed() { return shared().is_noticed; }

OwnInterruption::OwnInterruption(std::stop_token stop, Interruption why)
    : stop_(std::move(stop)), why_(std::move(why)), outer_(std::exchange(innermost, this)) {}

OwnInterruption::~OwnInterruption() { innermost = outer_; }

}  // namespace qddot::inline measure
