#pragma once

#include <limits>
#include <string>
#include <vector>

#include "qddot/measure/advice/trial.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::measure {

// What somebody asks of a motion.
struct Wanted {
  double accuracy = 1e-3;  // relative, from least_accuracy to below 1
  AccuracyOf of = AccuracyOf::positions;
  // After so many seconds no further run is begun, and the one at hand is stopped.
  double seconds = std::numeric_limits<double>::infinity();
};

// Below that rounding decides.
constexpr double least_accuracy = 1e-14;
// Throws std::invalid_argument, naming what makes sense, for an accuracy that nobody can have.
void require_accuracy(double accuracy);

// How an error estimate was made.
enum class EstimateKind {
  compared,   // with a more accurate run, of another step size or formula
  refined,    // with a coarser run of the same method, whose order leaves the finer within that
  conserved,  // the energy's own error, which needs no other run
  rounding,   // of a motion that is computed mode by mode, and has no other error
  none,       // no run came to the end
};
const char* name(EstimateKind kind);

// Where the seconds of an answer went: into the run that is the answer, the one that checks it, and
// everything else, which is what finding them took.
struct AnswerSeconds {
  double pilots = 0, run = 0, check = 0;

  double total() const { return pilots + run + check; }
};

// A motion and how far it can be trusted.
struct Answer {
  bool is_reached = false;  // whether the error estimate is at most the accuracy
  std::string why{};        // a sentence where it is not: why, and what can be had instead
  const Method* method = nullptr;
  double value = 0;  // of the knob: h [s] or rtol
  // A bound of the error in the sense that was asked for; infinite where none is known.
  double error_estimate = std::numeric_limits<double>::infinity();
  EstimateKind error_estimate_kind = EstimateKind::none;
  // What chose the method: "modes", "forecast", "refinement" or, by IDA's, "tolerance".
  std::string advised_by{};
  // From which time on [s] a motion that starts one rounding away is another one, and how fast they
  // part [1/s]; infinite and zero where this was not seen.
  double horizon = std::numeric_limits<double>::infinity(), lyapunov = 0;
  Summary summary{};          // of the run
  State end{};                // where it came to, as the model has it
  std::vector<Node> nodes{};  // all nodes of the scene there
  int runs = 0;               // that were made in all
  AnswerSeconds seconds{};
};

// Finds the motion up to the time `until` [s] to the accuracy, by the method and knob that take the
// least time for it, as far as that can be told for less than the run itself takes; and bounds its
// error by another run (see search.hpp). What cannot be had is said: beyond the horizon of a
// chaotic motion, below its rounding, where no method gets there. Throws std::invalid_argument for
// an accuracy or a time that makes no sense, or a system without K.
Answer solve(const ReducedScene& model, double until, const Wanted& wanted);
// The same for a scene, with all of its reductions; throws InvalidInput where it is wrong.
Answer solve(const Scene& scene, double until, const Wanted& wanted);
Answer solve(const Scene& scene, double until, double accuracy);

}  // namespace qddot::measure
