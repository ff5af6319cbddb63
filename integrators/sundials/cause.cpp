#include "integrators/sundials/cause.hpp"

#include <algorithm>

namespace qddot::sundials {
namespace {

constexpr const char* shorter_if_fixed = "lower --step-size, or take an explicit method";
constexpr const char* shorter_if_chosen =
    "lower --rtol, so that steps begin smaller, or take an explicit method";

struct Words {
  Cause cause;
  Outcome outcome;
  const char* happened;
  const char* to_turn;
  const char* to_turn_if_fixed = to_turn;
};
constexpr Words all_words[] = {
    {Cause::error_test, Outcome::step_too_small, "the error test failed repeatedly",
     "raise --rtol, or check the scene for springs that collapse"},
    {Cause::accuracy, Outcome::step_too_small, "the tolerances ask for more digits than there are",
     "raise --rtol or --atol"},
    {Cause::convergence, Outcome::newton_failed, "Newton's iteration failed to converge repeatedly",
     shorter_if_chosen, shorter_if_fixed},
    {Cause::setup, Outcome::indefinite_matrix,
     "the matrix of Newton's iteration, M - gamma^2 K, is singular", shorter_if_chosen,
     shorter_if_fixed},
    {Cause::force, Outcome::not_finite, "a force within the next step is no finite number",
     "look for extreme values in the scene"},
    {Cause::first_force, Outcome::not_finite, "a force is no finite number",
     "look for extreme values in the scene"},
    {Cause::consistent_start, Outcome::newton_failed,
     "no positions of the massless nodes were found in which their forces balance",
     "draw them where their springs, stretched, pull equally"},
    {Cause::loose_massless, Outcome::went_slack,
     "springs no longer hold a massless node, so that nothing says how it moves,", "give it mass"},
    {Cause::relaxation, Outcome::solver_failed,
     "no part of a step that keeps the energy was found repeatedly",
     "lower --rtol, so that steps change the energy less, or take another method"},
    {Cause::fast_steps, Outcome::step_too_small,
     "the small steps of the stiff springs are below rounding", "raise --step-size"},
    {Cause::end_too_close, Outcome::step_too_small, "the time that is left is below rounding",
     "ask for a later end"},
    {Cause::other, Outcome::solver_failed, "the library gave up", "take another method"}};

const Words& words_on(Cause cause) { return *std::ranges::find(all_words, cause, &Words::cause); }

}  // namespace

Outcome outcome_of(Cause cause) { return words_on(cause).outcome; }
const char* what_happened(Cause cause) { return words_on(cause).happened; }
const char* what_to_turn(Cause cause, bool has_fixed_step) {
  return has_fixed_step ? words_on(cause).to_turn_if_fixed : words_on(cause).to_turn;
}

Cause cause_in(std::span<const std::pair<int, Cause>> table, int flag) {
  const auto found = std::ranges::find(table, flag, &std::pair<int, Cause>::first);
  return found == table.end() ? Cause::other : found->second;
}

}  // namespace qddot::sundials
