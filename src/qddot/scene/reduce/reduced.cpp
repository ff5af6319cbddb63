#include "qddot/scene/reduce/reduced.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/scene/reduce/as_drawn.hpp"
#include "qddot/scene/reduce/springs.hpp"
#include "qddot/scene/reduce/words.hpp"

namespace qddot::reduce {
namespace {

std::logic_error defect(const std::string& difference) {
  return std::logic_error(fmt::format(
      "a defect of qddot, please report the scene: with its reductions {} (--no-reduce leaves them "
      "out)",
      difference));
}

std::string energy_instead_of(double reduced, double drawn) {
  return fmt::format("the energy at the start would be {:.10g} J instead of {:.10g}", reduced,
                     drawn);
}

// Whether the part of each node never leaves a line.
std::vector<bool> on_lines(const std::vector<Node>& nodes, const std::vector<Spring>& springs,
                           const Eigen::Vector3d& gravity, int dimension) {
  std::vector<bool> is_on_line(nodes.size(), dimension == 1);
  if (dimension == 1) return is_on_line;
  for (const PartMembers& members : parts_of(nodes, springs)) {
    DrawnPart drawn = drawn_part(members, nodes, springs, gravity);
    let_fall(drawn);  // a part stays on its line when it falls, whether that is reduced or not
    if (frame_of(drawn, dimension).dimension > 1) continue;
    for (const std::size_t node : members.nodes) is_on_line[node] = true;
  }
  return is_on_line;
}

}  // namespace

Reduced::Reduced(const Scene& scene, const Reductions& reductions)
    : nodes_(scene.nodes),
      dimension_(scene.dimension),
      gravity_(scene.gravity),
      stiff_above_(scene.stiff_above) {
  for (Node& node : nodes_) {
    if (node.pinned) node.velocity.setZero();
  }
  if (reductions.has(Reduction::pins)) leave_out_pins();
  std::vector<Spring> springs = scene.springs;
  for (Spring& spring : springs) spring.stiff = is_stiff(spring.law, stiff_above_);
  if (reductions.has(Reduction::duplicates)) merge(springs);
  if (reductions.has(Reduction::massless)) condense(springs);
  leave_out_static_springs(springs);
  build(divide(springs, reductions), springs, reductions);
  check(scene);
}

Reduced::Reduced(std::shared_ptr<const System> system, State initial, int dimension)
    : is_own_(true),
      dimension_(dimension),
      system_(std::move(system)),
      initial_(std::move(initial)) {
  if (!system_) throw std::invalid_argument("there is no system");
  const Index n = system_->size();
  if (dimension_ < 1 || dimension_ > 3 || n % dimension_ != 0) {
    throw std::invalid_argument(fmt::format(
        "dimension {} is not allowed; it is 1, 2 or 3 and divides the {} unknowns", dimension_, n));
  }
  if (initial_.q.size() != n || initial_.v.size() != n) {
    throw std::invalid_argument(
        fmt::format("the start has {} positions and {} velocities, and the system {} unknowns",
                    initial_.q.size(), initial_.v.size(), n));
  }
  nodes_.resize(static_cast<std::size_t>(n / dimension_));
  Index first = 0;
  for (Node& node : nodes_) {
    node.mass = system_->mass()[first];
    first += dimension_;
  }
}

void Reduced::leave_out_pins() {
  const auto pins = static_cast<std::size_t>(std::ranges::count(nodes_, true, &Node::pinned));
  if (pins > 0) report(Reduction::pins, pinned_sentence(pins));
}

void Reduced::merge(std::vector<Spring>& springs) {
  const std::size_t before = springs.size();
  springs = merged_springs(springs);
  if (springs.size() < before) {
    report(Reduction::duplicates, merged_sentence(before - springs.size(), springs.size()));
  }
}

void Reduced::condense(std::vector<Spring>& springs) {
  if (std::ranges::none_of(nodes_, [](const Node& n) { return !n.pinned && n.mass == 0; })) return;
  series_ = condense_series(nodes_, springs, stiff_above_,
                            on_lines(nodes_, springs, gravity_, dimension_));
  if (series_.empty()) return;
  std::vector<std::size_t> condensed;
  for (const Series& series : series_) {
    series.place(nodes_);
    for (const auto& joint : series.joints) condensed.push_back(joint.node);
  }
  report(Reduction::massless, condensed_sentence(condensed, series_.size()));
}

void Reduced::leave_out_static_springs(const std::vector<Spring>& springs) {
  for (const auto& [ends, law, holds, stiff] : springs) {
    const Node &a = nodes_[ends[0]], &b = nodes_[ends[1]];
    if (a.pinned && b.pinned) static_energy_ += law.energy((b.position - a.position).norm());
  }
}

std::vector<PartMembers> Reduced::divide(const std::vector<Spring>& springs,
                                         const Reductions& reductions) {
  std::vector<bool> is_condensed(nodes_.size(), false);
  for (const Series& series : series_) {
    for (const auto& joint : series.joints) is_condensed[joint.node] = true;
  }
  std::vector<PartMembers> parts;
  std::vector<std::size_t> flying;
  for (PartMembers& members : parts_of(nodes_, springs)) {
    const std::size_t first = members.nodes.front();
    if (is_condensed[first]) continue;  // it is on no spring any more
    if (members.springs.empty() && reductions.has(Reduction::free_flight)) {
      const Node& node = nodes_[first];
      Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
      if (node.mass > 0) acceleration = gravity_ + node.load / node.mass;
      flying_.push_back({first, node.velocity, acceleration});
      flying.push_back(first);
    } else {
      parts.push_back(std::move(members));
    }
  }
  if (!flying.empty()) report(Reduction::free_flight, flying_sentence(flying));
  if (!reductions.has(Reduction::parts)) return joined(parts);
  if (parts.size() > 1) report(Reduction::parts, parts_sentence(parts.size()));
  return parts;
}

void Reduced::build(const std::vector<PartMembers>& parts, const std::vector<Spring>& springs,
                    const Reductions& reductions) {
  std::vector<std::unique_ptr<System>> systems;
  Index n = 0;
  for (const PartMembers& members : parts) {
    const std::optional<DrawnPart> drawn = moving_part(members, springs, reductions);
    if (!drawn) continue;
    Part& part = parts_.emplace_back(faithful_part(*drawn, reductions));
    systems.push_back(part.take_system());
    static_energy_ += part.energy_of_origin();
    n += part.initial().q.size();
  }
  initial_ = {0, Vec(n), Vec(n)};
  Index at = 0;
  for (const Part& part : parts_) {
    const Index own = part.initial().q.size();
    initial_.q.segment(at, own) = part.initial().q;
    initial_.v.segment(at, own) = part.initial().v;
    at += own;
  }
  const auto falling = static_cast<std::size_t>(
      std::ranges::count_if(parts_, [](const Part& part) { return part.fall().moves(); }));
  const bool is_loaded = std::ranges::any_of(parts_, &Part::is_loaded);
  if (falling + resting_ > 0)
    report(Reduction::falling, falling_sentence(falling, resting_, is_loaded));
  for (Finding& finding : findings_of(parts_, systems, dimension_)) {
    findings_.push_back(std::move(finding));
  }
  if (systems.empty()) {
    system_ = make_mass_spring({.dimension = dimension_, .offers_split = stiff_above_.has_value()});
  } else if (systems.size() == 1) {
    system_ = std::move(systems.front());
  } else {
    system_ = std::make_unique<BlockDiagonalSystem>(std::move(systems));
  }
}

std::optional<DrawnPart> Reduced::moving_part(const PartMembers& members,
                                              const std::vector<Spring>& springs,
                                              const Reductions& reductions) {
  DrawnPart drawn = drawn_part(members, nodes_, springs, gravity_);
  drawn.offers_split = stiff_above_.has_value();
  if (!reductions.has(Reduction::falling)) return drawn;
  let_fall(drawn);
  if (!rests(drawn)) return drawn;
  ++resting_;
  for (const std::size_t node : drawn.nodes) {
    flying_.push_back({node, drawn.fall.velocity, drawn.fall.gravity});
  }
  return {};
}

Part Reduced::faithful_part(const DrawnPart& drawn, Reductions reductions) {
  Part part(drawn, dimension_, reductions);
  for (const Reduction suspect :
       {Reduction::mirror, Reduction::dimension, Reduction::constant_stiffness}) {
    if (!reductions.has(suspect)) continue;
    const auto difference = part.difference_from(drawn);
    if (!difference) return part;
    report(suspect, mistaken_sentence(*difference));
    reductions = reductions.without(suspect);
    part = Part(drawn, dimension_, reductions);
  }
  if (const auto difference = part.difference_from(drawn)) throw defect(*difference);
  return part;
}

void Reduced::check(const Scene& scene) const {
  std::vector<int> places(nodes_.size(), 0);
  for (const Part& part : parts_) {
    for (const std::size_t node : part.nodes()) ++places[node];
  }
  for (const Flying& flying : flying_) ++places[flying.node];
  for (const Series& series : series_) {
    for (const auto& joint : series.joints) ++places[joint.node];
  }
  std::vector<Node> nodes;
  expand(initial_, true, nodes);
  std::vector<Eigen::Vector3d> x, v;
  std::vector<double> mass;
  std::vector<Eigen::Vector3d> load;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (places[i] != (nodes[i].pinned ? 0 : 1)) {
      throw defect(fmt::format("node {} has {} places", i, places[i]));
    }
    x.push_back(nodes[i].position);
    v.push_back(nodes[i].velocity);
    mass.push_back(nodes[i].pinned ? 0 : nodes[i].mass);
    load.push_back(nodes[i].acting_load());
  }
  const Tolerances tolerances = tolerances_of(x, v);
  const BoundedEnergy t = kinetic_of(v, mass, tolerances);
  const BoundedEnergy p = potential_of(scene.springs, x, mass, gravity_, load, tolerances);
  if (differs(t, kinetic(initial_))) throw defect(energy_instead_of(kinetic(initial_), t.value));
  if (differs(p, potential(initial_)))
    throw defect(energy_instead_of(potential(initial_), p.value));
}

