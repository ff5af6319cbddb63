#include "integrators/sundials/cause.hpp"

namespace qddot::sundials {

Outcome outcome_of(Cause cause) {
  switch (cause) {
    case Cause::error_test:
    case Cause::accuracy:
    case Cause::end_too_close:
    case Cause::fast_steps:
      return Outcome::step_too_small;
    case Cause::convergence:
    case Cause::consistent_start:
      return Outcome::newton_failed;
    case Cause::setup:
      return Outcome::indefinite_matrix;
    case Cause::force:
    case Cause::first_force:
      return Outcome::not_finite;
    case Cause::loose_massless:
      return Outcome::went_slack;
    case Cause::other:
      break;
  }
  return Outcome::solver_failed;
}

const char* what_happened(Cause cause) {
  switch (cause) {
    case Cause::error_test:
      return "the error test failed repeatedly";
    case Cause::accuracy:
      return "the tolerances ask for more digits than there are";
    case Cause::convergence:
      return "Newton's iteration failed to converge repeatedly";
    case Cause::setup:
      return "the matrix of Newton's iteration, M - gamma^2 K, is singular";
    case Cause::force:
      return "a force within the next step is no finite number";
    case Cause::first_force:
      return "a force is no finite number";
    case Cause::consistent_start:
      return "no positions of the massless nodes were found in which their forces balance";
    case Cause::loose_massless:
      return "springs no longer hold a massless node, so that nothing says how it moves,";
    case Cause::fast_steps:
      return "the small steps of the stiff springs are below rounding";
    case Cause::end_too_close:
      return "the time that is left is below rounding";
    case Cause::other:
      break;
  }
  return "the library gave up";
}

const char* what_to_turn(Cause cause, bool has_fixed_step) {
  switch (cause) {
    case Cause::error_test:
      return "raise --rtol, or check the scene for springs that collapse";
    case Cause::accuracy:
      return "raise --rtol or --atol";
    case Cause::convergence:
    case Cause::setup:
      return has_fixed_step ? "lower --step-size, or take an explicit method"
                            : "lower --rtol, so that steps begin smaller, or take an explicit "
                              "method";
    case Cause::force:
    case Cause::first_force:
      return "look for extreme values in the scene";
    case Cause::consistent_start:
      return "draw them where their springs, stretched, pull equally";
    case Cause::loose_massless:
      return "give it mass";
    case Cause::fast_steps:
      return "raise --step-size";
    case Cause::end_too_close:
      return "ask for a later end";
    case Cause::other:
      break;
  }
  return "take another method";
}

}  // namespace qddot::sundials
