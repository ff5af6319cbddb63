#pragma once

#include <limits>

#include "qddot/integrators/counts.hpp"
#include "qddot/model/beside_force.hpp"
#include "qddot/model/capabilities.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {

// Evaluates the functions of a system for a run. It counts every evaluation and, if the run is
// timed, takes its time. Functions with a `part` evaluate a system with a part of the forces (see
// Split) and count it likewise. Borrows the system, which must outlive it.
//
// The force of a system with Damping, at velocities, is found in its two parts, so that a method
// can book the energy that friction takes at the places where the method evaluates forces.
class CountedSystem {
 public:
  CountedSystem(const System& system, bool is_timed)
      : system_(system),
        split_stiffness_(system.split_stiffness()),
        discrete_gradient_(system.discrete_gradient()),
        damping_(system.damping()),
        driving_(system.driving()),
        switching_(system.switching()),
        is_placed_(driving_ || switching_),
        clock_(is_timed ? &seconds : nullptr) {}
  CountedSystem(const CountedSystem&) = delete;
  CountedSystem& operator=(const CountedSystem&) = delete;

  const System& system() const { return system_; }

  // Has all places be in the piece of time that this time [s] is in (see At); NaN: in their own.
  void stay_within(double t) { within_ = t; }
  // Has all places be in these phases of springs (see At), which must outlive it.
  void stay_in(const Phase* phases) { phases_ = phases; }

  // The place in that piece and those phases.
  At placed(At at) const {
    at.within = within_;
    at.phases = phases_;
    return at;
  }

  // f [N] into `f` (n).
  void force(const At& at, MutableVec f) { force(system_, at, f); }
  void force(const System& part, const At& at, MutableVec f) {
    ++counts.force_evaluations;
    const Stopwatch watch(clock_, &Seconds::force);
    if (is_placed_) return placed_force(part, placed(at), f);
    if (!damping_ || at.v.size() == 0) return part.force(at, f);
    damped_force(part, at, f);
  }

  // f_d [N] of the last force at velocities v; zero if the system has no Damping.
  const Vec& friction() const { return friction_; }
  // The same; this may change it for a vector of any content, in place of a copy.
  Vec& friction() { return friction_; }
  // The power [W] of friction and driving at the place of the last force, of force() alone.
  Work power() const { return Work{.dissipated = power_} + driven_; }
  // That of driving alone, of any force. Friction then has -v'f_d beside.
  const Work& driving_power() const { return driven_; }
  // The same as power(), at any place; friction() is then that of this place.
  Work power(const At& given) {
    const At at = placed(given);
    const Stopwatch watch(clock_, &Seconds::force);
    if (damping_) set_friction(*damping_, at);
    if (driving_) driven_ = driving_->driving_power(at);
    return power();
  }
  // Subtracts rate C [N/m] of a part with Damping from `k`, a K of its pattern; rate in 1/s.
  void subtract_damping(const System& part, const At& given, double rate, SymmetricMatrix& k) {
    const At at = placed(given);
    const Stopwatch watch(clock_, &Seconds::stiffness);
    if (c_.nonZeros() != k.nonZeros()) c_ = k;
    part.damping()->damping_matrix(at, c_);
    k.coeffs() -= rate * c_.coeffs();
  }
  // The same with work beside it (see System::force_beside). The time of that work is not a
  // force's, so a timed run does it before and after.
  double force_beside(const At& at, MutableVec f, BesideForce& beside) {
    const bool is_damped = damping_ && at.v.size() > 0;
    if (!clock_ && !is_damped && !is_placed_) {
      ++counts.force_evaluations;
      return system_.force_beside(at, f, beside);
    }
    const At there = placed(at);
    const double sum = sum_force_beside(there, f, beside);
    if (driving_) driven_ = driving_->driving_power(there);
    return sum;
  }
  // V [J].
  double potential(const At& at) const { return system_.potential(placed(at)); }
  // Damping::secant_friction of a system with Damping.
  std::optional<double> secant_friction(BackwardRate rate, const ConstVec& v, MutableVec f) const {
    rate.phases = phases_;
    return damping_->secant_friction(rate, v, f);
  }
  // Driving::potential_change of a system with Driving.
  double potential_change(double from, double to, const VecView& q) const {
    return driving_->potential_change(from, to, placed({from, q}));
  }
  // Driving of the system, nullptr if it has none.
  const Driving* driving() const { return driving_; }
  // DiscreteGradient::mean_force, counted as a force; for methods that need it.
  void mean_force(const At& a, const At& b, MutableVec f) {
    ++counts.force_evaluations;
    const Stopwatch watch(clock_, &Seconds::force);
    discrete_gradient_->mean_force(placed(a), placed(b), f);
  }
  // K [N/m] into `k`, which has the system's pattern.
  void stiffness(const At& at, SymmetricMatrix& k) { stiffness(system_, at, k); }
  void stiffness(const System& part, const At& at, SymmetricMatrix& k) {
    ++counts.stiffness_evaluations;
    const Stopwatch watch(clock_, &Seconds::stiffness);
    part.stiffness(placed(at), k);
  }
  // The material part of K of a system that knows it, else K.
  void material_stiffness(const System& part, const At& at, SymmetricMatrix& k) {
    ++counts.stiffness_evaluations;
    const Stopwatch watch(clock_, &Seconds::stiffness);
    if (const auto* split = part.split_stiffness()) return split->material_stiffness(placed(at), k);
    part.stiffness(placed(at), k);
  }
  // SplitStiffness::weighted_stiffness. If the system has none, this is the weight times all of K.
  // As the weight goes to 0, M - s K goes to M, which is positive definite.
  void weighted_stiffness(const At& at, double compression_weight, SymmetricMatrix& k) {
    ++counts.stiffness_evaluations;
    const Stopwatch watch(clock_, &Seconds::stiffness);
    if (split_stiffness_)
      return split_stiffness_->weighted_stiffness(placed(at), compression_weight, k);
    system_.stiffness(placed(at), k);
    if (compression_weight != 1) k.coeffs() *= compression_weight;
  }

