#pragma once

#include <limits>
#include <optional>
#include <string>

#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/reference/divergence.hpp"

namespace qddot::inline measure {

// The reason why a search knows no run that is accurate enough, and what is possible instead.
struct Failure {
  std::string why{};  // one sentence
  // The horizon [s] and the rate [1/s] as in Divergence; infinite and zero if no parting was seen.
  double horizon = std::numeric_limits<double>::infinity(), lyapunov = 0;
  bool is_rounding = false;  // whether rounding makes the accuracy impossible for any method
};

// The parting of two motions that start one rounding apart; empty if none was seen.
std::optional<Divergence> parting(const Search& search);

// `stopped_by`: the reason why the search ended early, or empty.
Failure why_not(const Search& search, double accuracy, const std::string& stopped_by);

}  // namespace qddot::inline measure
