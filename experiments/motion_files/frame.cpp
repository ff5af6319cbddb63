#include "experiments/motion_files/frame.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "experiments/motion_files/cells.hpp"

namespace qddot::motion_files {
namespace {

// Whether the exponent is not the one of infinities and of what is no number.
bool is_finite(float value) {
  constexpr std::uint32_t exponent = 0x7f800000;
  return (std::bit_cast<std::uint32_t>(value) & exponent) != exponent;
}

// These make a number a float; `is_fine` is false from then on where it is none. No branches, so
// that loops over them are done in vectors.
float whole(double value, bool& is_fine) {
  const auto result = static_cast<float>(value);
  is_fine &= is_finite(result);
  return result;
}

float short_form(double value, bool& is_fine) {
  const float result = rounded(whole(value, is_fine));
  is_fine &= is_finite(result);
  return result;
}

}  // namespace

float rounded(float value) {
  constexpr int dropped = 23 - kept_bits;  // of the 23 that a float has behind the first
  constexpr std::uint32_t mask = (std::uint32_t(1) << dropped) - 1;
  auto bits = std::bit_cast<std::uint32_t>(value);
  bits += (mask >> 1) + (bits >> dropped & 1);
  return std::bit_cast<float>(bits & ~mask);
}

Framing::Framing(const Scene& start, const ReducedScene& scene, const Fields& wanted)
    : scene_(scene),
      wanted_(wanted),
      lengths_(strain_lengths(start, scene.expand(scene.initial()))) {
  for (const Node& node : start.nodes) masses_.push_back(node.pinned ? 0 : node.mass);
  const Cells cells = cells_of(start);
  springs_ = cells.lines;
  first_line_ = cells.points.size();
  cells_ = cells.count();
}

const Frame* Framing::of(const State& state, const State* reference) {
  bool is_fine = std::isfinite(state.t);
  frame_.time = state.t;
  const std::vector<Node> nodes = scene_.expand(state);
  take_positions(nodes, is_fine);
  if (wanted_.velocity) take_velocities(nodes, is_fine);
  if (wanted_.kinetic_energy) take_energies(nodes, is_fine);
  if (wanted_.strain) take_strains(nodes, is_fine);
  if (reference) take_distances(nodes, scene_.expand(*reference), is_fine);
  return is_fine ? &frame_ : nullptr;
}

void Framing::take_positions(const std::vector<Node>& nodes, bool& is_fine) {
  frame_.positions.resize(3 * nodes.size());
  float* to = frame_.positions.data();
  for (const Node& node : nodes) {
    for (const double x : node.position) *to++ = whole(x, is_fine);
  }
}

void Framing::take_velocities(const std::vector<Node>& nodes, bool& is_fine) {
  frame_.velocities.resize(3 * nodes.size());
  float* to = frame_.velocities.data();
  for (const Node& node : nodes) {
    for (const double v : node.velocity) *to++ = short_form(v, is_fine);
  }
}

void Framing::take_energies(const std::vector<Node>& nodes, bool& is_fine) {
  frame_.kinetic_energies.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double energy = 0.5 * masses_[i] * nodes[i].velocity.squaredNorm();
    frame_.kinetic_energies[i] = short_form(energy, is_fine);
  }
}

void Framing::take_strains(const std::vector<Node>& nodes, bool& is_fine) {
  frame_.strains.resize(cells_, 0);
  float* to = frame_.strains.data() + first_line_;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const auto& from = nodes[springs_[i][0]].position;
    const double length = (nodes[springs_[i][1]].position - from).norm();
    const double strain = lengths_[i] > 0 ? (length - lengths_[i]) / lengths_[i] : 0;
    *to++ = short_form(strain, is_fine);
  }
}

void Framing::take_distances(const std::vector<Node>& nodes, const std::vector<Node>& exact,
                             bool& is_fine) {
  frame_.distances.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    frame_.distances[i] = short_form((nodes[i].position - exact[i].position).norm(), is_fine);
}

}  // namespace qddot::motion_files
