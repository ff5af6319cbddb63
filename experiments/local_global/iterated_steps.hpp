#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "experiments/local_global/swinging_cloth.hpp"
#include "qddot/integrators/method.hpp"

namespace qddot::local_global {

constexpr int most_newton_iterations = 40;  // more than it takes on any cloth here

// A step of so many iterations.
struct Step {
  int iterations = 0;
  double seconds = 0;  // the matrix that does not change left out
  State end{};
};

// The steps of one solver, and what it takes before the first.
struct Solved {
  const Method* method = nullptr;
  double analysis = INFINITY, factorization = INFINITY;  // s; the latter of a constant matrix
  std::vector<Step> steps{};                             // from none on
  std::string failure{};  // why a step of more iterations than these is not there; mostly empty
};

// Steps of h [s] of the cloth with 1 to `most` iterations, and the lowest energy that any solver
// reached. Solvers are all methods with a given number of iterations, and Newton's method with K
// exact and clamped. A solver whose step fails keeps its results with fewer iterations.
struct Comparison {
  Comparison(const SwingingCloth& on, double h, int most, int repeats);
  // The energy above its minimum, in parts of the prediction's.
  double relative_error(const Step& step) const;

  const SwingingCloth& cloth;
  std::vector<Solved> all{};
  double first = 0, least = 0;  // [J]
  State converged{};
};

// About how long all comparisons and runs of the program take together [s], with the time of one
// iteration on the cloth measured: `iterations` of them.
double seconds_of_iterations(const SwingingCloth& cloth, double h, double iterations);

// How many iterations, of all solvers, a Comparison makes.
double iterations_of_comparison(int most, int repeats);

}  // namespace qddot::local_global
