#include "qddot/model/massless_series.hpp"

#include <algorithm>
#include <optional>

namespace qddot {
namespace {

constexpr int fixed = -1;

// A spring as seen from one of its nodes.
struct Touching {
  int spring;  // counted from 0 among links, then anchors
  int other;   // node, or `fixed`
  Eigen::Vector3d point;
  SpringLaw law;
  bool folds;  // in compression
  int curve = -1;
};

class Joints {
 public:
  explicit Joints(const Network& network)
      : network_(network), touching_(static_cast<std::size_t>(network.node_mass.size())) {
    int spring = 0;
    for (const auto& [i, j, law, holds, stiff, direction] : network.links) {
      touching_[i].push_back({spring, j, {}, law, folds(holds)});
      touching_[j].push_back({spring++, i, {}, law, folds(holds)});
    }
    for (const auto& [i, point, law, holds, stiff, direction, curve] : network.anchors) {
      touching_[i].push_back({spring++, fixed, point, law, folds(holds), curve});
    }
    images_.resize(touching_.size());
    for (const auto& link : network.image_links) images_[link.i] = images_[link.j] = true;
  }

  bool is_joint(int node) const {
    if (node == fixed || network_.node_mass[node] > 0 || images_[node]) return false;
    const auto& both = touching_[node];
    if (both.size() != 2) return false;
    for (const Touching& one : both) {
      if (!one.folds) return false;
      if (one.law.quartic > 0 || !(one.law.stiffness > 0) || one.law.damping > 0) return false;
    }
    const auto drives = [&](const Network::DrivenLoad& load) { return load.i == node; };
    if (std::ranges::any_of(network_.driven_loads, drives)) return false;
    const int d = network_.dimension;
    return network_.load.size() == 0 || network_.load.segment(d * node, d).isZero(0);
  }

  // The series from its end `node` along its first spring; none if that leads to no joint.
  std::optional<MasslessSeries> from(int node, const Touching& first) const {
    double compliance = 0, rest_length = 0;
    const Touching* at = &first;
    int last = node;
    while (true) {
      compliance += 1 / at->law.stiffness;
      rest_length += at->law.rest_length;
      if (!is_joint(at->other)) break;
      last = at->other;
      const auto& both = touching_[last];
      at = &both[both[0].spring == at->spring ? 1 : 0];
    }
    if (last == node || at->other == node || !(rest_length > 0)) return {};
    if (at->other != fixed && network_.node_mass[at->other] == 0) return {};
    return MasslessSeries{node,
                          at->other,
                          at->point,
                          {.stiffness = 1 / compliance, .rest_length = rest_length},
                          at->curve};
  }

  const std::vector<Touching>& touching(int node) const { return touching_[node]; }

 private:
  // Nothing folds on a line, unless it is what a plane or space was reduced to.
  bool folds(Holds holds) const { return network_.dimension > 1 || holds == Holds::in_tension; }

  const Network& network_;
  std::vector<std::vector<Touching>> touching_;
  std::vector<bool> images_;
};

}  // namespace

std::vector<MasslessSeries> massless_series(const Network& network) {
  std::vector<MasslessSeries> all;
  if ((network.node_mass.array() > 0).all()) return all;
  const Joints joints(network);
  for (int node = 0; node < network.node_mass.size(); ++node) {
    if (network.node_mass[node] == 0) continue;
    for (const Touching& first : joints.touching(node)) {
      const auto series = joints.is_joint(first.other) ? joints.from(node, first) : std::nullopt;
      // One between two nodes is found from either.
      if (series && (series->j < 0 || series->i < series->j)) all.push_back(*series);
    }
  }
  return all;
}

}  // namespace qddot
