#pragma once

#include <string>
#include <vector>

#include "experiments/advice/case_result.hpp"

namespace qddot::judged_advice {

// A number that says what advice is worth, over so many cases.
struct Figure {
  std::string name, meaning;
  double value = 0;
  int cases = 0;
  std::string of{};  // some of the cases; empty for all of them
};

// The value that the part p of them does not exceed; NaN without values.
double quantile(std::vector<double> values, double p);

// How often what is claimed holds, how wide error bars are, how near the choice is to the best in
// hindsight, and what it costs.
std::vector<Figure> worth_of(const std::vector<CaseResult>& results);

}  // namespace qddot::judged_advice
