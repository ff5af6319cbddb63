#pragma once

#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "experiments/command/progress_words.hpp"

namespace qddot::command {

// Says on stderr how far a program is and how long the rest takes at most: on one line of a
// terminal that is written over, or in a plain line now and then. Speaks only when it is told
// something, between runs that are timed: it has no thread that would wake in them. What comes
// faster than ten times a second is left out. Thread-safe.
class Progress {
 public:
  enum class Form { line, plain, none };

  // Where it speaks, and by which clock.
  struct Screen {
    std::function<double()> now;  // [s]
    std::function<std::size_t()> columns;
    std::function<void(std::string_view)> write;
  };
  // stderr, by the steady clock.
  static Screen standard_error();

  // A plain line says at least so many seconds after the one before that a piece is done.
  static constexpr double plain_pause = 30;
  // A bound that is more than so many times what the slowest piece so far makes of the rest helps
  // nobody, and is not said.
  static constexpr double loosest_bound = 8;

  // Says nothing until it is started.
  explicit Progress(Screen screen = standard_error()) : screen_(std::move(screen)) {}
  // From now on time counts. The first plain line comes `quiet` seconds later at the soonest.
  void start(const std::string& program, Form form, double quiet = 0);

  // What is done before, between or after pieces: no number of it is said.
  void stage(const std::string& what);
  // So many pieces are to come.
  void begin(std::size_t pieces);
  // What is measured next, of the first piece that is not done.
  void now_at(const std::string& what);
  // A piece is done, kept from before or not.
  void finish(const std::string& what);
  // All that is left takes at most so many seconds; nothing where none can be said.
  void left_at_most(std::optional<double> seconds);
  // All that is left takes about so long.
  void left_about(double seconds);

  // Takes the line away, before anything else is written to the terminal.
  void wipe();
  // The same, and says nothing any more.
  void close();
  Form form() const;
  // The time on its clock [s].
  double now() const { return screen_.now(); }

 private:
  std::optional<double> left_now(double now) const;
  void show();
  void say();
  void clear();

  mutable std::mutex mutex_;
  Screen screen_;
  Form form_ = Form::none;
  ProgressState state_{};
  std::size_t done_ = 0;
  double begun_ = 0, last_finish_ = 0, slowest_ = 0;  // [s]
  double last_line_ = -std::numeric_limits<double>::infinity(), next_plain_ = 0;
  std::optional<double> over_by_{};  // on the clock
  bool is_visible_ = false;
};

// That of this process.
Progress& progress();

// Starts it in the form `auto`, plain or none: auto is the line where stderr is a terminal, else
// plain lines from the thirtieth second on. TERM=dumb is no terminal. Throws InvalidInput for
// another word.
void start_progress(const std::string& program, const std::string& form);

}  // namespace qddot::command
