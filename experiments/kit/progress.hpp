#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace qddot::inline kit {

// How far a program is.
struct ProgressState {
  std::string program;
  std::size_t number = 0, pieces = 0;  // of the present piece; 0: there is none
  std::string what{};                  // the present work, or the last
  double elapsed = 0;                  // [s]
  std::optional<double> left{};        // an estimate of the remaining time [s]
};

// A duration [s] in whole seconds as a clock shows it, 1:03 or 2:01:03.
std::string clock_words(double seconds);

// The text without control characters and invalid UTF-8, cut to `columns` of a terminal.
std::string in_columns(const std::string& text, std::size_t columns);

// The state in one line of at most so many columns, "work_precision 12/56  verlet h = 0.0005
// 1:03, about 2:09 left". Where they are few, what is done now is cut first; the program's name
// goes next.
std::string progress_in_words(const ProgressState& state, std::size_t columns);

// Reports on stderr how far a program is, with an estimate of the remaining time. It updates one
// line of a terminal, or writes a plain line now and then. It writes only when one of its functions
// is called, between timed runs: it has no thread that could disturb them. It shows at most ten
// reports a second. Thread-safe.
class Progress {
 public:
  enum class Form { line, plain, none };

  // Its output and its clock.
  struct Screen {
    std::function<double()> now;  // [s]
    std::function<std::size_t()> columns;
    std::function<void(std::string_view)> write;
  };
  // stderr, by the steady clock.
  static Screen standard_error();

  // The least time [s] between two plain lines.
  static constexpr double plain_pause = 30;
  // A piece that takes less time [s] was kept from before, and says nothing of those to come.
  static constexpr double kept = 1e-3;

  // Is silent until start().
  explicit Progress(Screen screen = standard_error()) : screen_(std::move(screen)) {}
  // Starts the clock. The first plain line comes after `quiet` seconds or later.
  void start(const std::string& program, Form form, double quiet = 0);

  // Names the work before, between or after pieces, which has no number.
  void stage(const std::string& what);
  // Sets the number of pieces to come.
  void begin(std::size_t pieces);
  // Names the work on the first piece that is not finished.
  void now_at(const std::string& what);
  // Counts a finished piece, measured now or kept from before. The pieces to come are estimated to
  // take as long, on average, as those that were measured.
  void finish(const std::string& what);
  // Sets the estimate of the remaining time [s].
  void left_about(double seconds);

  // Removes the line, before anything else is written to the terminal.
  void wipe();
  // The same, and is silent from now on.
  void close();
  Form form() const;
  // The time on its clock [s].
  double now() const { return screen_.now(); }

 private:
  void estimate(double now);
  void show();
  void say();
  void clear();

  mutable std::mutex mutex_;
  Screen screen_;
  Form form_ = Form::none;
  ProgressState state_{};
  std::size_t done_ = 0;
  double begun_ = 0, last_finish_ = 0, measured_ = 0;  // [s]; measured_: by pieces, in all
  std::size_t measured_pieces_ = 0;
  double last_line_ = -std::numeric_limits<double>::infinity(), next_plain_ = 0;
  std::optional<double> over_by_{};  // on the clock
  bool is_visible_ = false;
};

// The progress of this process.
Progress& progress();

// Starts it in the form auto, plain or none. auto is the updated line if stderr is a terminal, else
// plain lines from the thirtieth second on. TERM=dumb is no terminal. Throws InvalidInput for
// another word.
void start_progress(const std::string& program, const std::string& form);

}  // namespace qddot::inline kit
