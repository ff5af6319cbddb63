#include "qddot/model/linearized_system.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {
namespace {

class LinearizedSystem final : public System, public Damping {
 public:
  LinearizedSystem(const System& system, const Vec& place)
      : System(system.mass()),
        place_(place),
        force_(place.size()),
        energy_(system.has_potential() ? system.potential(place) : 0),
        has_potential_(system.has_potential()),
        stiffness_(system.stiffness_pattern()),
        air_damping_(system.damping() ? system.damping()->air_damping() : 0) {
    system.force(place, force_);
    system.stiffness(place, stiffness_);
  }

  double potential(const At& at) const override {
    const Vec u = at.q - place_;
    return energy_ - force_.dot(u) - 0.5 * u.dot(times(u));
  }
  bool has_potential() const override { return has_potential_; }
  void force(const At& at, MutableVec f) const override {
    f = force_ + times(at.q - place_);
    if (air_damping_ > 0 && at.v.size() > 0) f -= air_damping_ * mass().cwiseProduct(at.v);
  }
  bool is_conservative() const override { return air_damping_ == 0; }
  const SymmetricMatrix& stiffness_pattern() const override { return stiffness_; }
  void stiffness(const At& /*at*/, SymmetricMatrix& k) const override {
    std::copy_n(stiffness_.valuePtr(), stiffness_.nonZeros(), k.valuePtr());
  }
  bool multiply_stiffness(const At& /*at*/, const ConstVec& x, MutableVec y) const override {
    y = times(x);
    return true;
  }
  bool stiffness_is_constant() const override { return true; }
  const Damping* damping() const override { return air_damping_ > 0 ? this : nullptr; }

  void friction(const At& at, MutableVec f) const override {
    f = -air_damping_ * mass().cwiseProduct(at.v);
  }
  void damping_matrix(const At& /*at*/, SymmetricMatrix& c) const override {
    c.coeffs().setZero();
    c.diagonal() = air_damping_ * mass();
  }
  bool damping_is_constant() const override { return true; }
  double air_damping() const override { return air_damping_; }
  bool has_dashpots() const override { return false; }
  std::optional<double> damping_time() const override { return 0; }

 private:
  Vec times(const Vec& x) const { return stiffness_.selfadjointView<Eigen::Lower>() * x; }

  Vec place_, force_;  // p, f(p)
  double energy_;      // V(p)
  bool has_potential_;
  SymmetricMatrix stiffness_;  // K(p), whose pattern serves as one
  double air_damping_;
};

}  // namespace

bool can_be_linearized(const System& system) {
  const Damping* damping = system.damping();
  const bool is_by_position = damping ? !damping->has_dashpots() : system.is_conservative();
  return system.has_stiffness() && system.is_autonomous() && is_by_position &&
         !system.switching() && !is_constrained(system);
}

std::shared_ptr<const System> linearized(const System& system, const Vec& place) {
  if (!can_be_linearized(system))
    throw std::invalid_argument(
        "a system is linearised by its K; forces of time, of dashpots, of "
        "rods, of cables and of springs that break are not of this kind");
  if (system.blocks().empty()) return std::make_shared<LinearizedSystem>(system, place);
  std::vector<std::unique_ptr<System>> blocks;
  Index first = 0;
  for (const auto& block : system.blocks()) {
    blocks.push_back(
        std::make_unique<LinearizedSystem>(*block, Vec(place.segment(first, block->size()))));
    first += block->size();
  }
  return std::make_shared<BlockDiagonalSystem>(std::move(blocks));
}

}  // namespace qddot
