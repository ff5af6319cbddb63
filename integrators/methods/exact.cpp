// The exact motion where K is constant: a sum of modes, each of which is a sine and cosine of w t
// (and under a constant force, a uniform motion about the rest position):
//   q_{n+1}, v_{n+1} = exp(A h)-propagation of q_n, v_n, at every h (see linear_motion.hpp).
// No step error at any step size; the modes are found once a run, by a dense eigenproblem.
#include <memory>

#include <fmt/format.h>

#include "qddot/analysis/linear_motion.hpp"
#include "qddot/integrators/base/fixed_step.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// A dense eigenproblem of about ten seconds; n^2 numbers of memory.
constexpr Index largest_size = 2000;

class Exact final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  void start(const State&) override {
    if (system().size() > largest_size) return;
    motion_ = std::make_shared<LinearMotion>(system());
    ++counts().stiffness_evaluations;
    ++counts().factorizations;
  }

  void resume(const FixedStep& run, const State&) override {
    motion_ = static_cast<const Exact&>(run).motion_;
  }

  Outcome step(const State& now, double h, State& next) override {
    if (!motion_) {
      set_message(fmt::format("{} unknowns are too many for all modes; at most {} are allowed",
                              system().size(), largest_size));
      return Outcome::solver_failed;
    }
    motion_->propagate(now, h, next, scratch_);
    ++counts().force_evaluations;
    return Outcome::reached_end;
  }

  std::shared_ptr<const LinearMotion> motion_;
  LinearMotion::Scratch scratch_;
};

}  // namespace

Method exact() {
  return {.name = "exact",
          .summary = "the exact motion mode by mode, at every step size; where K is constant",
          .source = "superposition of modes, derived in src/analysis/linear_motion.hpp",
          .order = 0,
          .traits = {Trait::symplectic},
          .needs = {Need::stiffness, Need::constant_stiffness},
          .make = create<Exact>};
}

}  // namespace qddot::registered
