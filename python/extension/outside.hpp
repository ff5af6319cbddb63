#pragma once

#include <exception>
#include <functional>
#include <pybind11/pybind11.h>
#include <stop_token>

#include "qddot/measure/motion/interruption.hpp"

namespace qddot::python {

// While this lives, forces and factorisations of this thread use `count` threads.
class Threads {
 public:
  explicit Threads(int count);
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

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

}  // namespace qddot::python
