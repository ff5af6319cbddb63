#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace qddot {

using Index = Eigen::Index;
using Vec = Eigen::VectorXd;

// A symmetric sparse matrix of which only the lower triangle is stored, column by column, every
// diagonal entry present even where it is zero. Multiply with selfadjointView<Eigen::Lower>().
using SymmetricMatrix = Eigen::SparseMatrix<double>;

// A point of the phase space at time t [s]: the unknown positions q [m], node after node
// (x0 y0 z0 x1 ...), and the velocities v = q' [m/s]; both of length n = System::size().
struct State {
  double t = 0;
  Vec q, v;
};

struct Split;

// Whether a system offers the matrix L of laplacian(), and whether that bounds its stiffness:
// x'(-K(q))x <= x'Lx for all q and x.
enum class HasLaplacian { no, yes, as_bound };

// The mechanics of the lecture's Lagrangian L = T - V with T = 1/2 v'Mv: everything that the
// equation of motion M q'' = f(q) is made of, and nothing of how it is stepped through time.
// SI units. Signs: f = -dV/dq and K = df/dq = -d2V/dq2, so K is negative semidefinite at rest
// (many codes store -K). Objects are immutable; every function may be called from any thread.
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
  double kinetic(const Vec& v) const { return 0.5 * v.dot(mass_.cwiseProduct(v)); }

  // V(q) [J]; q: n.
  virtual double potential(const Vec& q) const = 0;
  // f = -dV/dq [N]; q, f: n, f sized by the caller.
  virtual void force(const Vec& q, Vec& f) const = 0;
  // K = df/dq [N/m] into `k`, which must carry the pattern of stiffness_pattern().
  virtual void stiffness(const Vec& q, SymmetricMatrix& k) const = 0;
  // Of K what the springs' material makes, without what their tension adds across them (the
  // geometric stiffness): -sum tau' b b' with b the gradient of a spring's length. Negative
  // semidefinite at every q, while compressed springs make K itself indefinite. As stiffness().
  virtual void material_stiffness(const Vec& q, SymmetricMatrix& k) const = 0;
  // The n x n pattern that K has at every q, with values zero; made once, copied by each user.
  virtual const SymmetricMatrix& stiffness_pattern() const = 0;
  // K with the negative transverse part tau/l (I - nn') of every compressed spring scaled by
  // `compression` from 1, the whole of it, to 0, where the sum of all springs is negative
  // semidefinite.
  virtual void softened_stiffness(const Vec& q, double compression, SymmetricMatrix& k) const = 0;
  // The discrete gradient f of V [N]: f.(b - a) = V(a) - V(b) whatever a and b are, f = force(a)
  // where b = a, and f keeps linear and angular momentum as a force does (Gonzalez, Journal of
  // Nonlinear Science 6 (1996) 449-467, spring by spring). a, b: n, f sized by the caller.
  virtual void mean_force(const Vec& a, const Vec& b, Vec& f) const = 0;
  // True only where K is the same at every q of the motion, so that that is linear.
  virtual bool stiffness_is_constant() const = 0;
  // Whether q, which may lie where no motion comes to, is one of the places between which f is
  // linear: f(b) = f(a) + K (b - a) for any two of them, and all that lie between. q: n.
  virtual bool is_linear_at(const Vec&) const { return stiffness_is_constant(); }

  // L [N/m]: what -K is, everywhere, when all springs have rest length zero and nothing quartic.
  // Into `l`, of the pattern of stiffness_pattern(); to be called where has_laplacian() says so.
  // f(q) = -L q + the rest, which grows with distances no faster than a constant for springs
  // without a quartic part; then L bounds -K. No entry couples different axes.
  virtual HasLaplacian has_laplacian() const { return HasLaplacian::no; }
  virtual void laplacian(SymmetricMatrix&) const {}

  // Whether this system is, at q, still what it stands for (see Holds in spring.hpp).
  virtual bool holds_at(const Vec&) const { return true; }
  // When, on the way from the state before a step to the one after it, this stops [s]; nothing
  // where it does not. Integrators ask after each step and do not accept one on which it does.
  virtual std::optional<double> stops_holding(const State&, const State& to) const {
    return holds_at(to.q) ? std::nullopt : std::optional(to.t);
  }
  // The systems that this one is made of where no force couples them, each with its own run of
  // consecutive unknowns, in order; empty where it is one whole.
  virtual std::span<const std::unique_ptr<System>> parts() const { return {}; }
  // This system's forces divided into stiff and soft ones; nullptr where no springs are named
  // stiff, and where there are parts(), each of which has its own.
  virtual const Split* split() const { return nullptr; }

 private:
  Vec mass_;
};

// A system divided by its springs: f = stiff->force + soft->force, and V and K are sums likewise.
// Both have all of its unknowns and masses, and it holds where both do; the pattern of each one's K
// is that of its own springs alone. Weight, loads and constants are the soft one's. Either may be
// without springs.
struct Split {
  std::shared_ptr<const System> stiff, soft;
  // The stiff one once more, over the unknowns alone that its springs or loads act on: unknown a of
  // `core` is unknown core_unknowns[a] of the whole, ascending. All others feel no stiff force.
  std::shared_ptr<const System> core;
  std::vector<Index> core_unknowns;
};

// Kinetic plus potential energy [J] of a state.
inline double total_energy(const System& system, const State& state) {
  return system.kinetic(state.v) + system.potential(state.q);
}

}  // namespace qddot