void Reduced::expand(const State& state, bool falls, std::vector<Node>& nodes) const {
  if (nodes.empty()) nodes = nodes_;
  if (is_own_) return expand_own(state, nodes);
  Index at = 0;
  for (const Part& part : parts_) {
    const Index n = part.initial().q.size();
    const Fall fall = falls ? part.fall() : Fall{};
    part.expand(state.q.segment(at, n), state.v.segment(at, n), fall.displacement(state.t),
                fall.velocity_at(state.t), nodes);
    at += n;
  }
  for (const Flying& flying : flying_) {
    Node& node = nodes[flying.node];
    node.position = nodes_[flying.node].position;
    if (falls) node.position += flying.displacement(state.t);
    node.velocity = falls ? flying.velocity_at(state.t) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  for (const Series& series : series_) series.place(nodes);
}

void Reduced::expand_own(const State& state, std::vector<Node>& nodes) const {
  Index at = 0;
  for (Node& node : nodes) {
    node.position.head(dimension_) = state.q.segment(at, dimension_);
    node.velocity.head(dimension_) = state.v.segment(at, dimension_);
    at += dimension_;
  }
}

std::vector<double> Reduced::largest_by_part(const Vec& x) const {
  if (is_own_) {
    if (x.size() == 0) return {};
    const auto squares = x.reshaped(dimension_, x.size() / dimension_).colwise().squaredNorm();
    return {std::sqrt(squares.maxCoeff<Eigen::PropagateNaN>())};
  }
  std::vector<double> largest;
  if (!series_.empty()) return largest;
  Index at = 0;
  for (const Part& part : parts_) {
    const Index n = part.initial().q.size();
    largest.push_back(part.largest(x.segment(at, n)));
    at += n;
  }
  return largest;
}

std::vector<std::vector<std::size_t>> Reduced::nodes_by_part() const {
  if (is_own_) {
    std::vector<std::size_t> all(nodes_.size());
    std::iota(all.begin(), all.end(), 0);
    return {all};
  }
  std::vector<std::vector<std::size_t>> nodes;
  std::vector<std::size_t> part_of(nodes_.size(), parts_.size());
  for (const Part& part : parts_) {
    for (const std::size_t node : part.nodes()) part_of[node] = nodes.size();
    nodes.push_back(part.nodes());
  }
  for (const Series& series : series_) {
    const std::size_t part = std::min(part_of[series.ends[0]], part_of[series.ends[1]]);
    if (part == parts_.size()) continue;  // a spring between two pinned nodes
    for (const auto& joint : series.joints) nodes[part].push_back(joint.node);
  }
  return nodes;
}

std::vector<Index> Reduced::unknowns_by_part() const {
  if (is_own_) return {system_->size()};
  std::vector<Index> unknowns;
  for (const Part& part : parts_) unknowns.push_back(part.initial().q.size());
  return unknowns;
}

std::vector<std::size_t> Reduced::massless_nodes() const {
  std::vector<std::size_t> massless;
  for (Index first = 0; is_own_ && first < system_->size(); first += dimension_) {
    if ((system_->mass().segment(first, dimension_).array() == 0).any())
      massless.push_back(static_cast<std::size_t>(first / dimension_));
  }
  for (const Part& part : parts_) {
    for (const std::size_t node : part.nodes()) {
      if (nodes_[node].mass == 0) massless.push_back(node);
    }
  }
  std::ranges::sort(massless);
  return massless;
}

template <class Action>
void Reduced::for_falling(const State& state, const Action& action) const {
  Index at = 0;
  for (const Part& part : parts_) {
    const Index n = part.initial().q.size();
    if (part.fall().moves()) {
      action(part.fall(), part.moments(state.q.segment(at, n), state.v.segment(at, n)));
    }
    at += n;
  }
}

double Reduced::kinetic(const State& state) const {
  double energy = system_->kinetic(state.v);
  for (const Flying& flying : flying_) {
    energy += 0.5 * nodes_[flying.node].mass * flying.velocity_at(state.t).squaredNorm();
  }
  for_falling(state, [&](const Fall& fall, const Part::Moments& moments) {
    const Eigen::Vector3d v = fall.velocity_at(state.t);
    energy += moments.momentum.dot(v) + 0.5 * fall.mass * v.squaredNorm();
  });
  return energy;
}

double Reduced::potential(const State& state) const {
  double energy = system_->potential(state.q) + static_energy_;
  for (const Flying& flying : flying_) {
    const Node& node = nodes_[flying.node];
    energy -= node.mass * flying.gravity.dot(node.position + flying.displacement(state.t));
  }
  for_falling(state, [&](const Fall& fall, const Part::Moments& moments) {
    energy -= fall.gravity.dot(moments.first + fall.mass * fall.displacement(state.t));
  });
  return energy;
}

double Reduced::energy(const State& state) const {
  double energy = total_energy(*system_, state) + static_energy_;
  for (const Flying& flying : flying_) {
    const Node& node = nodes_[flying.node];
    energy += node.mass * (0.5 * flying.velocity.squaredNorm() - flying.gravity.dot(node.position));
  }
  for_falling(state, [&](const Fall& fall, const Part::Moments& moments) {
    energy += moments.momentum.dot(fall.velocity_at(state.t)) +
              0.5 * fall.mass * fall.velocity.squaredNorm() - fall.gravity.dot(moments.first);
  });
  return energy;
}

}  // namespace qddot::reduce
