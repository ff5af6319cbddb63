#include "python/extension/control_c.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <pybind11/pybind11.h>
#include <semaphore.h>
#include <thread>

namespace qddot::python {
namespace {

namespace py = pybind11;

// Whether Python's own handler answers SIGINT, so that another handler can call it.
bool is_handled(const struct sigaction& action) {
  return !(action.sa_flags & SA_SIGINFO) && action.sa_handler != SIG_DFL &&
         action.sa_handler != SIG_IGN;
}

bool is_main_thread() {
  const auto threading = py::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

}  // namespace

// The thread that the handler of SIGINT wakes, since a handler itself may call almost nothing. Each
// process has one, which never ends: starting a thread takes as long as a short run.
class Watcher {
 public:
  static Watcher& here() {
    if (!only) only = new Watcher;
    return *only.load();
  }

  // A forked process does not have the thread.
  static void forget() { only = nullptr; }

  // Sets the run that is stopped from now on, or nullptr. Earlier signals stop nothing any more.
  void watch(ControlC* run) {
    const std::lock_guard lock(mutex_);
    run_ = run;
    has_come_ = false;
  }
  ControlC* watched() const { return run_; }

  // Replaces Python's handler, or restores it.
  void stand_before(const struct sigaction& action) {
    pythons = action;
    struct sigaction own = action;
    own.sa_handler = [](int signal) {
      const int error = errno;
      if (Watcher* watcher = only.load()) {  // nullptr in a forked process
        watcher->has_come_ = true;
        sem_post(&watcher->wake_);
      }
      pythons.sa_handler(signal);
      errno = error;
    };
    sigaction(SIGINT, &own, nullptr);
  }
  static void stand_back() { sigaction(SIGINT, &pythons, nullptr); }

 private:
  Watcher() {
    sem_init(&wake_, 0, 0);
    std::thread([this] {
      for (;;) {
        while (sem_wait(&wake_) != 0) {
        }
        const std::lock_guard lock(mutex_);
        if (has_come_.exchange(false) && run_) run_->source_.request_stop();
      }
    }).detach();
  }

  static inline std::atomic<Watcher*> only = nullptr;
  static inline struct sigaction pythons {};

  std::mutex mutex_;
  ControlC* run_ = nullptr;
  std::atomic<bool> has_come_ = false;
  sem_t wake_{};
};

ControlC::ControlC() {
  if (!is_main_thread()) return;
  Watcher& watcher = Watcher::here();
  outer_ = watcher.watched();
  struct sigaction now {};
  if (!outer_ && (sigaction(SIGINT, nullptr, &now) != 0 || !is_handled(now))) return;
  is_watched_ = true;
  watcher.watch(this);
  if (!outer_) watcher.stand_before(now);
}

ControlC::~ControlC() {
  if (!is_watched_) return;
  if (!outer_) Watcher::stand_back();
  Watcher::here().watch(outer_);
}

void ControlC::begin_anew() { Watcher::forget(); }

void ControlC::raise_what_came() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace qddot::python
