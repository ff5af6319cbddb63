#pragma once

#include <vector>

#include "experiments/symmetric_roots/formula_of_cosines.hpp"

namespace qddot::spurious_roots {

// The scene `orbit` in its own units, in which w = 1 and the spring is 1 long at rest: what a
// formula's energy does where the motion changes the frequencies that the roots see. Made once for
// all formulas, since the exact positions of the first steps cost more than a run.
class OrbitSwing {
 public:
  // Runs will be of `steps` steps at eight h w from h_omega/2 to h_omega, by formulas of up to
  // `most_steps` steps.
  OrbitSwing(double h_omega, int steps, int most_steps);

  // The largest |E - E(0)| over the largest kinetic energy, of all these runs; at most 1, where a
  // run is ended.
  double operator()(const Coefficients& formula) const;

 private:
  struct Point {
    double x, y;
  };
  struct Start {
    double h;
    std::vector<Point> positions;  // at 0, h, 2 h, ...
  };
  static Point acceleration(const Point& q);
  double swing(const Coefficients& formula, const Start& start) const;

  int steps_;
  std::vector<Start> starts_;
};

}  // namespace qddot::spurious_roots
