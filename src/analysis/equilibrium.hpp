#pragma once

#include <string>

#include "qddot/model/system.hpp"

namespace qddot {

// Where a search for rest ended. Every field means something after every outcome.
struct Equilibrium {
  enum class Outcome { reached, unbounded, not_converged };

  Outcome outcome = Outcome::reached;
  std::string message{};           // one sentence that says why, unless reached
  Vec q{};                         // [m], n
  double residual = 0;             // the largest |f_i(q)| [N]
  double smallest_eigenvalue = 0;  // of -K(q) [N/m]; zero where n = 0
  // Whether the energy rises in every direction. If not, it stays the same to second order, within
  // rounding (see CurvatureSigns), in so many: something is loose (a mechanism, a slack part, a
  // free body), or too soft for its sign to be told.
  bool isolated = true;
  int flat_directions = 0;
  int iterations = 0;  // Newton's steps and escapes from saddles
};

// As tables have it: "reached", "unbounded", "not_converged".
constexpr const char* name(Equilibrium::Outcome outcome) {
  switch (outcome) {
    case Equilibrium::Outcome::reached:
      return "reached";
    case Equilibrium::Outcome::unbounded:
      return "unbounded";
    case Equilibrium::Outcome::not_converged:
      break;
  }
  return "not_converged";
}

// A stable rest of f(q) = 0: a minimum of V, downhill from `start` (n). `length` [m] > 0 is the
// size of the scene, by which steps are bounded.
//
// Newton's steps with a shift and with inertia,
//   (a M' - K) p = f + a M' d,
// M' the masses (see metric_of_all), a >= 0 the least that is found to make the matrix positive
// definite, d the step before or zero: steps of implicit Euler of length a^-1/2 that keep the
// velocity while they lead downhill (dynamic relaxation: Barnes, Form finding and analysis of
// tension structures by dynamic relaxation, 1999), which become Newton's where a = 0. They are cut
// to a trust radius and halved until V falls (Armijo) or, where V's rounding hides that, |f|.
// A stationary point where -K has an eigenvalue that is negative whatever rounding does is no
// minimum; it is left along an eigenvector, to the side where V is lower.
//
// Reached: |f_i| <= 8 eps max_i sum_j |K_ij| max(|q|, length), which is what the rounding of q
// makes of f = 0, and then as far below as Newton's steps still lead. Unbounded: 1e6 lengths away
// and still falling. Not converged: after 2000 iterations, or where nothing lower is found. Throws
// std::runtime_error where the iteration for the eigenvalue does not converge, and
// std::invalid_argument where the system has no K.
Equilibrium find_equilibrium(const System& system, const Vec& start, double length);

}  // namespace qddot
