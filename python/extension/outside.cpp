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
#include <pybind11/pybind11.h>
#include <semaphore.h>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <unistd.h>
#include <utility>

namespace qddot::python {
namespace {

namespace py = pybind11;

// While this lives, Ctrl-C requests a stop, if it was made in Python's main thread: Python handles
// signals only there. Python gets the signal too and raises KeyboardInterrupt in raise_what_came().
// An inner ControlC replaces the outer one while it lives.
class ControlC {
 public:
  ControlC();  // needs the GIL
  ~ControlC();
  ControlC(const ControlC&) = delete;
  ControlC& operator=(const ControlC&) = delete;

  const std::stop_source& source() const { return source_; }
  std::stop_token stop() const { return source_.get_token(); }
  // Throws the exceptions of Python's signal handlers; needs the GIL.
  static void raise_what_came();

 private:
  friend class Watcher;

  bool is_watched_ = false;
  std::stop_source source_;
  ControlC* outer_ = nullptr;  // the one that this one replaces
};

// Whether Python's own handler answers SIGINT, so that another handler can call it.
bool is_handled(const struct sigaction& action) {
  return !(action.sa_flags & SA_SIGINFO) && action.sa_handler != SIG_DFL &&
         action.sa_handler != SIG_IGN;
}

bool is_main_thread() {
  const auto threading = py::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

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

void ControlC::raise_what_came() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

thread_local std::exception_ptr* raised = nullptr;

// All work outside Python. Once the interpreter exits, threads that work, or are about to, never
// return to Python: an exception there would be printed while the interpreter is taken apart.
class Work {
 public:
  // Needs the GIL. Throws std::runtime_error in the thread that ends the interpreter.
  explicit Work(const std::stop_source& source) : source_(source) {
    {
      const std::lock_guard lock(mutex);
      if (!is_closed) {
        going_on.insert(this);
        return;
      }
    }
    if (thread_ == closer)
      throw std::runtime_error("the interpreter exits, and no more work begins");
    const py::gil_scoped_release released;
    wait_for_exit();
  }
  ~Work() {
    const std::lock_guard lock(mutex);
    going_on.erase(this);
    one_less.notify_all();
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  // To be called without the GIL. Does not return if the interpreter exits.
  void stay_if_closed() {
    {
      const std::lock_guard lock(mutex);
      if (!is_closed || thread_ == closer) return;
      std::erase_if(going_on, [&](const Work* work) { return work->thread_ == thread_; });
      one_less.notify_all();
    }
    wait_for_exit();
  }

  // A forked process has no other threads, one of which may have held the lock.
  static void forget() {
    new (&mutex) std::mutex;
    going_on.clear();
  }

  // Waits some seconds until all work has ended.
  static void end_all() {
    std::unique_lock lock(mutex);
    is_closed = true;
    closer = std::this_thread::get_id();
    for (Work* work : going_on) work->source_.request_stop();
    one_less.wait_for(lock, std::chrono::seconds(10), [] { return going_on.empty(); });
  }

 private:
  [[noreturn]] static void wait_for_exit() {
    for (;;) pause();
  }

  static inline std::mutex mutex;
  static inline std::condition_variable one_less;
  static inline std::set<Work*> going_on;
  static inline bool is_closed = false;
  static inline std::thread::id closer;

  std::stop_source source_;
  std::thread::id thread_ = std::this_thread::get_id();
};

// While this lives, forces and factorisations of this thread use `count` threads.
class Threads {
 public:
  explicit Threads(int count) : before_(omp_get_max_threads()) { omp_set_num_threads(count); }
  ~Threads() { omp_set_num_threads(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
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
      going_on->stay_if_closed();
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
    // The work was stopped, even if the user's own handler of SIGINT raises nothing.
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  } catch (...) {  // perhaps the failure of an interrupted run
    ControlC::raise_what_came();
    throw;
  }
  ControlC::raise_what_came();
}

}  // namespace qddot::python
