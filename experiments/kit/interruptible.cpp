#include "experiments/kit/interruptible.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <poll.h>
#include <unistd.h>

#include <fmt/format.h>

#include "experiments/kit/progress.hpp"
#include "experiments/kit/whole_file.hpp"

namespace qddot::inline kit {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double never = std::numeric_limits<double>::infinity();
constexpr int status_of_signal = 130, status_of_limit = 3;
// Bytes in the pipe to the watcher that are no numbers of signals.
constexpr char wake = 0, finish = 127;

struct Shared {
  std::array<int, 2> pipe{-1, -1};
  std::mutex mutex;                    // of what follows
  double limit = never, patience = 0;  // [s], the limit on the clock
  std::atomic<bool> is_over = false;   // nobody is waited for any more
};

Shared& shared() {
  static Shared all;
  return all;
}

double now() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

// A signal handler may do no more.
void tell(char what) {
  const int error = errno;
  if (::write(shared().pipe[1], &what, 1) != 1) std::_Exit(status_of_signal);
  errno = error;
}

void on_signal(int signal) { tell(static_cast<char>(signal)); }

void catch_signal(int signal) {
  struct sigaction old {};
  sigaction(signal, nullptr, &old);
  if (old.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = on_signal;
  // The next one has its usual effect.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(signal, &action, nullptr);
}

// Waits for a byte of the pipe, up to the time `until` on the clock [s]; nothing where none came.
std::optional<char> next_byte(double until) {
  constexpr double longest = 1e6;  // [s], in milliseconds still an int
  const double left = std::clamp(until - now(), 0.0, longest);
  pollfd waiting{shared().pipe[0], POLLIN, 0};
  if (::poll(&waiting, 1, static_cast<int>(std::ceil(1e3 * left))) <= 0) return {};
  char byte = finish;
  return ::read(shared().pipe[0], &byte, 1) == 1 ? byte : finish;
}

double limit() {
  const std::lock_guard lock(shared().mutex);
  return shared().limit;
}

// Nothing where the program ends by itself.
std::optional<Interruption> wait_for_cause() {
  for (;;) {
    const auto byte = next_byte(limit());
    if (byte == finish) return {};
    if (byte == SIGINT) return Interruption{"SIGINT", status_of_signal};
    if (byte == SIGTERM) return Interruption{"SIGTERM", status_of_signal};
    if (now() >= limit()) return Interruption{"--time-limit", status_of_limit};
  }
}

}  // namespace

void wait_for_answer(double seconds) {
  const std::lock_guard lock(shared().mutex);
  shared().patience = std::max(shared().patience, seconds);
}

Interruptible::Interruptible(std::string program) : program_(std::move(program)) {
  if (::pipe(shared().pipe.data()) != 0) throw std::runtime_error("no pipe can be opened");
  for (const int signal : {SIGINT, SIGTERM}) catch_signal(signal);
  // A file that may not grow any more is a failure to write, which is said.
  std::signal(SIGXFSZ, SIG_IGN);
  watcher_ = std::thread([this] { watch(); });
}

Interruptible::~Interruptible() {
  shared().is_over = true;
  tell(finish);
  watcher_.join();
}

void Interruptible::end_after(double seconds) {
  {
    const std::lock_guard lock(shared().mutex);
    shared().limit = now() + seconds;
  }
  tell(wake);
}

void Interruptible::give_up(const Interruption& why) const {
  remove_unfinished();
  fmt::print(stderr, "{}: interrupted by {} with nothing to be saved\n", program_, why.by);
  std::_Exit(why.status);
}

void Interruptible::watch() {
  const auto why = wait_for_cause();
  if (!why) return;
  double patience = 0;
  {
    const std::lock_guard lock(shared().mutex);
    patience = shared().patience;
  }
  interrupt(*why);
  // Here, as a second signal ends the process before anybody else could.
  progress().close();
  const double answered_by = now() + patience;
  for (;;) {
    const bool is_answered = is_interruption_noticed() || shared().is_over;
    const auto byte = next_byte(is_answered ? never : answered_by);
    if (byte == finish) return;
    // Another signal came, or nobody has answered.
    if (byte || (!is_interruption_noticed() && !shared().is_over && now() >= answered_by))
      give_up(*why);
  }
}

}  // namespace qddot::inline kit
