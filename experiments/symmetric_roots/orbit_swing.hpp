#pragma once

#include <complex>
#include <vector>

#include "experiments/symmetric_roots/formula.hpp"

namespace qddot::spurious_roots {

// The energy error of formulas on the scene `orbit`, whose motion changes the frequencies that the
// roots depend on. Units are w = 1 and a rest length of 1. It is made once for all formulas, since
// the exact positions of the first steps cost more than a run.
class OrbitSwing {
 public:
  using Point = std::complex<double>;  // x + i y

  // Runs will be of `steps` steps at eight h w from h_omega/2 to h_omega, by formulas of up to
  // `most_steps` steps.
  OrbitSwing(double h_omega, int steps, int most_steps);

  // The largest |E - E(0)| over the largest kinetic energy, of all these runs; at most 1, where a
  // run is ended.
  double operator()(const Coefficients& formula) const;

 private:
  struct Start {
    double h;
    std::vector<Point> positions;  // at 0, h, 2 h, ...
  };
  double swing(const Coefficients& formula, const Start& start) const;

  int steps_;
  std::vector<Start> starts_;
};

}  // namespace qddot::spurious_roots
