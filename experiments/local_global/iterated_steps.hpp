#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/kit/program.hpp"
#include "experiments/local_global/swinging_cloth.hpp"
#include "qddot/integrators/method.hpp"

namespace qddot::local_global {

// Implicit Euler by a given number of Newton's iterations (Options::iterations), for comparison
// with the other methods of a given number of iterations. It starts at v = v_n and iterates
//   r = M (v - v_n) - h f(q_n + h v),  p = (M - h^2 K)^-1 r,  v = v - alpha p
// with the first alpha of 1, 1/2, 1/4, ... that lowers the energy by Armijo's rule (none: v stays).
// `newton_exact` uses K itself. If M - h^2 K is not positive definite, it uses as much of the
// compression as keeps it so (see SplitStiffness). `newton_clamped` never uses compression.
// Both are not in the registry. Its implicit_euler stops when iterations gain nothing more, and
// keeps its factors as long as they serve.
const Method& newton_exact();
const Method& newton_clamped();

constexpr int most_newton_iterations = 40;  // more than it takes on any cloth here

// A step of so many iterations by one solver.
struct StepRow {
  double varied = 0;  // the stiffness, or the number of nodes, by which tables compare cloths
  std::string solver;
  int iteration = 0;
  double seconds = 0;            // without the matrix that does not change
  double relative_error = 0;     // the energy above its minimum, in parts of the prediction's
  double distance = 0, own = 0;  // [m]: of positions from the converged step, and step_error
};

// Steps by all solvers, which are the methods with a given number of iterations, and Newton's.
struct Comparison {
  std::vector<StepRow> rows;          // from no iteration on, solver after solver
  nlohmann::json setup;               // the seconds before a solver's first iteration, by its name
  std::vector<std::string> failures;  // why steps of more iterations of a solver are not there
  double step_error = 0;              // distance of the converged step from the true motion [m]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StepRow, varied, solver, iteration, seconds, relative_error,
                                   distance, own)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Comparison, rows, setup, failures, step_error)

// Steps of h [s] of the cloth with 1 to `most` iterations. Their minimum is the lowest energy that
// any solver reached. A solver whose step fails keeps its results with fewer iterations.
// `step_error` is found if `with_truth`.
Comparison compare(const SwingingCloth& cloth, double h, int most, int repeats, double varied,
                   bool with_truth);

// The tables of these rows.
struct StepTables {
  explicit StepTables(Program& p);
  // Adds one step of one cloth to a table, and its setup to the table's sidecar.
  static void add(RowTable<StepRow>& table, const Comparison& step, const nlohmann::json& setup);

  RowTable<StepRow>&convergence, &positions, &stiffness, &resolution;
};

// Prints for people with how many iterations each solver's error is below a tenth of the step's
// own.
void print(const Comparison& step, double h);

}  // namespace qddot::local_global
