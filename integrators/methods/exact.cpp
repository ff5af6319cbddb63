// The exact motion where K is constant, as a sum of natural modes (see linear_motion.hpp). The
// columns of U are the modes, w_k their frequencies, and y_k the part of the motion in mode k:
//   -M^-1/2 K M^-1/2 = U diag(w_k^2) U^T,   y = U^T M^1/2 (q - q_n),   b = U^T M^-1/2 f(q_n)
//   y_k(h) = y_k'(0) sin(w_k h)/w_k + b_k (1 - cos(w_k h))/w_k^2
// A mode with w_k = 0 moves by y_k'(0) h + b_k h^2/2, and one with w_k^2 < 0 by hyperbolic
// functions. So no step size has a step error; what is left is rounding. The modes are found once a
// run by a dense eigenproblem. It takes n^3 time and n^2 memory for n unknowns, and more than 2000
// of them are refused.
#include <memory>

#include <fmt/format.h>

#include "qddot/analysis/linear_motion.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// The most unknowns: a dense eigenproblem of about ten seconds, and n^2 numbers of memory.
constexpr Index largest_size = 2000;

class Exact final : public Formula {
 public:
  using Formula::Formula;

  void begin(const State& state, State& x) {
    x = state;
    if (system().size() > largest_size) return;
    motion_ = std::make_shared<LinearMotion>(system());
    ++counts().stiffness_evaluations;
    ++counts().factorizations;
  }

  void resume(const Exact& run, const State& x, State& own) {
    own = x;
    motion_ = run.motion_;
  }

  Outcome step(const State& now, double h, State& next) {
    if (!motion_) {
      set_message(fmt::format("{} unknowns are too many for all modes; at most {} are allowed",
                              system().size(), largest_size));
      return Outcome::solver_failed;
    }
    motion_->propagate(now, h, next, scratch_);
    ++counts().force_evaluations;
    return Outcome::reached_end;
  }

 private:
  std::shared_ptr<const LinearMotion> motion_;
  LinearMotion::Scratch scratch_;
};

}  // namespace

Method exact() {
  return {
      .name = "exact",
      .summary = "the exact motion mode by mode, at every step size; where K is constant",
      .source = "superposition of modes, derived in src/qddot/analysis/linear_motion.hpp",
      .order = 0,
      .traits = {Trait::symplectic, Trait::reversible},
      .needs = {Need::conservative, Need::stiffness, Need::constant_stiffness, Need::autonomous},
      .make = create<Exact>};
}

}  // namespace qddot::registered
