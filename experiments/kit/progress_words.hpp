#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace qddot::inline kit {

// How far a program is.
struct ProgressState {
  std::string program;
  std::size_t number = 0, pieces = 0;  // of the present piece; 0: there is none
  std::string what{};                  // the present work, or the last
  double elapsed = 0;                  // [s]
  // Remaining time [s], if known: an upper bound, or an estimate.
  std::optional<double> left{};
  bool is_bound = true;
};

// A duration [s] in whole seconds as a clock shows it, 1:03 or 2:01:03; rounded up if `at_most`.
std::string clock_words(double seconds, bool at_most = false);

// The text without control characters and invalid UTF-8, cut to `columns` of a terminal.
std::string in_columns(const std::string& text, std::size_t columns);

// The state in one line of at most so many columns, "work_precision 12/56  verlet h = 0.0005
// 1:03, at most 2:10 left". Where they are few, what is done now is cut first; the program's name
// goes next.
std::string progress_in_words(const ProgressState& state, std::size_t columns);

}  // namespace qddot::inline kit
