#pragma once

#include <limits>
#include <string>
#include <vector>

#include "qddot/measure/advice/trial.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline measure {

// The requested accuracy.
struct Wanted {
  double accuracy = 1e-3;  // relative, from least_accuracy to below 1
  AccuracyOf of = AccuracyOf::positions;
  // No further run begins after this time [s], and the present one is stopped.
  double seconds = std::numeric_limits<double>::infinity();
};

// Throws std::invalid_argument, which begins with `said` and names the allowed range, for an
// accuracy outside of it.
void require_accuracy(double accuracy, const std::string& said = "accuracy =");

// The origin of an error estimate.
enum class EstimateKind {
  compared,   // distance to a more accurate run, of another step size or formula
  refined,    // distance to a coarser run of the same method; errors fall by its order
  conserved,  // the energy's own error, which needs no other run
  rounding,   // rounding alone, for a motion computed mode by mode
  neglected,  // the forces beside a linear motion, see solve_linear()
  none,       // no run reached the end
};
const char* name(EstimateKind kind);

// The origin of a method that solve() chose.
enum class AdvisedBy {
  modes,      // the motion is computed mode by mode, or nothing moves
  forecast,   // a forecast of errors and times
  tolerance,  // runs with error control, at ever smaller tolerances
};
const char* name(AdvisedBy origin);

// Wall time of an answer [s]: `run` for the answer itself, `check` for the run that checks it,
// `pilots` for all other runs and work.
struct AnswerSeconds {
  double pilots = 0, run = 0, check = 0;

  double total() const { return pilots + run + check; }
};

// A motion with a bound of its error.
struct Answer {
  bool is_reached = false;  // whether the error estimate is at most the accuracy
  std::string why{};        // if not reached: the reason, and what is possible instead
  const Method* method = nullptr;
  double value = 0;  // of the knob: h [s] or rtol
  // A bound of the error that Wanted::of names; infinite if none is known.
  double error_estimate = std::numeric_limits<double>::infinity();
  EstimateKind error_estimate_kind = EstimateKind::none;
  AdvisedBy advised_by = AdvisedBy::modes;
  // The time [s] from which two motions that start one rounding apart are different, and the rate
  // [1/s] at which they part. Infinite and zero if this was not seen.
  double horizon = std::numeric_limits<double>::infinity(), lyapunov = 0;
  Summary summary{};  // of the run
  // The times at which the run ended steps beside its own, if it did [s]. A run that repeats it has
  // to do so as well, or its errors are others.
  std::vector<double> looks{};
  // A bound of the error of each break's time [s], in the order of summary.breaks.
  std::vector<double> break_errors{};
  State end{};                // the state it reached, in the model's unknowns
  std::vector<Node> nodes{};  // all nodes of the scene in that state
  int runs = 0;               // made in all
  AnswerSeconds seconds{};
};

// Computes the motion up to the time `until` [s] to the accuracy, with a bound of its error from
// another run (see search.hpp). It uses the method and knob that take the least time, as far as the
// search for them takes less time than the run itself. Answer::why says if the accuracy cannot be
// reached: beyond the horizon of a chaotic motion, below its rounding, or by no method. Throws
// std::invalid_argument for an accuracy or a time out of range, or a system without K.
// `drawn`: the scene that the model is the reduction of, if it may leave the symmetry of its
// reductions by rounding.
Answer solve(const Model& model, double until, const Wanted& wanted, const Scene* drawn = nullptr);
// The same for a scene, with all of its reductions; throws InvalidInput if the scene is wrong.
Answer solve(const Scene& scene, double until, const Wanted& wanted);
Answer solve(const Scene& scene, double until, double accuracy);

}  // namespace qddot::inline measure
