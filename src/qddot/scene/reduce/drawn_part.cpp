#include "qddot/scene/reduce/drawn_part.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "qddot/scene/reduce/node_order.hpp"

namespace qddot::reduce {
namespace {

// Each coordinate is zero or, if all points are far from zero for the size of the whole, that of
// the first point. Then no two values of a coordinate differ by more than a quarter, so that their
// differences are exact (Sterbenz).
Eigen::Vector3d local_origin(const std::vector<Eigen::Vector3d>& x) {
  constexpr double far = 4;
  Eigen::Vector3d low = x.front(), high = x.front();
  for (const Eigen::Vector3d& point : x) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double size = (high - low).maxCoeff();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (int d = 0; d < 3; ++d) {
    if (std::max(std::abs(low[d]), std::abs(high[d])) > far * size) origin[d] = x.front()[d];
  }
  return origin;
}

// Whether all bits are zero, too, so that nothing is lost where such a vector is left out.
bool is_plus_zero(const Eigen::Vector3d& v) {
  return std::ranges::all_of(v, [](double x) { return x == 0 && !std::signbit(x); });
}

// The place of each number in a list: looked up where the list has few gaps or does not ascend,
// else searched for.
class PlaceOf {
 public:
  explicit PlaceOf(std::span<const std::size_t> list) : list_(list) {
    constexpr std::size_t most_gaps = 4;
    if (list.empty()) return;
    const auto [least, largest] = std::ranges::minmax(list);
    if (largest - least > most_gaps * list.size() && std::ranges::is_sorted(list)) return;
    least_ = least;
    places_.resize(largest - least + 1);
    for (std::size_t i = 0; i < list.size(); ++i) places_[list[i] - least] = static_cast<int>(i);
  }
  int operator()(std::size_t number) const {
    if (!places_.empty()) return places_[number - least_];
    return static_cast<int>(std::ranges::lower_bound(list_, number) - list_.begin());
  }

 private:
  std::span<const std::size_t> list_;
  std::size_t least_ = 0;
  std::vector<int> places_;
};

// The chosen springs, with their ends by the part's numbers.
PartSprings renumbered(const DrawnPart& drawn, std::vector<int> chosen,
                       const std::vector<Node>& nodes, const std::vector<Spring>& springs) {
  const std::span all(drawn.nodes);
  const PlaceOf free(all.first(drawn.free)), pinned(all.subspan(drawn.free));
  const auto number = [&](std::size_t node) {
    return nodes[node].pinned ? static_cast<int>(drawn.free) + pinned(node) : free(node);
  };
  std::vector<std::array<int, 2>> ends;
  ends.reserve(chosen.size());
  for (const int e : chosen) {
    const auto [a, b] = springs[static_cast<std::size_t>(e)].nodes;
    ends.push_back({number(a), number(b)});
  }
  return {springs, std::move(chosen), std::move(ends)};
}

}  // namespace

DrawnPart drawn_part(PartMembers members, const std::vector<Node>& nodes,
                     const std::vector<Spring>& springs, const Scene& scene) {
  DrawnPart drawn{.nodes = {members.nodes.begin(), members.nodes.end()},
                  .free = members.nodes.size(),
                  .gravity = scene.gravity};
  const auto ends_of = [&](int e) { return springs[static_cast<std::size_t>(e)].nodes; };
  std::vector<std::size_t> pins;
  for (const int e : members.springs) {
    for (const std::size_t node : ends_of(e)) {
      if (nodes[node].pinned) pins.push_back(node);
    }
  }
  std::ranges::sort(pins);
  pins.erase(std::unique(pins.begin(), pins.end()), pins.end());
  drawn.nodes.insert(drawn.nodes.end(), pins.begin(), pins.end());
  drawn.springs = renumbered(drawn, std::move(members.springs), nodes, springs);
  gather_scattered_nodes(drawn);

  drawn.x.reserve(drawn.nodes.size());
  drawn.mass.reserve(drawn.nodes.size());
  double total_mass = 0;
  bool is_loaded = false, moves = false;
  for (const std::size_t i : drawn.nodes) {
    const Node& node = nodes[i];
    drawn.x.push_back(node.position);
    drawn.mass.push_back(node.pinned ? 0 : node.mass);
    is_loaded = is_loaded || !node.acting_load().isZero(0);
    moves = moves || !(node.pinned || is_plus_zero(node.velocity));
    total_mass += drawn.mass.back();
  }
  if (moves) {
    drawn.v.reserve(drawn.nodes.size());
    for (const std::size_t i : drawn.nodes) {
      drawn.v.push_back(nodes[i].pinned ? Eigen::Vector3d::Zero() : nodes[i].velocity);
    }
  }
  if (is_loaded) {
    for (const std::size_t i : drawn.nodes) drawn.load.push_back(nodes[i].acting_load());
  }
  if (total_mass == 0) {
    drawn.gravity.setZero();
  } else {
    drawn.gravity_curve = scene.gravity_curve;
  }
  const auto has_curve = [&](std::size_t i) { return nodes[i].curve >= 0; };
  if (drawn.gravity_curve >= 0 || std::ranges::any_of(drawn.nodes, has_curve)) {
    drawn.curves = scene.curves;
    for (const std::size_t i : drawn.nodes) drawn.curve_of.push_back(nodes[i].curve);
  }
  drawn.gravity_noise = rounding * drawn.gravity.norm();
  drawn.origin = local_origin(drawn.x);
  for (Eigen::Vector3d& x : drawn.x) x -= drawn.origin;
  return drawn;
}

PartSprings drawn_springs(const DrawnPart& drawn, const std::vector<Node>& nodes,
                          const std::vector<Spring>& springs) {
  std::vector<bool> is_own(nodes.size(), false);
  for (std::size_t i = 0; i < drawn.free; ++i) is_own[drawn.nodes[i]] = true;
  std::vector<int> chosen;
  for (int e = 0; e < std::ssize(springs); ++e) {
    const auto [a, b] = springs[static_cast<std::size_t>(e)].nodes;
    if (is_own[a] || is_own[b]) chosen.push_back(e);
  }
  return renumbered(drawn, std::move(chosen), nodes, springs);
}

double largest_coordinate(const std::vector<Eigen::Vector3d>& vectors) {
  double largest = 0;
  for (const Eigen::Vector3d& x : vectors) {
    largest = std::max(largest, x.lpNorm<Eigen::Infinity>());
  }
  return largest;
}

}  // namespace qddot::reduce
