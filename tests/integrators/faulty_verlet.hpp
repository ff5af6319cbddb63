#pragma once

#include "qddot/integrators/base/fixed_step.hpp"
#include "tests/integrators/runs.hpp"

namespace qddot {
inline namespace tests {

// Velocity Verlet with its second kick longer by so many thousandths: with none the method itself,
// with one a fault that the tests have to see.
template <int thousandths>
class FaultyVerlet final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  Outcome step(const State& now, double h, State& next) override {
    force(now.q, f_);
    next.v = now.v + h / 2 * f_.cwiseQuotient(system().mass());
    next.q = now.q + h * next.v;
    force(next.q, f_);
    next.v += (1 + thousandths * 1e-3) * h / 2 * f_.cwiseQuotient(system().mass());
    return Outcome::reached_end;
  }

  Vec f_{system().size()};
};

template <int thousandths>
Method faulty_verlet() {
  Method method = method_named("verlet");
  method.make = create<FaultyVerlet<thousandths>>;
  return method;
}

}  // namespace tests
}  // namespace qddot
