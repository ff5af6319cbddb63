#include "qddot/scene/reduce/part.hpp"

#include <cmath>
#include <map>
#include <tuple>

#include "qddot/model/constrained_system.hpp"
#include "qddot/scene/reduce/folded_part.hpp"
#include "qddot/scene/reduce/straight.hpp"

namespace qddot::reduce {
namespace {

constexpr int no_number = -1;

// The originals' numbers in the network, of free ones only or of pinned ones too.
std::vector<int> numbers_of(const DrawnPart& drawn, const FoldedNodes& half, bool with_pins) {
  std::vector<int> numbers(drawn.nodes.size(), no_number);
  int next = 0;
  for (std::size_t i = 0; i < (with_pins ? drawn.nodes.size() : drawn.free); ++i) {
    if (half.images[i].original == static_cast<int>(i)) numbers[i] = next++;
  }
  return numbers;
}

// The curves of a network: those of the drawn part, in its frame and mirrored.
class FoldedCurves {
 public:
  FoldedCurves(const DrawnPart& drawn, const Frame& frame, Network& network)
      : drawn_(drawn), turn_(frame.axes.transpose()), network_(network) {
    for (int d = frame.dimension; d < 3; ++d) turn_.row(d).setZero();
  }

  // The number in the network of the curve `drawn`, or -1, times these signs.
  int number(int drawn, const Eigen::Vector3d& signs) {
    if (drawn < 0) return -1;
    const auto key = std::tuple(drawn, signs[0], signs[1], signs[2]);
    const auto [place, is_new] = numbers_.try_emplace(key, static_cast<int>(numbers_.size()));
    if (is_new) {
      network_.curves.push_back(
          drawn_.curves[static_cast<std::size_t>(drawn)].turned(signs.asDiagonal() * turn_));
    }
    return place->second;
  }
  // The same of a node.
  int of_node(std::size_t i, const Eigen::Vector3d& signs) {
    return drawn_.is_driven() ? number(drawn_.curve_of[i], signs) : -1;
  }

 private:
  const DrawnPart& drawn_;
  Eigen::Matrix3d turn_;
  Network& network_;
  std::map<std::tuple<int, double, double, double>, int> numbers_;
};

void add_spring(const FoldedSpring& spring, const FoldedNodes& half,
                const std::vector<int>& numbers, FoldedCurves& curves, Network& network) {
  const auto& [a, b, mirror] = spring.ends;
  const auto& [ends, law, holds, stiff, first] = spring;
  const auto from = static_cast<std::size_t>(a), to = static_cast<std::size_t>(b);
  const int i = numbers[from], j = numbers[to];
  const Eigen::Vector3d signs = mirror.diagonal();
  if (law.rigid) {
    const std::size_t pin = i == no_number ? from : to;
    const bool is_anchor = i == no_number || j == no_number;
    const Eigen::Vector3d point =
        is_anchor ? signs.cwiseProduct(half.y[pin]) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    network.rods.push_back({i == no_number ? j : i, is_anchor ? -1 : j, point, law.rest_length,
                            is_anchor ? curves.of_node(pin, signs) : -1,
                            law.stiffness > 0 ? 1 / law.stiffness : 0, signs});
  } else if (!law.is_plain()) {  // in a part without mirrors
    const std::size_t pin = i == no_number ? from : to;
    const bool is_anchor = i == no_number || j == no_number;
    network.general.push_back({i == no_number ? j : i, is_anchor ? -1 : j,
                               is_anchor ? half.y[pin] : Eigen::Vector3d(Eigen::Vector3d::Zero()),
                               law, stiff, is_anchor ? curves.of_node(pin, signs) : -1,
                               static_cast<int>(network.general.size())});
  } else if (i == no_number) {
    network.anchors.push_back(
        {j, signs.cwiseProduct(half.y[from]), law, holds, stiff, 0, curves.of_node(from, signs)});
  } else if (j == no_number) {
    network.anchors.push_back(
        {i, signs.cwiseProduct(half.y[to]), law, holds, stiff, 0, curves.of_node(to, signs)});
  } else if (!mirror.are_all_plus()) {
    network.image_links.push_back({i, j, signs, law, holds, stiff});
  } else {
    network.links.push_back({i, j, law, holds, stiff});
  }
}

bool has_moving_pins(const DrawnPart& drawn) {
  for (std::size_t i = drawn.free; i < drawn.nodes.size(); ++i) {
    if (drawn.curve(i)) return true;
  }
  return false;
}

// Massless nodes on two springs, by the part's numbers. In compression they fold up across the
// line, in a direction that a one-dimensional network does not have.
std::vector<bool> joints_of(const DrawnPart& drawn) {
  std::vector<int> springs(drawn.nodes.size(), 0);
  for (int e = 0; e < drawn.springs.size(); ++e) {
    for (const int i : drawn.springs.ends(e)) ++springs[static_cast<std::size_t>(i)];
  }
  std::vector<bool> joints;
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    joints.push_back(i < drawn.free && drawn.mass[i] == 0 && springs[i] == 2);
  }
  return joints;
}

}  // namespace

