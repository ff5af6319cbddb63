#pragma once

#include <exception>
#include <functional>
#include <pybind11/pybind11.h>
#include <stop_token>

#include "qddot/measure/motion/interruption.hpp"

namespace qddot::python {

// While this lives, forces and factorisations take so many threads where this one asks for them.
class Threads {
 public:
  explicit Threads(int count);
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

// Lets forked processes begin anew: to be called once.
void prepare_for_forks();

// Ends all work that goes on outside Python, and waits for it: to be called when the interpreter is
// about to exit, after which nobody gets the GIL back. No more work begins.
void close_outside();

// What a callable raised within outside(), to be raised again at its end even where a library took
// it for a failure of its own.
void remember(std::exception_ptr thrown);

// Lets the work call callables from within Python, with the GIL; what they raise is nobody's but
// the caller's.
void inside_python(const std::function<void()>& work);

// Does the work without the GIL, on so many threads, so that other threads of Python go on. Ctrl-C
// ends it (see OwnInterruption), and is raised then; so is what a callable raised.
void outside(int threads, const std::function<void(std::stop_token)>& work);

}  // namespace qddot::python
