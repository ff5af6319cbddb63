#include "python/extension/outside.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <omp.h>
#include <utility>

namespace qddot::python {
namespace {

namespace py = pybind11;

// What the handler of SIGINT wakes, and the one that it stands before. A handler may touch no more.
std::atomic<sem_t*> woken = nullptr;
struct sigaction pythons {};

void on_interrupt(int signal) {
  const int error = errno;
  if (sem_t* semaphore = woken.load()) sem_post(semaphore);
  pythons.sa_handler(signal);
  errno = error;
}

// Whether Python's own handler answers SIGINT, so that it can be called by another.
bool is_handled(const struct sigaction& action) {
  return !(action.sa_flags & SA_SIGINFO) && action.sa_handler != SIG_DFL &&
         action.sa_handler != SIG_IGN;
}

bool is_main_thread() {
  const auto threading = py::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

thread_local std::exception_ptr* raised = nullptr;

}  // namespace

ControlC::ControlC() {
  if (!is_main_thread()) return;
  struct sigaction now {};
  outer_ = woken.load();
  if (!outer_) {
    if (sigaction(SIGINT, nullptr, &now) != 0 || !is_handled(now)) return;
    pythons = now;
  }
  watches_ = true;
  sem_init(&came_, 0, 0);
  watcher_ = std::jthread([this](const std::stop_token& over) {
    while (sem_wait(&came_) != 0) {
    }
    if (!over.stop_requested()) source_.request_stop();
  });
  woken = &came_;
  if (outer_) return;
  now.sa_handler = on_interrupt;
  sigaction(SIGINT, &now, nullptr);
}

ControlC::~ControlC() {
  if (!watches_) return;
  if (!outer_) sigaction(SIGINT, &pythons, nullptr);
  woken = outer_;
  watcher_.request_stop();
  sem_post(&came_);
  watcher_.join();
  sem_destroy(&came_);
}

void ControlC::raise_what_came() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
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
