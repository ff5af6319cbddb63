#include "qddot/measure/motion/strains.hpp"

#include <cmath>
#include <limits>

namespace qddot::inline measure {
namespace {

// Looks in each step. The largest value on a parabola between two of them is missed by a part of
// 1/64 of its height in the step.
constexpr int looks_a_step = 4;

void keep(Extreme& extreme, double value, double t, double sign) {
  if (sign * value > sign * extreme.value) extreme = {value, t};
}

}  // namespace

Strains::Strains(const Scene& scene, const Model& model)
    : scene_(scene), model_(model), rods_(model.system()) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const SpringExtremes unseen{{-none, 0}, {none, 0}, {-none, 0}, {none, 0}};
  extremes_.assign(scene.springs.size(), unseen);
  is_broken_.assign(scene.springs.size(), false);
}

void Strains::see(const State& state) {
  std::swap(before_, now_);
  model_.expand(state, now_);
  const bool is_start = before_.empty();
  const double h = state.t - t_before_;
  for (std::size_t e = 0; e < scene_.springs.size(); ++e) {
    if (is_broken_[e] || scene_.springs[e].law.rigid) continue;
    const auto [a, b] = scene_.springs[e].nodes;
    const auto apart = [&](const std::vector<Node>& nodes, Eigen::Vector3d Node::*which) {
      return Eigen::Vector3d(nodes[b].*which - nodes[a].*which);
    };
    const Eigen::Vector3d d = apart(now_, &Node::position), w = apart(now_, &Node::velocity);
    if (!is_start && h > 0) {
      const Eigen::Vector3d d0 = apart(before_, &Node::position),
                            w0 = apart(before_, &Node::velocity);
      for (int look = 1; look < looks_a_step; ++look) {
        // Hermite's cubic and its derivative at the part s of the step.
        const double s = static_cast<double>(look) / looks_a_step, r = 1 - s;
        const Eigen::Vector3d between =
            r * r * (1 + 2 * s) * d0 + s * s * (3 - 2 * s) * d + h * s * r * (r * w0 - s * w);
        const Eigen::Vector3d rate =
            6 * s * r / h * (d - d0) + r * (1 - 3 * s) * w0 + s * (3 * s - 2) * w;
        see_spring(e, t_before_ + s * h, between, rate);
      }
    }
    see_spring(e, state.t, d, w);
  }
  if (state.phases) {
    const std::vector<std::size_t>& general = model_.general_springs();
    for (std::size_t k = 0; k < general.size(); ++k) {
      if ((*state.phases)[k] == Phase::broken) is_broken_[general[k]] = true;
    }
  }
  see_rods(state);
  t_before_ = state.t;
}

void Strains::see_rods(const State& state) {
  const std::vector<std::size_t>& rods = model_.rods();
  if (rods.empty()) return;
  const Vec tensions = model_.tensions_by(rods_.at(state));
  for (std::size_t k = 0; k < rods.size(); ++k) {
    SpringExtremes& own = extremes_[rods[k]];
    keep(own.largest_tension, tensions[static_cast<Index>(k)], state.t, 1);
    keep(own.smallest_tension, tensions[static_cast<Index>(k)], state.t, -1);
    keep(own.largest_strain, 0, state.t, 1);
    keep(own.smallest_strain, 0, state.t, -1);
  }
}

void Strains::see_spring(std::size_t e, double t, const Eigen::Vector3d& d,
                         const Eigen::Vector3d& rate) {
  const SpringLaw& law = scene_.springs[e].law;
  const double l = d.norm();
  double tension = law.tension(l);
  if (l > 0 && !law.is_slack(l)) tension += law.damping * rate.dot(d) / l;
  SpringExtremes& own = extremes_[e];
  keep(own.largest_tension, tension, t, 1);
  keep(own.smallest_tension, tension, t, -1);
  if (law.rest_length == 0) return;
  const double strain = l / law.rest_length - 1;
  keep(own.largest_strain, strain, t, 1);
  keep(own.smallest_strain, strain, t, -1);
}

}  // namespace qddot::inline measure
