#pragma once

#include <string>

#include "qddot/model/system.hpp"

namespace qddot {

// The result of a search for an equilibrium. Every field is valid after every outcome.
struct Equilibrium {
  enum class Outcome { reached, unbounded, not_converged };

  Outcome outcome = Outcome::reached;
  std::string message{};           // one sentence that says why, unless reached
  Vec q{};                         // [m], n
  double residual = 0;             // the largest |f_i(q)| [N]
  double smallest_eigenvalue = 0;  // of -K(q) [N/m]; zero where n = 0
  // Whether the energy rises in every direction. If not, it is flat to second order, within
  // rounding (see CurvatureSigns), in `flat_directions`. Something is loose (a mechanism, a slack
  // part, a free body), or too soft for its sign to be told.
  bool isolated = true;
  int flat_directions = 0;
  int iterations = 0;  // Newton's steps and escapes from saddles
};

// The name in tables: "reached", "unbounded", "not_converged".
constexpr const char* name(Equilibrium::Outcome outcome) {
  constexpr const char* names[] = {"reached", "unbounded", "not_converged"};
  return names[static_cast<int>(outcome)];
}

// Finds a stable equilibrium f(q) = 0: a minimum of V, downhill from `start` (n). `length` [m] > 0
// is the size of the scene, which bounds the steps.
//
// It takes Newton's steps p with a shift and with inertia,
//   (a M' - K) p = f + a M' d.
// M' are the masses (see metric_of_all), a >= 0 is the least found to make the matrix positive
// definite, and d is the last step or zero. They are steps of implicit Euler of length a^-1/2 that
// keep the velocity while they lead downhill, and Newton's if a = 0. (Dynamic relaxation: Barnes,
// Form finding and analysis of tension structures by dynamic relaxation, 1999.) A step is cut to a
// trust radius and halved until V falls (Armijo). If V's rounding hides that, |f| must fall or, if
// it cannot, V must not yet rise along p. A stationary point where -K has an eigenvalue that is
// negative beyond rounding is no minimum. It is left along an eigenvector, to the side where V is
// lower. So is a place where -K has one and steps hardly lower V any more: in exact symmetry they
// would lead to a saddle.
//
// Reached: |f_i| <= 8 eps max_i sum_j |K_ij| max(|q|, length), the effect of rounding q; Newton's
// steps then reduce it as far as they can. Unbounded: 1e6 lengths away and still falling. Not
// converged: after 2000 iterations, or if nothing lower is found. Throws std::runtime_error if the
// iteration for the eigenvalue does not converge, and std::invalid_argument if the system has no K.
Equilibrium find_equilibrium(const System& system, const Vec& start, double length);

}  // namespace qddot
