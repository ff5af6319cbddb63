#include "python/extension/outside.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <omp.h>
#include <optional>
#include <pthread.h>
#include <set>
#include <stdexcept>
#include <thread>
#include <unistd.h>
#include <utility>

#include "python/extension/control_c.hpp"

namespace qddot::python {
namespace {

namespace py = pybind11;

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

}  // namespace

void prepare_for_forks() {
  pthread_atfork(nullptr, nullptr, [] {
    ControlC::begin_anew();
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
