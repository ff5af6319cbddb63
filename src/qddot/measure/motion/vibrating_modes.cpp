#include "qddot/measure/motion/vibrating_modes.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/natural_modes.hpp"

namespace qddot::inline measure {
namespace {

constexpr Index most_whole = 1500;
constexpr double least_part = 1e-6;

void append(std::vector<Mode>& modes, const NaturalModes& some, Index first_rank, double largest) {
  for (Index j = 0; j < some.squares.size(); ++j) {
    const double omega = std::sqrt(std::max(0.0, some.squares[j]));
    if (omega <= least_part * largest) continue;
    modes.push_back(
        {static_cast<int>(first_rank + j + 1), omega, omega / largest, some.shapes.col(j)});
  }
}

double largest_omega(const NaturalModes& modes) {
  return std::sqrt(std::max(0.0, modes.squares.maxCoeff()));
}

// The ascending modes that are nearest to `count` evenly spread frequencies.
std::vector<Mode> spread(std::vector<Mode> all, int count) {
  if (std::ssize(all) <= count) return all;
  const double low = all.front().omega, high = all.back().omega;
  std::vector<Mode> chosen;
  for (int i = 0; i < count; ++i) {
    const double wanted = low * std::pow(high / low, 1. * i / std::max(1, count - 1));
    const auto nearest = std::ranges::min_element(
        all, {}, [&](const Mode& mode) { return std::abs(std::log(mode.omega / wanted)); });
    if (chosen.empty() || chosen.back().rank < nearest->rank) chosen.push_back(*nearest);
  }
  return chosen;
}

}  // namespace

namespace {

std::vector<Mode> undamped_modes(const System& system, const Vec& q, int count) {
  const Index finite = finite_modes(system);
  if (finite == 0 || count == 0) return {};
  std::vector<Mode> modes;
  if (finite <= most_whole) {
    const NaturalModes all = lowest_modes(system, q, finite);
    append(modes, all, 0, largest_omega(all));
    return spread(std::move(modes), count);
  }
  const Index half = (count + 1) / 2;
  const NaturalModes high = highest_modes(system, q, half), low = lowest_modes(system, q, half);
  append(modes, low, 0, largest_omega(high));
  append(modes, high, finite - half, largest_omega(high));
  return modes;
}

}  // namespace

std::vector<Mode> sampled_modes(const System& system, const Vec& q, int count) {
  std::vector<Mode> modes = undamped_modes(system, q, count);
  for (Mode& mode : modes) mode.zeta = damping_ratio(system, q, mode.shape, mode.omega);
  return modes;
}

double buckling_rate(const System& system, const Vec& q) {
  if (finite_modes(system) == 0) return 0;
  if (curvature_signs(system, q).negative == 0) return 0;
  return std::sqrt(std::max(0.0, -lowest_modes(system, q, 1).squares[0]));
}

double resolved_frequency(const Method& method, const System& system, const Vec& q) {
  if (!method.asks(Need::split_forces) || method.is(Trait::implicit))
    return frequency_bound(system, q);
  if (const Split* split = system.split()) return frequency_bound(*split->soft, q);
  double largest = 0;
  Index first = 0;
  for (const auto& block : system.blocks()) {
    const Vec own = q.segment(first, block->size());
    largest = std::max(largest, resolved_frequency(method, *block, own));
    first += block->size();
  }
  return largest;
}

}  // namespace qddot::inline measure
