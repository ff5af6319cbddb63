#include "qddot/integrators/counts.hpp"

namespace qddot {

Counts& Counts::operator+=(const Counts& more) {
  steps += more.steps;
  rejected += more.rejected;
  force_evaluations += more.force_evaluations;
  stiffness_evaluations += more.stiffness_evaluations;
  factorizations += more.factorizations;
  solves += more.solves;
  newton_iterations += more.newton_iterations;
  indefinite_factorizations += more.indefinite_factorizations;
  order_sum += more.order_sum;
  order_reductions += more.order_reductions;
  stability_limited_steps += more.stability_limited_steps;
  return *this;
}

Seconds& Seconds::operator+=(const Seconds& more) {
  force += more.force;
  stiffness += more.stiffness;
  factorization += more.factorization;
  solve += more.solve;
  return *this;
}

}  // namespace qddot
