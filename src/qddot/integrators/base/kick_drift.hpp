#pragma once

#include <memory>
#include <vector>

#include "qddot/integrators/base/compensated_sum.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"

namespace qddot {

// A step of alternating kicks v += y h M^-1 f(q) and drifts q += x h v. Each is the exact motion of
// a part of H = T(v) + V(q), so the step is symplectic. It is time-reversible if both lists are
// palindromes. The longer list comes first and last.
struct Splitting {
  int order;
  std::vector<double> kicks, drifts;  // y and x, each of sum 1
};

// The palindrome of `size` numbers with the given first half and middle.
std::vector<double> mirrored(std::vector<double> half, std::size_t size);

// The composition of velocity Verlet steps of the sizes gamma_i h.
Splitting verlet_composition(int order, const std::vector<double>& gamma);

// The steps of a splitting. If a kick is first, the last force of a step is the first of the next:
// one evaluation for each drift, and one at the start. Otherwise each kick takes one evaluation.
// Each kick is done in one pass over the vectors with the drift after it. So one that ends a step
// waits for the next step, unless sums are compensated.
//
// Air of alpha damps each drift, whose exact motion over x h is then
//   q += (1 - e^(-alpha x h))/alpha v,   v *= e^(-alpha x h)
// It is that of a part of the motion as before, so orders stay as they are, and drifts back in time
// gain what others lose. The energy that it takes is that of the drift.
//
// Driving moves with the drifts: t is a coordinate of H = T + V(q, t) + p, p' = -dV/dt, and a kick
// of y h changes p. So each kick gives the work y h dV/dt, and E less all work has an error that
// stays bounded.
class KickDrift final : public Formula {
 public:
  struct X : State {
    Vec f;                     // at q, if kicks are first
    double late = 0;           // the kick that v lacks [s]
    double squared_speed = 0;  // |v|^2 with that kick, if it is not 0
    Work driving;              // its power where f is
  };

  KickDrift(SystemRun& run, const Splitting& splitting);

  void begin(const State& state, X& x);
  Outcome step(const X& now, double h, X& next);
  void show(const X& x, bool, State& state) const;
  double squared_speed(const X& next) const;

 private:
  void step_from_kick(const X& now, double h, X& next);
  void step_from_drift(const X& now, double h, X& next);
  void step_compensated(const X& now, double h, X& next);
  // The same with air: h [s] of a drift.
  void drift(double h, X& next);

  const Splitting& splitting_;
  bool kicks_first_;
  double air_damping_;  // alpha [1/s]
  CompensatedSum q_, v_;
};

// Makes the stepper of Method::splitting; for Method::make.
std::unique_ptr<Stepper> create_splitting(SystemRun& run);

}  // namespace qddot
