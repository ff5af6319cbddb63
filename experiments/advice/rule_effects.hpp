#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/advice/hard_case.hpp"

namespace qddot::judged_advice {

// The answer of a search with changed rules to a hard case.
struct RuledAnswer {
  bool is_claimed = false;
  double error_estimate = 0, error = 0;
  double forces = 0;  // of all runs
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RuledAnswer, is_claimed, error_estimate, error, forces)

// The answers for one case: by the rules as they are, then with each of them halved and doubled.
struct RuledCase {
  std::string name{};
  bool is_well_posed = false;
  double conditioning = 0;
  std::vector<RuledAnswer> answers{};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RuledCase, name, is_well_posed, conditioning, answers)

RuledCase ruled_case(const HardCase& hard);

// The effect of a changed rule on the answers for many cases.
struct RuleEffect {
  std::string rule{};  // empty for the rules as they are
  double value = 0, factor = 1;
  // Percentages: of the answers with an error within their bar, and of refused cases.
  double within_bar = 0, refused = 0;
  // All forces, over those by the rules as they are, for cases that both answer.
  double forces = 1;
};
std::vector<RuleEffect> effects_of(const std::vector<RuledCase>& cases);

}  // namespace qddot::judged_advice
