#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "qddot/model/system.hpp"

// What a System may offer beside V, f and K, each an interface of its own. A system class derives
// from System and from those that it implements. Who needs one asks capability<C>(system).

namespace qddot {

// The system's capability C, or nullptr where the system does not offer it. The search walks
// through the type of the object: ask when an integrator is made, never in a step.
template <class C>
const C* capability(const System& system) {
  const C* found = dynamic_cast<const C*>(&system);
  return found && system.offers(typeid(C)) ? found : nullptr;
}

// K as a sum of two parts: what the material makes, and what its tension adds across itself (the
// geometric stiffness). Compression turns the sign of the second part, and may make K indefinite.
// Both functions write into `k`, which must carry the pattern of System::stiffness_pattern().
class SplitStiffness {
 public:
  virtual ~SplitStiffness() = default;
  // The material part [N/m], of springs -sum tau' b b' with b the gradient of a spring's length.
  // Negative semidefinite at every q.
  virtual void material_stiffness(const ConstVec& q, SymmetricMatrix& k) const = 0;
  // K [N/m] with what compression makes indefinite scaled by the weight: of every compressed spring
  // the transverse part tau/l (I - nn'). A weight of 1 gives K to the last bit, a weight of 0 a
  // negative semidefinite matrix.
  virtual void weighted_stiffness(const ConstVec& q, double compression_weight,
                                  SymmetricMatrix& k) const = 0;
};

// The discrete gradient of V, with which a method keeps the energy exactly.
class DiscreteGradient {
 public:
  virtual ~DiscreteGradient() = default;
  // The discrete gradient f of V [N]: f.(b - a) = V(a) - V(b) whatever a and b are, f = force(a)
  // where b = a, and f keeps linear and angular momentum as a force does (Gonzalez, Journal of
  // Nonlinear Science 6 (1996) 449-467, for springs each by itself). a, b: n, f sized by the
  // caller.
  virtual void discrete_gradient(const ConstVec& a, const ConstVec& b, MutableVec f) const = 0;
};

// A constant matrix L that stands for -K at every q: f(q) = -L q + the rest. Of springs it is what
// -K is when all rest lengths and quartic terms are zero. Without quartic terms, the rest grows
// with distances no faster than a constant.
class Laplacian {
 public:
  virtual ~Laplacian() = default;
  // L [N/m] into `l`, which must carry the pattern of System::stiffness_pattern(); so only a system
  // with K offers it. No entry couples different axes.
  virtual void laplacian(SymmetricMatrix& l) const = 0;
  // Whether L bounds the stiffness: x'(-K(q))x <= x'Lx for all q and x.
  virtual bool bounds_stiffness() const = 0;
};

// Places between which f is linear, though it is not everywhere. A system without this is linear
// everywhere or nowhere, as System::stiffness_is_constant() says.
class PiecewiseLinear {
 public:
  virtual ~PiecewiseLinear() = default;
  // Whether q, which may lie where no motion comes to, is one of the places between which f is
  // linear: f(b) = f(a) + K (b - a) for any two of them, and all that lie between. q: n.
  virtual bool is_linear_at(const ConstVec& q) const = 0;
};

// Where a system stands for what it was made from: outside, its forces are those of something else
// (see Holds in spring.hpp). A system without this is valid everywhere.
class Validity {
 public:
  virtual ~Validity() = default;
  // q: n.
  virtual bool is_valid_at(const ConstVec& q) const = 0;
  // When the system stops being valid on the way from the state before a step to the one after it
  // [s]; nothing where it does not. Integrators ask after each step, and accept no step on which it
  // does.
  virtual std::optional<double> end_of_validity(const State&, const State& to) const {
    return is_valid_at(to.q) ? std::nullopt : std::optional(to.t);
  }
};

// A system made of systems that no force couples.
class Blocks {
 public:
  virtual ~Blocks() = default;
  // These systems, each with its own run of consecutive unknowns, in order.
  virtual std::span<const std::unique_ptr<System>> blocks() const = 0;
};

// A system divided in two: f = stiff->force + soft->force, and V and K are sums likewise. Both have
// all of its unknowns and masses, and it is valid where both are. The pattern of each one's K is
// that of its own forces alone. Where the whole system has K, all of these have. In a network, the
// soft system has weight, loads and constants, and either may be without springs.
struct Split {
  std::shared_ptr<const System> stiff, soft;
  // The stiff system once more, over the unknowns alone that its forces act on: unknown a of
  // `stiff_block` is unknown stiff_unknowns[a] of the whole, ascending. All others feel no stiff
  // force.
  std::shared_ptr<const System> stiff_block;
  std::vector<Index> stiff_unknowns;
};

// A system whose forces are divided into stiff and soft ones. One that has blocks does not offer
// this itself: each block has its own.
class SplitForces {
 public:
  virtual ~SplitForces() = default;
  virtual const Split& split() const = 0;
};

// The system's blocks; none where it is one whole.
inline std::span<const std::unique_ptr<System>> blocks_of(const System& system) {
  const auto* blocks = capability<Blocks>(system);
  return blocks ? blocks->blocks() : std::span<const std::unique_ptr<System>>();
}

// The system's stiff and soft forces; nullptr where it is not divided.
inline const Split* split_of(const System& system) {
  const auto* forces = capability<SplitForces>(system);
  return forces ? &forces->split() : nullptr;
}

}  // namespace qddot