Part::Part(const DrawnPart& drawn, int dimension, const Reductions& reductions)
    : origin_(drawn.origin), fall_(drawn.fall), is_loaded_(drawn.is_loaded()) {
  Frame frame{.dimension = dimension};
  if (reductions.has(Reduction::dimension)) frame = frame_of(drawn, dimension);
  mirrors_.frame = frame;
  // Springs that are images of one another need not break in one order.
  if (reductions.has(Reduction::mirror) && !drawn.springs.have_general())
    mirrors_ = mirrors_of(drawn, frame);

  const bool with_pins =
      !reductions.has(Reduction::pins) && !has_moving_pins(drawn) && !drawn.springs.have_rods();
  make_network(drawn, dimension, with_pins);
  network_.uses_constant_stiffness = reductions.has(Reduction::constant_stiffness);
  network_.offers_split = drawn.offers_split;
  // That none turns over is proven by energy, which driving changes.
  if (network_.uses_constant_stiffness && !with_pins && !drawn.is_driven() &&
      network_.general.empty() && network_.rods.empty()) {
    if (auto straight = straightened(network_, initial_.q, initial_.v, is_loaded_)) {
      network_ = std::move(*straight);
      is_straightened_ = true;
    }
  }
  if (!with_pins) is_held_.clear();
}

void Part::make_system() {
  system_ = make_mass_spring(std::move(network_));
  network_ = {};
  if (!is_held_.empty())
    system_ = std::make_unique<ConstrainedSystem>(std::move(system_), std::move(is_held_));
}

// Folds the part along its mirrors, and makes a network of its originals.
void Part::make_network(const DrawnPart& drawn, int dimension, bool with_pins) {
  const int axes = mirrors_.frame.dimension;
  const FoldedNodes half = folded(drawn, mirrors_);
  const std::vector<int> numbers = numbers_of(drawn, half, with_pins);
  Network& network = network_;
  network.dimension = axes;
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    if (numbers[i] == no_number) continue;
    const int first = layout_.empty() ? 0 : layout_.back().first + layout_.back().count;
    Unknowns unknowns{first, 0, {}};
    for (int d = 0; d < axes; ++d) {
      if (half.on_planes[i] >> d & 1) continue;
      unknowns.axis[static_cast<std::size_t>(unknowns.count++)] = static_cast<std::int8_t>(d);
      is_held_.push_back(i >= drawn.free);
    }
    layout_.push_back(unknowns);
    if (mirrors_.count > 0) network.zero_coordinates.push_back(half.on_planes[i]);
  }
  set_initial(drawn, half, numbers, std::ssize(is_held_));

  const auto count = std::ssize(layout_);
  network.node_mass = Vec::Zero(count);
  network.load = Vec::Zero(axes * count);
  network.air_damping = drawn.air_damping;
  const Eigen::Vector3d g = mirrors_.frame.direction(drawn.gravity);
  FoldedCurves curves(drawn, mirrors_.frame, network);
  nodes_.reserve(drawn.free);
  masses_.reserve(drawn.free);
  images_.reserve(drawn.free);
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    const ImageOf image = half.images[i];
    const int number = numbers[static_cast<std::size_t>(image.original)];
    if (number == no_number) continue;
    // A pin carries the node's weight, so its mass may be any positive number.
    network.node_mass[number] += i < drawn.free ? drawn.mass[i] : 1;
    for (int d = 0; d < axes; ++d) network.load[axes * number + d] += drawn.mass[i] * g[d];
    network.constant_energy -= drawn.mass[i] * drawn.gravity.dot(mirrors_.frame.origin);
    energy_of_origin_ -= drawn.mass[i] * drawn.gravity.dot(origin_);
    if (is_loaded_) {
      // The force on an original is that on its images, mirrored back.
      const Eigen::Vector3d load =
          image.signs.diagonal().cwiseProduct(mirrors_.frame.direction(drawn.load[i]));
      for (int d = 0; d < axes; ++d) network.load[axes * number + d] += load[d];
      network.constant_energy -= drawn.load[i].dot(mirrors_.frame.origin);
      energy_of_origin_ -= drawn.load[i].dot(origin_);
    }
    if (i >= drawn.free) continue;
    const Eigen::Vector3d y = half.y[static_cast<std::size_t>(image.original)];
    if (drawn.is_driven() && drawn.curve_of[i] >= 0) {
      const int curve = curves.of_node(i, image.signs.diagonal());
      network.driven_loads.push_back({number, curve, 1, y});
    }
    if (drawn.gravity_curve >= 0 && drawn.mass[i] > 0) {
      const int curve = curves.number(drawn.gravity_curve, image.signs.diagonal());
      network.driven_loads.push_back({number, curve, drawn.mass[i], y});
    }
    nodes_.push_back(drawn.nodes[i]);
    masses_.push_back(drawn.mass[i]);
    images_.push_back({number, image.signs});
  }
  const FoldedSprings springs(drawn, half, mirrors_);
  network.links.reserve(springs.count());
  const bool may_fold = axes == 1 && dimension > 1;
  const std::vector<bool> joints = may_fold ? joints_of(drawn) : std::vector<bool>();
  springs.for_each([&](FoldedSpring spring) {
    const bool would_fold = may_fold && (joints[static_cast<std::size_t>(spring.ends.a)] ||
                                         joints[static_cast<std::size_t>(spring.ends.b)]);
    if (would_fold) spring.holds = Holds::in_tension;
    if (spring.law.rigid) note_rods(spring, springs, drawn);
    add_spring(spring, half, numbers, curves, network);
  });
  for (int e = 0; e < drawn.springs.size(); ++e) {
    if (drawn.springs.law(e).is_general()) general_.push_back(drawn.springs.number(e));
  }
}

