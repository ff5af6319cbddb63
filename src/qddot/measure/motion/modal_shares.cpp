#include "qddot/measure/motion/modal_shares.hpp"

#include <algorithm>
#include <stdexcept>

#include "qddot/analysis/natural_modes.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::inline measure {

std::optional<ModalShares> ModalShares::at_equilibrium(const Model& scene) try {
  // Only dimensions of the motion count: other modes have no kinetic energy.
  const Equilibrium rest = equilibrium_of(scene);
  if (rest.outcome != Equilibrium::Outcome::reached) return {};
  const Index count = std::min(most_modes, finite_modes(scene.system()));
  return ModalShares(scene.system().mass(), lowest_modes(scene.system(), rest.q, count).shapes);
} catch (const std::runtime_error&) {  // an eigenvalue was not found
  return {};
}

ModalShares::ModalShares(const Vec& mass, const Eigen::MatrixXd& shapes)
    : mass_(mass), impulses_(mass.asDiagonal() * shapes) {}

Vec ModalShares::kinetic(const Vec& v) const {
  const Vec speeds = impulses_.transpose() * v;
  Vec shares(speeds.size() + 1);
  shares.head(speeds.size()) = 0.5 * speeds.cwiseAbs2();
  const double whole = 0.5 * v.dot(mass_.cwiseProduct(v));
  shares[speeds.size()] = std::max(0.0, whole - shares.head(speeds.size()).sum());
  return shares;
}

Vec ModalShares::mean(const std::vector<State>& path) const {
  Vec sum = Vec::Zero(impulses_.cols() + 1);
  for (const State& state : path) {
    if (state.t >= path.back().t / 2) sum += kinetic(state.v);
  }
  return sum.sum() > 0 ? Vec(sum / sum.sum()) : sum;
}

double total_variation(const Vec& a, const Vec& b) { return 0.5 * (a - b).lpNorm<1>(); }

}  // namespace qddot::inline measure
