#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "qddot/model/mass.hpp"
#include "qddot/model/spring.hpp"

namespace qddot {

using Index = Eigen::Index;
using Vec = Eigen::VectorXd;
// A vector that is read or written in place: a Vec, a part of one, or an Eigen::Map.
using ConstVec = Eigen::Ref<const Vec>;
using MutableVec = Eigen::Ref<Vec>;

// A symmetric sparse matrix. Only its lower triangle is stored, column by column, and every
// diagonal entry, even a zero. Multiply with selfadjointView<Eigen::Lower>().
using SymmetricMatrix = Eigen::SparseMatrix<double>;

// The energy that damping has taken, that moving supports and changing loads have given, and that
// springs held when they broke [J]; or the rates of the first two [W]. An exact motion keeps
// E + dissipated - driven + released.
struct Work {
  double dissipated = 0, driven = 0, released = 0;

  double taken() const { return dissipated - driven + released; }
  Work& operator+=(const Work& other) {
    dissipated += other.dissipated;
    driven += other.driven;
    released += other.released;
    return *this;
  }
  friend Work operator+(Work a, const Work& b) { return a += b; }
  friend Work operator-(const Work& a, const Work& b) { return a + -1.0 * b; }
  friend Work operator*(double s, const Work& a) {
    return {s * a.dissipated, s * a.driven, s * a.released};
  }
};

// The energy that has passed through a system [J], with which errors of its balance grow.
inline double throughput(const Work& work) {
  return std::max({std::abs(work.driven), work.dissipated, work.released});
}

// The state of a system at time t [s]: unknown positions q [m], node after node (x0 y0 z0 x1 ...),
// and velocities v = q' [m/s]. Both have length n = System::size(). `work` is that on the way [J],
// by the method's own quadrature; a run adds to it. `phases`: those of the system's springs that
// may break or go slack (Switching), once one is broken; else nullptr.
struct State {
  double t = 0;
  Vec q, v;
  Work work{};
  std::shared_ptr<const std::vector<Phase>> phases{};
};

// A vector of numbers that is read in place: those of a Vec, or of a part of one, which must
// outlive this. An expression has to be evaluated first, as in Vec(a + b).
class VecView : public Eigen::Map<const Vec> {
 public:
  template <class Derived>
  requires(bool(Derived::IsVectorAtCompileTime) && Derived::InnerStrideAtCompileTime == 1 &&
           (Eigen::internal::traits<Derived>::Flags & Eigen::DirectAccessBit) != 0)
      VecView(const Eigen::DenseBase<Derived>& x)
      : Eigen::Map<const Vec>(x.derived().data(), x.size()) {}
  VecView(const double* numbers, Index size) : Eigen::Map<const Vec>(numbers, size) {}
};

// The arguments of a force: the time t [s], positions q [m] and velocities v [m/s], both of length
// n. They refer to vectors that must outlive this, and cost no copy.
//
// Formulas for f(t, q) leave v out: it is then empty. Positions alone leave out t as well: it is
// then NaN. A system whose is_conservative() and is_autonomous() hold takes those; one with Driving
// takes them as at its start, t = 0.
struct At {
  At(double time, VecView positions, VecView velocities) : t(time), q(positions), v(velocities) {}
  At(double time, VecView positions) : At(time, positions, VecView(nullptr, 0)) {}
  At(const State& state) : At(state.t, state.q, state.v) {
    if (state.phases) phases = state.phases->data();
  }
  template <class Derived>
  requires std::convertible_to<const Derived&, VecView> At(
      const Eigen::DenseBase<Derived>& positions)
      : At(std::numeric_limits<double>::quiet_NaN(), positions.derived()) {}

  // The same of `count` unknowns from the first one on.
  At segment(Index first, Index count) const {
    const bool has_v = v.size() > 0;
    At part{t, {q.data() + first, count}, {has_v ? v.data() + first : nullptr, has_v ? count : 0}};
    part.within = within;
    part.phases = phases;
    return part;
  }

  double t;
  VecView q, v;
  // A time [s] in the same piece of a function of time that has corners, which is then continued to
  // t; NaN: t itself, and behind a corner at t. Steps that end on a corner, and stages beyond it,
  // belong to the piece before it.
  double within = std::numeric_limits<double>::quiet_NaN();
  // The phases of springs that may go slack or break, by their numbers; nullptr: all by_length.
  const Phase* phases = nullptr;
};

class BesideForce;
class SplitStiffness;
class DiscreteGradient;
class Laplacian;
class PiecewiseLinear;
class Validity;
class Kinks;
class Damping;
class Driving;
class Switching;
class Constraints;
struct Split;

// A mechanical system with the Lagrangian L = T - V, T = 1/2 v'Mv, as in the lecture. It gives M,
// V, f and K of the equation of motion M q'' = f(q), and knows no time stepping. SI units. Signs:
// f = -dV/dq and K = df/dq = -d2V/dq2, so K is negative semidefinite at rest (many codes store -K).
// Objects are immutable; every function may be called from any thread.
//
// A user's force law is a class derived from this with potential() and force(). Implicit methods
// need stiffness() as well. capabilities.hpp lists what some methods need beyond K. A force that
// depends on v or t says so, and methods whose formulas are for f(q) alone refuse it (Need).
class System {
 public:
  explicit System(Vec mass) : mass_(std::move(mass)) {}
  virtual ~System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // The number n of unknown coordinates; zero if every node is pinned.
  Index size() const { return mass_.size(); }
  // The diagonal of the lumped mass matrix M [kg], length n. Entries may be zero (massless nodes).
  const Mass& mass() const { return mass_; }
  // Whether some unknown has no mass, so that M^-1 and an acceleration do not exist for it.
  bool has_massless() const { return (mass_.array() == 0).any(); }
  // The kinetic energy 1/2 v'Mv [J]; v: n.
  double kinetic(const ConstVec& v) const { return 0.5 * v.dot(mass_.cwiseProduct(v)); }

