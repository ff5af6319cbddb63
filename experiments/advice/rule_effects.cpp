#include "experiments/advice/rule_effects.hpp"

#include "experiments/advice/judged_motion.hpp"
#include "qddot/measure/advice/search.hpp"

namespace qddot::judged_advice {
namespace {

constexpr double factors[] = {0.5, 2};
constexpr double longest_answer = 20;  // [s]

RuledAnswer answer(const HardCase& hard, const JudgedMotion& motion, const Rules& rules) {
  RuledAnswer answer;
  Search search(motion.model(), hard.until, hard.of, longest_answer, &hard.scene, rules);
  const Trial* found = search.find(hard.accuracy);
  for (const Trial& trial : search.runs().all())
    answer.forces += static_cast<double>(trial.summary.counts.force_evaluations);
  if (!found) return answer;
  answer.is_claimed = true;
  answer.error_estimate = search.check().bound(*found)->error;
  answer.error = motion.error_of(*found->method, found->value);
  return answer;
}

}  // namespace

RuledCase ruled_case(const HardCase& hard) {
  const JudgedMotion motion(hard);
  RuledCase result{.name = hard.scene.name};
  if (!motion.truth().is_known() || motion.model().system().size() == 0 ||
      !motion.model().system().has_stiffness())
    return result;
  result.conditioning = motion.conditioning();
  result.is_well_posed = motion.is_well_posed();
  if (!result.is_well_posed) return result;
  result.answers.push_back(answer(hard, motion, {}));
  for (const auto& [name, rule] : all_rules) {
    for (const double factor : factors) {
      Rules changed;
      changed.*rule *= factor;
      result.answers.push_back(answer(hard, motion, changed));
    }
  }
  return result;
}

std::vector<RuleEffect> effects_of(const std::vector<RuledCase>& cases) {
  const auto effect = [&](std::size_t place, const std::string& rule, double value, double factor) {
    double all = 0, claimed = 0, within = 0, forces = 0, as_they_are = 0;
    for (const RuledCase& one : cases) {
      if (!one.is_well_posed) continue;
      const RuledAnswer &now = one.answers[place], &usual = one.answers[0];
      ++all;
      if (now.is_claimed) {
        ++claimed;
        within += now.error - one.conditioning <= now.error_estimate ? 1 : 0;
      }
      if (now.is_claimed && usual.is_claimed) {
        forces += now.forces;
        as_they_are += usual.forces;
      }
    }
    return RuleEffect{.rule = rule,
                      .value = value,
                      .factor = factor,
                      .within_bar = 100 * within / claimed,
                      .refused = 100 * (1 - claimed / all),
                      .forces = forces / as_they_are};
  };
  std::vector<RuleEffect> effects{effect(0, "", 0, 1)};
  std::size_t place = 0;
  for (const auto& [name, rule] : all_rules) {
    for (const double factor : factors)
      effects.push_back(effect(++place, std::string(name), Rules{}.*rule, factor));
  }
  return effects;
}

}  // namespace qddot::judged_advice
