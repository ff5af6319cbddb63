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

}  // namespace qddot::inline kit
