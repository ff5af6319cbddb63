#include "qddot/scene/reduce/series.hpp"

namespace qddot::reduce {
namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

class Condenser {
 public:
  Condenser(const std::vector<Node>& nodes, std::vector<Spring>& springs,
            std::optional<double> stiff_above, const std::vector<bool>& is_on_line)
      : nodes_(nodes),
        springs_(springs),
        stiff_above_(stiff_above),
        is_on_line_(is_on_line),
        touching_(nodes.size()),
        is_seen_(nodes.size(), false) {
    for (std::size_t e = 0; e < springs.size(); ++e) {
      for (const std::size_t node : springs[e].nodes) {
        if (is_massless(node)) touching_[node].push_back(e);
      }
    }
  }

  std::vector<Series> condense() {
    std::vector<Series> all;
    std::vector<bool> is_gone(springs_.size(), false);
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      if (!is_joint(node) || is_seen_[node]) continue;
      const auto series = series_through(node);
      if (!series) continue;
      for (const std::size_t e : chain_) is_gone[e] = true;
      all.push_back(*series);
    }
    if (all.empty()) return all;
    std::vector<Spring> left;
    for (std::size_t e = 0; e < springs_.size(); ++e) {
      if (!is_gone[e]) left.push_back(springs_[e]);
    }
    for (const Series& series : all)
      left.push_back({series.ends, series.law, series.holds, series.stiff});
    springs_ = std::move(left);
    return all;
  }

 private:
  bool is_massless(std::size_t node) const {
    return !nodes_[node].pinned && nodes_[node].mass == 0;
  }
  bool is_joint(std::size_t node) const {
    if (!is_massless(node) || touching_[node].size() != 2 || !nodes_[node].load.isZero(0))
      return false;
    for (const std::size_t e : touching_[node]) {
      const SpringLaw& law = springs_[e].law;
      if (law.quartic > 0 || law.stiffness == 0 || law.damping > 0 || !law.is_plain()) return false;
    }
    return true;
  }
  std::size_t other_end(std::size_t e, std::size_t node) const {
    const auto [a, b] = springs_[e].nodes;
    return a == node ? b : a;
  }

  // The springs and joints met from `node` along spring `e`, up to the first node that is no joint;
  // `none` if they lead back to `node`.
  std::size_t follow(std::size_t node, std::size_t e, std::vector<std::size_t>& chain,
                     std::vector<std::size_t>& joints) {
    const std::size_t start = node;
    while (true) {
      chain.push_back(e);
      node = other_end(e, node);
      if (node == start) return none;
      if (!is_joint(node)) return node;
      is_seen_[node] = true;
      joints.push_back(node);
      const auto& both = touching_[node];
      e = both[0] == e ? both[1] : both[0];
    }
  }

  // Leaves the springs in chain_.
  std::optional<Series> series_through(std::size_t node) {
    is_seen_[node] = true;
    std::vector<std::size_t> back_chain, back_joints, joints;
    chain_.clear();
    const std::size_t first = follow(node, touching_[node][0], back_chain, back_joints);
    if (first == none) return {};  // a ring of massless nodes
    joints.assign(back_joints.rbegin(), back_joints.rend());
    joints.push_back(node);
    chain_.assign(back_chain.rbegin(), back_chain.rend());
    const std::size_t last = follow(node, touching_[node][1], chain_, joints);
    if (first == last) return {};  // a loop that returns to its start
    return exact_series({first, last}, joints);
  }

  std::optional<Series> exact_series(std::array<std::size_t, 2> ends,
                                     const std::vector<std::size_t>& joints) const {
    double compliance = 0, rest_length = 0;
    for (const std::size_t e : chain_) {
      compliance += 1 / springs_[e].law.stiffness;
      rest_length += springs_[e].law.rest_length;
    }
    const double length = (nodes_[ends[1]].position - nodes_[ends[0]].position).norm();
    // A series drawn at its rest length may be shorter by rounding.
    if (length < (1 - 1e-12) * rest_length) return {};
    const SpringLaw law{.stiffness = 1 / compliance, .rest_length = rest_length};
    if (is_on_line_[joints.front()] && stays_folded(ends, joints, law.stiffness)) return {};
    const Holds holds = rest_length > 0 ? Holds::in_tension : Holds::always;
    Series series{ends, law, holds, is_stiff(law, stiff_above_), {}};
    double shift = 0, share = 0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      // L_e = l_e + k/k_e (l - l0).
      const SpringLaw& own = springs_[chain_[j]].law;
      const double part = law.stiffness / own.stiffness;
      shift += own.rest_length - part * rest_length;
      share += part;
      series.joints.push_back({joints[j], shift, share});
    }
    return series;
  }

  // Whether joints on a line stay folded (see series.hpp).
  bool stays_folded(std::array<std::size_t, 2> ends, const std::vector<std::size_t>& joints,
                    double stiffness) const {
    const Eigen::Vector3d along = nodes_[ends[1]].position - nodes_[ends[0]].position;
    std::vector<double> signs;
    double signed_rest_length = 0;
    bool is_folded = false;
    std::size_t from = ends[0];
    for (std::size_t e = 0; e < chain_.size(); ++e) {
      const std::size_t to = e < joints.size() ? joints[e] : ends[1];
      const double rest_length = springs_[chain_[e]].law.rest_length;
      const bool is_back = along.dot(nodes_[to].position - nodes_[from].position) < 0;
      signs.push_back(is_back ? -1 : 1);
      signed_rest_length += signs.back() * rest_length;
      is_folded |= is_back && rest_length > 0;
      from = to;
    }
    if (!is_folded) return false;
    if (joints.size() > 1) return true;
    const double tension = stiffness * (along.norm() - signed_rest_length);
    for (std::size_t e = 0; e < chain_.size(); ++e) {
      const SpringLaw& law = springs_[chain_[e]].law;
      if (law.rest_length > 0 && !(law.stiffness * law.rest_length + signs[e] * tension > 0)) {
        return false;
      }
    }
    return true;
  }

  const std::vector<Node>& nodes_;
  std::vector<Spring>& springs_;
  std::optional<double> stiff_above_;
  const std::vector<bool>& is_on_line_;
  std::vector<std::vector<std::size_t>> touching_;  // the springs of each massless node
  std::vector<bool> is_seen_;
  std::vector<std::size_t> chain_;
};

}  // namespace

void Series::place(std::vector<Node>& nodes) const {
  const Node &from = nodes[ends[0]], &to = nodes[ends[1]];
  const Eigen::Vector3d d = to.position - from.position, w = to.velocity - from.velocity;
  const double l = d.norm();
  const Eigen::Vector3d n = l > 0 ? Eigen::Vector3d(d / l) : Eigen::Vector3d::Zero();
  // n' = (w - n (n.w)) / l
  const Eigen::Vector3d turning =
      l > 0 ? Eigen::Vector3d((w - n * n.dot(w)) / l) : Eigen::Vector3d::Zero();
  for (const Joint& joint : joints) {
    nodes[joint.node].position = from.position + joint.shift * n + joint.share * d;
    nodes[joint.node].velocity = from.velocity + joint.shift * turning + joint.share * w;
  }
}

std::vector<Series> condense_series(const std::vector<Node>& nodes, std::vector<Spring>& springs,
                                    std::optional<double> stiff_above,
                                    const std::vector<bool>& is_on_line) {
  return Condenser(nodes, springs, stiff_above, is_on_line).condense();
}

}  // namespace qddot::reduce
