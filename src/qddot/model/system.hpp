#pragma once

#include <stdexcept>
#include <typeinfo>
#include <utility>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace qddot {

using Index = Eigen::Index;
using Vec = Eigen::VectorXd;
// A vector that is read or written in place: a Vec, a part of one, or an Eigen::Map.
using ConstVec = Eigen::Ref<const Vec>;
using MutableVec = Eigen::Ref<Vec>;

// A symmetric sparse matrix. Only its lower triangle is stored, column by column, and every
// diagonal entry, even a zero. Multiply with selfadjointView<Eigen::Lower>().
using SymmetricMatrix = Eigen::SparseMatrix<double>;

// The state of a system at time t [s]: unknown positions q [m], node after node (x0 y0 z0 x1 ...),
// and velocities v = q' [m/s]. Both have length n = System::size().
struct State {
  double t = 0;
  Vec q, v;
};

// A mechanical system with the Lagrangian L = T - V, T = 1/2 v'Mv, as in the lecture. It gives M,
// V, f and K of the equation of motion M q'' = f(q), and knows no time stepping. SI units. Signs:
// f = -dV/dq and K = df/dq = -d2V/dq2, so K is negative semidefinite at rest (many codes store -K).
// Objects are immutable; every function may be called from any thread.
//
// A user's force law is a class derived from this with potential() and force(). Implicit methods
// need stiffness() as well. capabilities.hpp lists what some methods need beyond K.
class System {
 public:
  explicit System(Vec mass) : mass_(std::move(mass)) {}
  virtual ~System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // The number n of unknown coordinates; zero if every node is pinned.
  Index size() const { return mass_.size(); }
  // The diagonal of the lumped mass matrix M [kg], length n. Entries may be zero (massless nodes).
  const Vec& mass() const { return mass_; }
  // Whether some unknown has no mass, so that M^-1 and an acceleration do not exist for it.
  bool has_massless() const { return (mass_.array() == 0).any(); }
  // The kinetic energy 1/2 v'Mv [J]; v: n.
  double kinetic(const ConstVec& v) const { return 0.5 * v.dot(mass_.cwiseProduct(v)); }

  // The potential energy V(q) [J]; q: n.
  virtual double potential(const ConstVec& q) const = 0;
  // Whether the system computes V. If not, nothing calls potential(), no energy is watched, and
  // implicit steps use no line search.
  virtual bool has_potential() const { return true; }
  // Writes the force f = -dV/dq [N]; q, f: n, f sized by the caller.
  virtual void force(const ConstVec& q, MutableVec f) const = 0;

  // The n x n pattern of K, the same at every q, with zero values. It is made once and copied by
  // each user. It is 0 x 0 if the system computes no K.
  virtual const SymmetricMatrix& stiffness_pattern() const;
  // Whether the system computes K.
  bool has_stiffness() const { return stiffness_pattern().cols() == size(); }
  // Writes K = df/dq [N/m] at q (n) into `k`, which must have the pattern stiffness_pattern().
  // Throws std::logic_error if the system computes no K.
  virtual void stiffness(const ConstVec& q, SymmetricMatrix& k) const;
  // Whether K is the same at every q of the motion, so that the motion is linear.
  virtual bool stiffness_is_constant() const { return false; }

  // Whether this object offers the capability of that type (see capabilities.hpp), which its class
  // implements. A wrapper declines what the systems in it lack. Only capability() calls this.
  virtual bool offers(const std::type_info&) const { return true; }

 private:
  Vec mass_;
};

// Kinetic plus potential energy [J] of a state.
inline double total_energy(const System& system, const State& state) {
  return system.kinetic(state.v) + system.potential(state.q);
}

// Throws std::invalid_argument if the system computes no K.
inline void require_stiffness(const System& system) {
  if (!system.has_stiffness()) {
    throw std::invalid_argument("the system computes no stiffness matrix K, which this is made of");
  }
}

}  // namespace qddot
