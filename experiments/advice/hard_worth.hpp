#pragma once

#include <string>
#include <vector>

#include "experiments/advice/hard_result.hpp"
#include "experiments/advice/worth.hpp"

namespace qddot::judged_advice {

// How often answers hold and are refused: for all, for each kind of accuracy and of motion.
std::vector<Figure> worth_of(const std::vector<HardResult>& results);

// The figures as a table with a line for each of Figure::of.
std::string in_columns(const std::vector<Figure>& figures);

// A line for each failure: a false bar or accuracy, a refusal of what is possible, a claim that
// rounding makes impossible. With `of_all` a line for every case.
std::vector<std::string> lines_of(const std::vector<HardResult>& results, bool of_all);

}  // namespace qddot::judged_advice
