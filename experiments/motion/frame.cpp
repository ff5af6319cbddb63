#include "experiments/motion/frame.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "experiments/motion/cells.hpp"

namespace qddot::motion {
namespace {

// Appends a number as a float; false where it is none.
bool take(double value, std::vector<float>& to) {
  to.push_back(static_cast<float>(value));
  return std::isfinite(to.back());
}

bool take_rounded(double value, std::vector<float>& to) {
  to.push_back(rounded(static_cast<float>(value)));
  return std::isfinite(to.back());
}

}  // namespace

float rounded(float value) {
  constexpr int dropped = 23 - kept_bits;  // of the 23 that a float has behind the first
  constexpr std::uint32_t mask = (std::uint32_t(1) << dropped) - 1;
  if (!std::isfinite(value)) return value;
  auto bits = std::bit_cast<std::uint32_t>(value);
  bits += (mask >> 1) + (bits >> dropped & 1);
  return std::bit_cast<float>(bits & ~mask);
}

Framing::Framing(const Scene& start, const ReducedScene& scene, const Fields& wanted)
    : scene_(scene), wanted_(wanted), lengths_(strain_lengths(start)) {
  for (const Node& node : start.nodes) masses_.push_back(node.pinned ? 0 : node.mass);
  const Cells cells = cells_of(start);
  springs_ = cells.lines;
  first_line_ = cells.points.size();
  cells_ = cells.count();
}

const Frame* Framing::of(const State& state, const State* reference) {
  frame_.time = state.t;
  for (auto* numbers : {&frame_.positions, &frame_.velocities, &frame_.kinetic_energies,
                        &frame_.distances, &frame_.strains})
    numbers->clear();
  const std::vector<Node> nodes = scene_.expand(state);
  if (!std::isfinite(state.t) || !take_nodes(nodes)) return nullptr;
  if (wanted_.strain && !take_strains(nodes)) return nullptr;
  if (!reference) return &frame_;
  const std::vector<Node> exact = scene_.expand(*reference);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double distance = (nodes[i].position - exact[i].position).norm();
    if (!take_rounded(distance, frame_.distances)) return nullptr;
  }
  return &frame_;
}

bool Framing::take_nodes(const std::vector<Node>& nodes) {
  bool is_fine = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const double x : nodes[i].position) is_fine &= take(x, frame_.positions);
    // What is not written must be a number as well: a motion without velocities does not outlive
    // one that has them.
    for (const double v : nodes[i].velocity) is_fine &= take_rounded(v, frame_.velocities);
    const double energy = 0.5 * masses_[i] * nodes[i].velocity.squaredNorm();
    is_fine &= take_rounded(energy, frame_.kinetic_energies);
  }
  if (!wanted_.velocity) frame_.velocities.clear();
  if (!wanted_.kinetic_energy) frame_.kinetic_energies.clear();
  return is_fine;
}

bool Framing::take_strains(const std::vector<Node>& nodes) {
  bool is_fine = true;
  frame_.strains.assign(first_line_, 0);
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const auto& from = nodes[springs_[i][0]].position;
    const auto& to = nodes[springs_[i][1]].position;
    const double strain = lengths_[i] > 0 ? ((to - from).norm() - lengths_[i]) / lengths_[i] : 0;
    is_fine &= take_rounded(strain, frame_.strains);
  }
  frame_.strains.resize(cells_, 0);
  return is_fine;
}

}  // namespace qddot::motion
