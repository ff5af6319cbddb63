#include "experiments/motion_files/frame.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "experiments/motion_files/on_all_cores.hpp"

namespace qddot::motion_files {
namespace {

// Bit 31 says whether the exponent is that of infinities and NaN.
inline std::uint32_t overflow(float value) {
  constexpr std::uint32_t exponent = 0x7f800000, last_of_exponent = 0x00800000;
  return (std::bit_cast<std::uint32_t>(value) & exponent) + last_of_exponent;
}

// These convert a number to a float and record in `overflows` if it does not fit.
inline float whole(double value, std::uint32_t& overflows) {
  const auto result = static_cast<float>(value);
  overflows |= overflow(result);
  return result;
}

// The nearest number with kept_bits; halves go to the even one.
inline float short_form(double value, std::uint32_t& overflows) {
  constexpr int dropped = 23 - kept_bits;  // of the 23 bits behind the first one
  constexpr std::uint32_t mask = (std::uint32_t(1) << dropped) - 1;
  auto bits = std::bit_cast<std::uint32_t>(whole(value, overflows));
  bits += (mask >> 1) + (bits >> dropped & 1);
  const auto result = std::bit_cast<float>(bits & ~mask);
  overflows |= overflow(result);
  return result;
}

// Converts `width` numbers of each item from `first` to `end` to floats. `fetch`(i, numbers) gets
// the numbers of item i. `form`(k, number, overflows) makes number k of all a float. It has no
// branches: a block is in the first cache and is converted in vectors. Returns the overflows.
template <std::size_t width, class Fetch, class Form>
std::uint32_t fill(float* floats, std::size_t first, std::size_t end, const Fetch& fetch,
                   const Form& form) {
  constexpr std::size_t block = 128;
  std::array<double, width * block> numbers;
  std::uint32_t overflows = 0;
  for (; first < end; first += block) {
    const std::size_t count = std::min(block, end - first);
    for (std::size_t i = 0; i < count; ++i) fetch(first + i, &numbers[width * i]);
    float* const to = floats + width * first;
    for (std::size_t k = 0; k < width * count; ++k)
      to[k] = form(width * first + k, numbers[k], overflows);
  }
  return overflows;
}

// The number of items that one core converts at a time.
constexpr std::size_t slab = 1 << 15;

std::size_t slabs(std::size_t items) { return (items + slab - 1) / slab; }

// The lengths [m] of the scene's springs that define their strains, (l - length) / length. A length
// is the rest length or, if that is zero, the distance of the nodes at the start of the motion.
// `nodes` has that start. It is zero if both are.
std::vector<double> strain_lengths(const Scene& scene, const std::vector<Node>& nodes) {
  std::vector<double> lengths;
  lengths.reserve(scene.springs.size());
  for (const auto& [ends, law, holds, stiff] : scene.springs) {
    const auto& from = nodes[ends[0]].position;
    const auto& to = nodes[ends[1]].position;
    lengths.push_back(law.rest_length > 0 ? law.rest_length : (to - from).norm());
  }
  return lengths;
}

}  // namespace

Cells cells_of(const Scene& scene) {
  Cells cells;
  std::vector<bool> is_joined(scene.nodes.size(), false);
  for (const Spring& spring : scene.springs) {
    cells.lines.push_back(spring.nodes);
    for (const std::size_t node : spring.nodes) is_joined[node] = true;
  }
  cells.triangles = scene.faces;
  for (const auto& face : scene.faces) {
    for (const std::size_t node : face) is_joined[node] = true;
  }
  for (std::size_t i = 0; i < is_joined.size(); ++i) {
    if (!is_joined[i]) cells.points.push_back(i);
  }
  return cells;
}

Framing::Framing(const Scene& start, const Model& scene, const Fields& wanted)
    : scene_(scene),
      wanted_(wanted),
      lengths_(strain_lengths(start, scene.expand(scene.initial()))) {
  for (const Node& node : start.nodes) masses_.push_back(node.pinned ? 0 : node.mass);
  const Cells cells = cells_of(start);
  for (const auto& [a, b] : cells.lines)
    springs_.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
  first_line_ = cells.points.size();
  cells_ = cells.count();
  const std::vector<std::size_t>& general = scene.general_springs();
  for (std::size_t k = 0; k < general.size(); ++k) {
    if (start.springs[general[k]].law.can_break())
      breakable_.push_back({k, general[k], lengths_[general[k]]});
  }
}

const Frame* Framing::of(const State& state, const State* reference) {
  if (has_ended_) return nullptr;
  scene_.expand(state, nodes_);
  if (reference) scene_.expand(*reference, exact_nodes_);
  frame_.time = state.t;
  const std::size_t nodes = nodes_.size(), springs = wanted_.strain ? springs_.size() : 0;
  frame_.positions.resize(3 * nodes);
  if (wanted_.velocity) frame_.velocities.resize(3 * nodes);
  if (wanted_.kinetic_energy) frame_.kinetic_energies.resize(nodes);
  if (wanted_.strain) frame_.strains.resize(cells_, 0);
  frame_.distances.resize(reference ? nodes : 0);
  if (wanted_.strain) leave_out_broken(state);
  std::atomic<std::uint32_t> overflows = 0;
  on_all_cores(slabs(nodes) + slabs(springs), nodes + springs, [&](std::size_t k) {
    const bool is_of_nodes = k < slabs(nodes);
    const std::size_t first = (is_of_nodes ? k : k - slabs(nodes)) * slab;
    overflows |= is_of_nodes ? take_nodes(first, std::min(nodes, first + slab))
                             : take_strains(first, std::min(springs, first + slab));
  });
  if (wanted_.strain) mark_broken(state);
  has_ended_ = !std::isfinite(state.t) || overflows >> 31 != 0;
  return has_ended_ ? nullptr : &frame_;
}

std::uint32_t Framing::take_nodes(std::size_t first, std::size_t end) {
  std::uint32_t overflows = fill<3>(
      frame_.positions.data(), first, end,
      [&](std::size_t i, double* x) { Eigen::Map<Eigen::Vector3d>{x} = nodes_[i].position; },
      [](std::size_t, double x, auto& found) { return whole(x, found); });
  if (wanted_.velocity)
    overflows |= fill<3>(
        frame_.velocities.data(), first, end,
        [&](std::size_t i, double* v) { Eigen::Map<Eigen::Vector3d>{v} = nodes_[i].velocity; },
        [](std::size_t, double v, auto& found) { return short_form(v, found); });
  if (wanted_.kinetic_energy)
    overflows |= fill<1>(
        frame_.kinetic_energies.data(), first, end,
        [&](std::size_t i, double* square) { *square = nodes_[i].velocity.squaredNorm(); },
        [&](std::size_t i, double square, auto& found) {
          return short_form(0.5 * masses_[i] * square, found);
        });
  if (!frame_.distances.empty())
    overflows |= fill<1>(
        frame_.distances.data(), first, end,
        [&](std::size_t i, double* square) {
          *square = (nodes_[i].position - exact_nodes_[i].position).squaredNorm();
        },
        [](std::size_t, double square, auto& found) {
          return short_form(std::sqrt(square), found);
        });
  return overflows;
}

std::uint32_t Framing::take_strains(std::size_t first, std::size_t end) {
  return fill<1>(
      frame_.strains.data() + first_line_, first, end,
      [&](std::size_t i, double* square) {
        const auto& [a, b] = springs_[i];
        *square = (nodes_[b].position - nodes_[a].position).squaredNorm();
      },
      [&](std::size_t i, double square, auto& found) {
        const double length = lengths_[i], strain = (std::sqrt(square) - length) / length;
        return short_form(length > 0 ? strain : 0, found);
      });
}

void Framing::leave_out_broken(const State& state) {
  for (const Breakable& one : breakable_)
    lengths_[one.spring] = one.is_broken(state) ? 0 : one.length;
}

void Framing::mark_broken(const State& state) {
  for (const Breakable& one : breakable_) {
    if (one.is_broken(state))
      frame_.strains[first_line_ + one.spring] = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace qddot::motion_files
