#include "python/extension/outside.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <new>
#include <omp.h>
#include <optional>
#include <pthread.h>
#include <semaphore.h>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

namespace qddot::python {
namespace {

namespace py = pybind11;

// Whether Python's own handler answers SIGINT, so that it can be called by another.
bool is_handled(const struct sigaction& action) {
  return !(action.sa_flags & SA_SIGINFO) && action.sa_handler != SIG_DFL &&
         action.sa_handler != SIG_IGN;
}

bool is_main_thread() {
  const auto threading = py::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

}  // namespace

// The thread that a handler of SIGINT wakes, as that itself may call next to nothing. There is one
// a process, and it never ends: to start one takes as long as a short run.
class Watcher {
 public:
  static Watcher& here() {
    // A process that was forked has no such thread.
    [[maybe_unused]] static const int once =
        pthread_atfork(nullptr, nullptr, [] { only = nullptr; });
    if (!only) only = new Watcher;
    return *only.load();
  }

  // A process that was forked has no such thread.
  static void forget() { only = nullptr; }

  // Which one is stopped from now on; may be none. What came before stops nothing any more.
  void watch(ControlC* run) {
    const std::lock_guard lock(mutex_);
    run_ = run;
    has_come_ = false;
  }
  ControlC* watched() const { return run_; }

  // Takes the place of Python's handler, or gives it back.
  void stand_before(const struct sigaction& action) {
    pythons = action;
    struct sigaction own = action;
    own.sa_handler = [](int signal) {
      const int error = errno;
      if (Watcher* watcher = only.load()) {  // none in a process that was forked meanwhile
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

void ControlC::raise_what_came() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

namespace {

thread_local std::exception_ptr* raised = nullptr;

// All work that goes on outside Python.
class Work {
 public:
  // Throws std::runtime_error where the interpreter is about to exit.
  explicit Work(const std::stop_source& source) : source_(source) {
    const std::lock_guard lock(mutex);
    if (is_closed) throw std::runtime_error("the interpreter exits, and no more work begins");
    going_on.insert(this);
  }
  ~Work() {
    const std::lock_guard lock(mutex);
    going_on.erase(this);
    one_less.notify_all();
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  // A process that was forked has none of the other threads, which may have held the lock.
  static void forget() {
    new (&mutex) std::mutex;
    going_on.clear();
  }

  // Waits some seconds for all of it.
  static void end_all() {
    std::unique_lock lock(mutex);
    is_closed = true;
    for (Work* work : going_on) work->source_.request_stop();
    one_less.wait_for(lock, std::chrono::seconds(10), [] { return going_on.empty(); });
  }

 private:
  static inline std::mutex mutex;
  static inline std::condition_variable one_less;
  static inline std::set<Work*> going_on;
  static inline bool is_closed = false;

  std::stop_source source_;
};

}  // namespace

void prepare_for_forks() {
  pthread_atfork(nullptr, nullptr, [] {
    Watcher::forget();
    Work::forget();
  });
}

void close_outside() {
  const py::gil_scoped_release released;
  Work::end_all();
}

void inside_python(const std::function<void()>& work) {
  std::exception_ptr* const outer = std::exchange(raised, nullptr);
  try {
    work();
  } catch (...) {
    raised = outer;
    throw;
  }
  raised = outer;
}

Threads::Threads(int count) : before_(omp_get_max_threads()) { omp_set_num_threads(count); }
Threads::~Threads() { omp_set_num_threads(before_); }

void remember(std::exception_ptr thrown) {
  if (raised && !*raised) *raised = std::move(thrown);
}

void outside(int threads, const std::function<void(std::stop_token)>& work) {
  std::exception_ptr thrown;
  {
    const ControlC control_c;
    const Threads some(threads);
    std::optional<Work> going_on(control_c.source());
    std::exception_ptr* const outer = std::exchange(raised, &thrown);
    {
      const py::gil_scoped_release released;
      const measure::OwnInterruption own(control_c.stop(), {"SIGINT", 130});
      try {
        work(control_c.stop());
      } catch (...) {
        if (!thrown) thrown = std::current_exception();
      }
    }
    raised = outer;
    going_on.reset();
  }
  try {
    if (thrown) std::rethrow_exception(std::exchange(thrown, nullptr));
  } catch (const py::error_already_set&) {
    throw;
  } catch (const measure::Interrupted&) {
    ControlC::raise_what_came();
    // A handler of the user's own that raises nothing cannot have the work back.
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  } catch (...) {  // which may be what an interrupted run came to
    ControlC::raise_what_came();
    throw;
  }
  ControlC::raise_what_came();
}

}  // namespace qddot::python
