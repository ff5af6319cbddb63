#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace qddot::command {

// How far a program is.
struct ProgressState {
  std::string program;
  std::size_t number = 0, pieces = 0;  // of the piece at hand; 0: none is
  std::string what{};                  // is done now, or has been
  double elapsed = 0;                  // [s]
  // What is left [s], if anything can be said of it: at most so long, or about.
  std::optional<double> left{};
  bool is_bound = true;
};

// A duration [s] as clocks show it, in whole seconds, 1:03 or 2:01:03; the next one where it is
// `at_most` so long.
std::string clock_words(double seconds, bool at_most = false);

// The text without control characters and what is no UTF-8, cut to so many columns of a terminal.
std::string in_columns(const std::string& text, std::size_t columns);

// The state in one line of at most so many columns, "work_precision 12/56  verlet h = 0.0005
// 1:03, at most 2:10 left". Where they are few, what is done now is cut first; the program's name
// goes next.
std::string progress_in_words(const ProgressState& state, std::size_t columns);

}  // namespace qddot::command
