#pragma once

#include <stop_token>

namespace qddot::python {

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
  // Prepares a forked process.
  static void begin_anew();
  // Throws the exceptions of Python's signal handlers; needs the GIL.
  static void raise_what_came();

 private:
  friend class Watcher;

  bool is_watched_ = false;
  std::stop_source source_;
  ControlC* outer_ = nullptr;  // may be nullptr
};

}  // namespace qddot::python
