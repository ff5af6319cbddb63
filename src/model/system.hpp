#pragma once

#include <typeinfo>
#include <utility>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace qddot {

using Index = Eigen::Index;
using Vec = Eigen::VectorXd;
// A vector wherever it lies, read or written in place: a Vec, a part of one, an Eigen::Map.
using ConstVec = Eigen::Ref<const Vec>;
using MutableVec = Eigen::Ref<Vec>;

// A symmetric sparse matrix of which only the lower triangle is stored, column by column, every
// diagonal entry present even where it is zero. Multiply with selfadjointView<Eigen::Lower>().
using SymmetricMatrix = Eigen::SparseMatrix<double>;

// A point of the phase space at time t [s]: the unknown positions q [m], node after node
// (x0 y0 z0 x1 ...), and the velocities v = q' [m/s]; both of length n = System::size().
struct State {
  double t = 0;
  Vec q, v;
};

// The mechanics of the lecture's Lagrangian L = T - V with T = 1/2 v'Mv: everything that the
// equation of motion M q'' = f(q) is made of, and nothing of how it is stepped through time.
// SI units. Signs: f = -dV/dq and K = df/dq = -d2V/dq2, so K is negative semidefinite at rest
// (many codes store -K). Objects are immutable; every function may be called from any thread.
//
// A force law of one's own is a class with potential() and force(). With K it can be given to
// implicit methods as well. What some methods need beyond K is in capabilities.hpp.
class System {
 public:
  explicit System(Vec mass) : mass_(std::move(mass)) {}
  virtual ~System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  // Number n of unknown coordinates; zero when every node is pinned.
  Index size() const { return mass_.size(); }
  // The diagonal of the lumped mass matrix M [kg], length n. Entries may be zero (massless nodes).
  const Vec& mass() const { return mass_; }
  // Whether some unknown has no mass, so that M^-1 and an acceleration do not exist for it.
  bool has_massless() const { return (mass_.array() == 0).any(); }
  // 1/2 v'Mv [J].
  double kinetic(const ConstVec& v) const { return 0.5 * v.dot(mass_.cwiseProduct(v)); }

  // V(q) [J]; q: n.
  virtual double potential(const ConstVec& q) const = 0;
  // Whether the system computes V. One that does not is run without a look at its energy, and
  // implicit steps go without a line search; nothing calls its potential().
  virtual bool has_potential() const { return true; }
  // f = -dV/dq [N]; q, f: n, f sized by the caller.
  virtual void force(const ConstVec& q, MutableVec f) const = 0;

  // The n x n pattern that K has at every q, with values zero; made once, copied by each user. A
  // system that computes no K has an empty one, 0 x 0.
  virtual const SymmetricMatrix& stiffness_pattern() const;
  // Whether the system computes K.
  bool has_stiffness() const { return stiffness_pattern().cols() == size(); }
  // K = df/dq [N/m] into `k`, which must carry the pattern of stiffness_pattern(). Throws
  // std::logic_error where the system computes no K.
  virtual void stiffness(const ConstVec& q, SymmetricMatrix& k) const;
  // True only where K is the same at every q of the motion, so that that is linear.
  virtual bool stiffness_is_constant() const { return false; }

  // Whether this object has the capability (see capabilities.hpp) of that type, which its class
  // implements. A wrapper declines what the systems in it do not have. To be asked by capability().
  virtual bool offers(const std::type_info&) const { return true; }

 private:
  Vec mass_;
};

// Kinetic plus potential energy [J] of a state.
inline double total_energy(const System& system, const State& state) {
  return system.kinetic(state.v) + system.potential(state.q);
}

}  // namespace qddot
