#pragma once

#include <stop_token>

namespace qddot::python {

// While this lives, Ctrl-C asks for a stop, if it is made in Python's main thread, which is the one
// that Python answers signals in. The signal goes on to Python, which raises KeyboardInterrupt
// where raise_what_came() is called. One within another's life stands before it.
class ControlC {
 public:
  ControlC();  // holds the GIL
  ~ControlC();
  ControlC(const ControlC&) = delete;
  ControlC& operator=(const ControlC&) = delete;

  const std::stop_source& source() const { return source_; }
  std::stop_token stop() const { return source_.get_token(); }
  // A process that was forked has to begin anew.
  static void begin_anew();
  // Throws what Python's handlers of signals raise; holds the GIL.
  static void raise_what_came();

 private:
  friend class Watcher;

  bool is_watched_ = false;
  std::stop_source source_;
  ControlC* outer_ = nullptr;  // may be none
};

}  // namespace qddot::python