  // The potential energy V [J].
  virtual double potential(const At& at) const = 0;
  // Whether the system computes V. If not, nothing calls potential(), no energy is watched, and
  // implicit steps use no line search.
  virtual bool has_potential() const { return true; }
  // Writes the force f [N], which is -dV/dq where it depends on positions alone; f: n, sized by the
  // caller.
  virtual void force(const At& at, MutableVec f) const = 0;
  // The same, with `beside` called for parts of the unknowns, whose q it may make. f depends on t
  // and q alone. Returns the sum of beside.after() in the order of the unknowns.
  virtual double force_beside(const At& at, MutableVec f, BesideForce& beside) const;
  // Whether f does not depend on v, so that f = -dV/dq.
  virtual bool is_conservative() const { return true; }
  // Whether f, V and K do not depend on t.
  virtual bool is_autonomous() const { return true; }

  // The n x n pattern of K, the same everywhere, with zero values. It is made once, at the latest
  // by the first call, and copied by each user. It is 0 x 0 if the system computes no K.
  virtual const SymmetricMatrix& stiffness_pattern() const;
  // Whether the system computes K. A system that makes its pattern late answers without it.
  virtual bool has_stiffness() const { return stiffness_pattern().cols() == size(); }
  // Writes K = df/dq [N/m] into `k`, which must have the pattern stiffness_pattern(). Throws
  // std::logic_error if the system computes no K.
  virtual void stiffness(const At& at, SymmetricMatrix& k) const;
  // Writes the sums of |K_ij| over each row i [N/m], or no less, found without K, into `sums`
  // (n) and returns true. Returns false if the system has no way that is cheaper than its K.
  virtual bool bound_row_sums(const At&, Vec& /*sums*/) const { return false; }
  // Writes K x [N], found without K, into `y` and returns true; x, y: n. Returns false if the
  // system has no way to it that is cheaper than its K.
  virtual bool multiply_stiffness(const At& /*at*/, const ConstVec& /*x*/, MutableVec /*y*/) const {
    return false;
  }
  // The number of entries of K's pattern, or no less than that, without the pattern.
  virtual Index stiffness_entries() const { return stiffness_pattern().nonZeros(); }
  // Whether K is the same at every q of the motion, so that the motion is linear.
  virtual bool stiffness_is_constant() const { return false; }

  // Capabilities, each nullptr or empty if the system lacks it; see capabilities.hpp. A class that
  // implements one returns `this`; a wrapper has those of the systems in it. A system of blocks has
  // no Constraints; each of its blocks may.
  virtual const SplitStiffness* split_stiffness() const { return nullptr; }
  virtual const DiscreteGradient* discrete_gradient() const { return nullptr; }
  virtual const Laplacian* laplacian() const { return nullptr; }
  virtual const PiecewiseLinear* pieces() const { return nullptr; }
  virtual const Validity* validity() const { return nullptr; }
  virtual const Kinks* kinks() const { return nullptr; }
  virtual const Damping* damping() const { return nullptr; }
  virtual const Driving* driving() const { return nullptr; }
  virtual const Switching* switching() const { return nullptr; }
  virtual const Constraints* constraints() const { return nullptr; }
  // The stiff and the soft forces. A system of blocks has none; each of its blocks may.
  virtual const Split* split() const { return nullptr; }
  // The systems that no force couples, in order, each with a run of consecutive unknowns of its
  // own; none if the system is one whole.
  virtual std::span<const std::unique_ptr<System>> blocks() const { return {}; }

 private:
  Mass mass_;
};

// Kinetic plus potential energy [J] of a state.
inline double total_energy(const System& system, const State& state) {
  return system.kinetic(state.v) + system.potential(state);
}

// Whether the system, or a block of it, has Constraints.
inline bool is_constrained(const System& system) {
  return system.constraints() || std::ranges::any_of(system.blocks(), [](const auto& block) {
           return is_constrained(*block);
         });
}

// Throws std::invalid_argument if the system computes no K.
inline void require_stiffness(const System& system) {
  if (!system.has_stiffness()) {
    throw std::invalid_argument("the system computes no stiffness matrix K, which this is made of");
  }
}

// Whether the energy, and what damping has taken and driving has given, are a constant of the
// motion: forces depend on velocities by Damping alone, and on time by Driving.
inline bool keeps_balance(const System& system) {
  return (system.is_conservative() || system.damping()) &&
         (system.is_autonomous() || system.driving());
}

// Throws std::invalid_argument for a system without that constant.
inline void require_constant_energy(const System& system) {
  if (!keeps_balance(system)) {
    throw std::invalid_argument(
        "the forces depend on time or velocities, and this takes the energy for a constant: run "
        "the system by one method at two steps or tolerances, and compare");
  }
}

}  // namespace qddot
