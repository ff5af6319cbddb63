// The exact motion where K is constant, as a sum of natural modes (see linear_motion.hpp). The
// columns of U are the modes, w_k their frequencies, and y_k the part of the motion in mode k:
//   -M^-1/2 K M^-1/2 = U diag(w_k^2) U^T,   y = U^T M^1/2 (q - q_n),   b = U^T M^-1/2 f(q_n)
//   y_k(h) = y_k'(0) sin(w_k h)/w_k + b_k (1 - cos(w_k h))/w_k^2
// A mode with w_k = 0 moves by y_k'(0) h + b_k h^2/2, and one with w_k^2 < 0 by hyperbolic
// functions. Damping in proportion to M and K leaves the modes apart. With other damping that is
// the same everywhere, a step is the exponential of its length times the 2n x 2n matrix of q and v
// (see exponential_motion.hpp). So no step size has a step error; what is left is rounding. The
// modes are found once a run by a dense eigenproblem. It takes n^3 time and n^2 memory for n
// unknowns, and more than 2000 of them are refused.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <boost/math/quadrature/gauss.hpp>
#include <fmt/format.h>

#include "qddot/analysis/exponential_motion.hpp"
#include "qddot/analysis/linear_motion.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// The most unknowns: a dense eigenproblem of about ten seconds, and n^2 numbers of memory.
constexpr Index largest_size = 2000;
// The same for an exponential of some ten seconds.
constexpr Index largest_exponential = 400;

class Exact final : public Formula {
 public:
  using Formula::Formula;

  void begin(const State& state, State& x) {
    x = state;
    exponential_.reset();
    is_constant_ = !is_damped() || system().damping()->damping_is_constant();
    if (system().size() > largest_size || !is_constant_) return;
    ++counts().stiffness_evaluations;
    has_modes_ = LinearMotion::has_modes(system());
    if (!has_modes_) return;
    motion_ = std::make_shared<LinearMotion>(system());
    ++counts().factorizations;
  }

  void resume(const Exact& run, const State& x, State& own) {
    own = x;
    motion_ = run.motion_;
    has_modes_ = run.has_modes_;
    is_constant_ = run.is_constant_;
  }

  Outcome step(const State& now, double h, State& next) {
    const Index most = has_modes_ ? largest_size : largest_exponential;
    if (system().size() > most) {
      set_message(fmt::format("{} unknowns are too many for {}; at most {} are allowed",
                              system().size(),
                              has_modes_ ? "all modes" : "the exponential of their matrix", most));
      return Outcome::solver_failed;
    }
    if (is_driven() && !has_modes_) {
      set_message("dashpots couple modes, and this method drives only modes that stay apart");
      return Outcome::solver_failed;
    }
    if (!is_constant_) {
      set_message("dashpots turn with their springs, and this method is for constant C");
      return Outcome::stiffness_varies;
    }
    ++counts().force_evaluations;
    if (has_modes_) {
      motion_->propagate(now, h, next, scratch_);
    } else {
      if (!exponential_ || exponential_->duration() != h) {
        exponential_.emplace(system(), h);
        ++counts().factorizations;
      }
      exponential_->propagate(now, next);
    }
    if (does_work()) set_work(now, next);
    return Outcome::reached_end;
  }

 private:
  // The motion is exact. So what its energy has lost, and driving has given, is what friction has
  // taken; and without friction, driving has given what the energy has gained.
  void set_work(const State& now, State& next) {
    const double lost = total_energy(system(), now) - total_energy(system(), next);
    next.work = now.work;
    if (!is_driven()) {
      next.work.dissipated += lost;
    } else if (!is_damped()) {
      next.work.driven -= lost;
    } else {
      const double driven = driven_between(now, next.t);
      next.work += Work{lost + driven, driven};
    }
  }
  // The integral of the power along the motion, by Gauss' rule on panels of no more than a radian
  // of the fastest vibration or harmonic. All panels have their places at the same parts.
  double driven_between(const State& from, double t) {
    constexpr unsigned points = 15;
    using Rule = boost::math::quadrature::gauss<double, points>;
    double fastest = motion_->fastest();
    const std::optional<Forcing> forcing = system().driving()->forcing(from.t);
    for (const Forcing::Harmonic& harmonic : forcing->harmonics)
      fastest = std::max(fastest, harmonic.frequency);
    const double panels = std::floor((t - from.t) * fastest) + 1, h = (t - from.t) / panels;
    std::array<LinearMotion::Scratch, points + 1> scratch;
    State start = from, at, end;
    double sum = 0;
    for (double panel = 0; panel < panels; ++panel) {
      std::size_t place = 0;
      sum += h * Rule::integrate(
                     [&](double part) {
                       motion_->propagate(start, part * h, at, scratch[place++]);
                       return power(at).driven;
                     },
                     0.0, 1.0);
      motion_->propagate(start, h, end, scratch.back());
      std::swap(start, end);
    }
    return sum;
  }

  std::shared_ptr<const LinearMotion> motion_;
  LinearMotion::Scratch scratch_;
  std::optional<ExponentialMotion> exponential_;
  bool has_modes_ = true, is_constant_ = true;
};

}  // namespace

Method exact() {
  return {
      .name = "exact",
      .summary = "the exact motion mode by mode, at every step size; where K is constant",
      .source = "superposition of modes, derived in src/qddot/analysis/linear_motion.hpp",
      .order = 0,
      .traits = {Trait::symplectic, Trait::reversible},
      .needs = {Need::conservative, Need::stiffness, Need::constant_stiffness, Need::known_in_time},
      .damped = Damped::by_any,
      .make = create<Exact>};
}

}  // namespace qddot::registered
