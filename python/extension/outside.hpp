#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <pybind11/pybind11.h>
#include <stop_token>

#include "qddot/measure/motion/interruption.hpp"

namespace qddot::python {

// Lets forked processes start again; must be called once.
void prepare_for_forks();

// Ends all work outside Python and waits for its end; no more work begins. Must be called before
// the interpreter exits, after which no thread gets the GIL back.
void close_outside();

// Stores the exception of a callable within outside(). It is raised again at the end, even if a
// library took it for a failure of its own.
void remember(std::exception_ptr thrown);

// Lets the work call callables from within Python, with the GIL; their exceptions go to the caller.
void inside_python(const std::function<void()>& work);

// Does the work without the GIL, on `threads` threads, so that other threads of Python go on.
// Ctrl-C ends it (see OwnInterruption) and raises KeyboardInterrupt. Exceptions of callables are
// raised too.
void outside(int threads, const std::function<void(std::stop_token)>& work);

// The result of work that is done so, on one thread.
template <class Work>
auto made_outside(const Work& work) {
  std::optional<decltype(work())> made;
  outside(1, [&](const std::stop_token&) { made.emplace(work()); });
  return std::move(*made);
}

}  // namespace qddot::python
