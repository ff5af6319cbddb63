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

// The steps of a splitting. If a kick is first, the last force of a step is the first of the next:
// one evaluation for each drift, and one at the start. Otherwise each kick takes one evaluation.
class KickDrift final : public Formula {
 public:
  KickDrift(SystemRun& run, const Splitting& splitting);

  void begin(const State& state, State& x);
  Outcome step(const State& now, double h, State& next);

 private:
  void kick(double size, State& state);
  void drift(double size, State& state);

  const Splitting& splitting_;
  bool kicks_first_;
  CompensatedSum q_, v_;
  Vec f_;  // at the last kick, or at the next one
};

// Makes the stepper of Method::splitting; for Method::make.
std::unique_ptr<Stepper> create_splitting(SystemRun& run);

}  // namespace qddot