  // The record of times for a Stopwatch; nullptr unless the run is timed.
  Seconds* clock() const { return clock_; }

  Counts counts;
  Seconds seconds;

 private:
  void placed_force(const System& part, const At& at, MutableVec& f) {
    if (driving_) driven_ = books(part) ? driving_->driving_power(at) : Work{};
    if (!damping_ || at.v.size() == 0) return part.force(at, f);
    damped_force(part, at, f);
  }
  void damped_force(const System& part, const At& at, MutableVec& f) {
    friction_.resize(f.size());
    const Damping* damping = part.damping();
    if (damping && damping->damped_force(at, f, friction_, nullptr)) {
      power_ = -product(friction_, at.v);
      return;
    }
    At without_velocities(at.t, at.q);
    without_velocities.within = at.within;
    without_velocities.phases = at.phases;
    part.force(without_velocities, f);
    if (damping) {
      set_friction(*damping, at);
      f += friction_;
    } else {
      friction_.setZero();
      power_ = 0;
    }
  }
  double sum_force_beside(const At& at, MutableVec& f, BesideForce& beside) {
    const bool is_damped = damping_ && at.v.size() > 0;
    if (!clock_ && !is_damped) {
      ++counts.force_evaluations;
      return system_.force_beside(at, f, beside);
    }
    if (!clock_) {
      friction_.resize(f.size());
      if (const auto sum = damping_->damped_force(at, f, friction_, &beside)) {
        ++counts.force_evaluations;
        return *sum;
      }
    }
    beside.before(0, system_.size());
    force(at, f);
    return beside.after(0, system_.size());
  }
  // Whether the force of the part books what driving gives: that of the whole, or the soft half.
  bool books(const System& part) const {
    return &part == &system_ || (system_.split() && &part == system_.split()->soft.get());
  }
  void set_friction(const Damping& damping, const At& at) {
    friction_.resize(at.q.size());
    damping.friction(at, friction_);
    power_ = -product(friction_, at.v);
  }

  const System& system_;
  // Capabilities of the system; nullptr for a missing one.
  const SplitStiffness* split_stiffness_;
  const DiscreteGradient* discrete_gradient_;
  const Damping* damping_;
  const Driving* driving_;
  const Switching* switching_;
  const bool is_placed_;  // whether forces depend on the piece of time or on phases
  Seconds* clock_;
  double within_ = std::numeric_limits<double>::quiet_NaN();
  const Phase* phases_ = nullptr;
  Vec friction_;
  double power_ = 0;
  Work driven_{};  // rates
  SymmetricMatrix c_;
};

}  // namespace qddot