// The images of a rod have one constraint, which holds the sum of their tensions.
void Part::note_rods(const FoldedSpring& rod, const FoldedSprings& springs,
                     const DrawnPart& drawn) {
  const std::vector<int> images = springs.images_of(rod);
  const double share = 1 / static_cast<double>(images.size());
  for (const int e : images) {
    rods_.push_back(drawn.springs.number(e));
    shares_.push_back({std::ssize(network_.rods), share});
  }
}

// The start of the originals. A coordinate that stays zero is no unknown.
void Part::set_initial(const DrawnPart& drawn, const FoldedNodes& half,
                       const std::vector<int>& numbers, Index size) {
  initial_ = {0, Vec(size), Vec(size)};
  Index at = 0;
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    if (numbers[i] == no_number) continue;
    const Eigen::Vector3d w = mirrors_.frame.direction(drawn.velocity_of(i));
    for (int d = 0; d < mirrors_.frame.dimension; ++d) {
      if (half.on_planes[i] >> d & 1) continue;
      initial_.q[at] = half.y[i][d];
      initial_.v[at++] = w[d];
    }
  }
}

Part::Motion Part::motion(std::size_t i, const Eigen::Ref<const Vec>& q,
                          const Eigen::Ref<const Vec>& v) const {
  const Image& image = images_[i];
  const Unknowns& unknowns = layout_[static_cast<std::size_t>(image.original)];
  const Eigen::Vector3d signs = image.signs.diagonal();
  Eigen::Vector3d y = Eigen::Vector3d::Zero(), w = Eigen::Vector3d::Zero();
  if (unknowns.count == 3) {  // most nodes in space
    y = signs.cwiseProduct(q.segment<3>(unknowns.first));
    w = signs.cwiseProduct(v.segment<3>(unknowns.first));
  } else {
    for (int a = 0; a < unknowns.count; ++a) {
      const int d = unknowns.axis[static_cast<std::size_t>(a)];
      y[d] = signs[d] * q[unknowns.first + a];
      w[d] = signs[d] * v[unknowns.first + a];
    }
  }
  return {mirrors_.frame.from_point(y), mirrors_.frame.from_direction(w)};
}

void Part::expand(const Eigen::Ref<const Vec>& q, const Eigen::Ref<const Vec>& v,
                  const Eigen::Vector3d& displacement, const Eigen::Vector3d& velocity,
                  std::vector<Node>& nodes) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Motion now = motion(i, q, v);
    nodes[nodes_[i]].position = origin_ + now.x + displacement;
    nodes[nodes_[i]].velocity = now.v + velocity;
  }
}

void Part::collect(const std::vector<Node>& nodes, const Eigen::Vector3d& displacement,
                   const Eigen::Vector3d& velocity, Eigen::Ref<Vec> q, Eigen::Ref<Vec> v) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!images_[i].signs.are_all_plus()) continue;
    const Unknowns& unknowns = layout_[static_cast<std::size_t>(images_[i].original)];
    const Node& node = nodes[nodes_[i]];
    const Eigen::Vector3d y = mirrors_.frame.point(node.position - origin_ - displacement),
                          w = mirrors_.frame.direction(node.velocity - velocity);
    for (int a = 0; a < unknowns.count; ++a) {
      q[unknowns.first + a] = y[unknowns.axis[static_cast<std::size_t>(a)]];
      v[unknowns.first + a] = w[unknowns.axis[static_cast<std::size_t>(a)]];
    }
  }
}

double Part::largest(const Eigen::Ref<const Vec>& x) const {
  double square = 0;
  for (const Unknowns& unknowns : layout_) {
    const double own = x.segment(unknowns.first, unknowns.count).squaredNorm();
    if (own > square || std::isnan(own)) square = own;
  }
  return std::sqrt(square);
}

Part::Moments Part::moments(const Eigen::Ref<const Vec>& q, const Eigen::Ref<const Vec>& v) const {
  Moments sums{fall_.mass * origin_, Eigen::Vector3d::Zero()};
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Motion now = motion(i, q, v);
    sums.first += masses_[i] * now.x;
    sums.momentum += masses_[i] * now.v;
  }
  return sums;
}

}  // namespace qddot::reduce
