#include "qddot/scene/model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "qddot/algebra/constraint_forces.hpp"
#include "qddot/scene/reduce/pieces.hpp"
#include "qddot/scene/reduce/start_check.hpp"

namespace qddot {
namespace {

using reduce::Fall;
using reduce::Part;
using reduce::Pieces;

// Calls action(its fall, its moments) for each part that falls as a whole.
template <class Action>
void for_falling(const std::vector<Part>& parts, const State& state, const Action& action) {
  Index at = 0;
  for (const Part& part : parts) {
    const Index n = part.unknowns();
    if (part.fall().moves()) {
      action(part.fall(), part.moments(state.q.segment(at, n), state.v.segment(at, n)));
    }
    at += n;
  }
}

void expand_own(int dimension, const State& state, std::vector<Node>& nodes) {
  Index at = 0;
  for (Node& node : nodes) {
    node.position.head(dimension) = state.q.segment(at, dimension);
    node.velocity.head(dimension) = state.v.segment(at, dimension);
    at += dimension;
  }
}

// Does Model::expand if `falls`, else expand_beside_falls. `nodes`: empty, or the result of an
// earlier call.
void expand_into(const Pieces& pieces, const State& state, bool falls, std::vector<Node>& nodes) {
  if (nodes.empty()) nodes = pieces.nodes;
  if (pieces.is_own) return expand_own(pieces.dimension, state, nodes);
  Index at = 0;
  for (const Part& part : pieces.parts) {
    const Index n = part.unknowns();
    const Fall fall = falls ? part.fall() : Fall{};
    part.expand(state.q.segment(at, n), state.v.segment(at, n), fall.displacement(state.t),
                fall.velocity_at(state.t), nodes);
    at += n;
  }
  for (const reduce::Flying& flying : pieces.flying) {
    Node& node = nodes[flying.node];
    node.position = pieces.nodes[flying.node].position;
    if (falls) node.position += flying.displacement(state.t);
    node.velocity = falls ? flying.velocity_at(state.t) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  for (const reduce::Moving& moving : pieces.moving) {
    Node& node = nodes[moving.node];
    node.position = pieces.nodes[moving.node].position + moving.curve.at(state.t);
    node.velocity = moving.curve.rate(state.t);
  }
  for (const reduce::Series& series : pieces.series) series.place(nodes);
}

// The energy at t [J] of springs between pinned nodes that move.
double energy_of_driven_springs(const Pieces& pieces, double t) {
  double energy = 0;
  for (const reduce::DrivenSpring& spring : pieces.driven_springs) {
    energy += spring.energy(pieces.nodes, pieces.curves, t);
  }
  return energy;
}

}  // namespace

Model::Model(const Scene& scene, const Reductions& reductions) {
  const std::optional<Scene> placed = with_supports_at_start(scene);
  const Scene& start = placed ? *placed : scene;
  pieces_ = std::make_unique<Pieces>(reduce::pieces_of(start, reductions));
  reduce::require_drawn_start(*this, *pieces_, start);
}

Model::Model(std::shared_ptr<const System> system, State initial, int dimension)
    : pieces_(std::make_unique<Pieces>(
          reduce::pieces_of(std::move(system), std::move(initial), dimension))) {}

Model::~Model() = default;
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model&&) noexcept = default;

Model Model::with_system(std::shared_ptr<const System> system) && {
  pieces_->system = std::move(system);
  return std::move(*this);
}

const System& Model::system() const { return *pieces_->system; }
const State& Model::initial() const { return pieces_->initial; }
int Model::dimension() const { return pieces_->dimension; }
const std::vector<Finding>& Model::findings() const { return pieces_->findings; }
const std::vector<reduce::Part>& Model::parts() const { return pieces_->parts; }

std::vector<Node> Model::expand(const State& state) const {
  std::vector<Node> nodes;
  expand(state, nodes);
  return nodes;
}

void Model::expand(const State& state, std::vector<Node>& nodes) const {
  expand_into(*pieces_, state, true, nodes);
}

std::vector<Node> Model::expand_beside_falls(const State& state) const {
  std::vector<Node> nodes;
  expand_into(*pieces_, state, false, nodes);
  return nodes;
}

State Model::collect(const std::vector<Node>& nodes, double t) const {
  State state{t, Vec(system().size()), Vec(system().size())};
  Index at = 0;
  if (pieces_->is_own) {
    for (const Node& node : nodes) {
      state.q.segment(at, pieces_->dimension) = node.position.head(pieces_->dimension);
      state.v.segment(at, pieces_->dimension) = node.velocity.head(pieces_->dimension);
      at += pieces_->dimension;
    }
    return state;
  }
  for (const Part& part : pieces_->parts) {
    const Index n = part.unknowns();
    part.collect(nodes, part.fall().displacement(t), part.fall().velocity_at(t),
                 state.q.segment(at, n), state.v.segment(at, n));
    at += n;
  }
  return state;
}

std::vector<double> Model::largest_by_part(const Vec& x) const {
  if (pieces_->is_own) {
    if (x.size() == 0) return {};
    const auto squares =
        x.reshaped(pieces_->dimension, x.size() / pieces_->dimension).colwise().squaredNorm();
    return {std::sqrt(squares.maxCoeff<Eigen::PropagateNaN>())};
  }
  std::vector<double> largest;
  if (!pieces_->series.empty()) return largest;
  Index at = 0;
  for (const Part& part : pieces_->parts) {
    const Index n = part.unknowns();
    largest.push_back(part.largest(x.segment(at, n)));
    at += n;
  }
  return largest;
}

double Model::kinetic(const State& state) const {
  double energy = pieces_->system->kinetic(state.v);
  for (const reduce::Flying& flying : pieces_->flying) {
    energy += 0.5 * pieces_->nodes[flying.node].mass * flying.velocity_at(state.t).squaredNorm();
  }
  for_falling(pieces_->parts, state, [&](const Fall& fall, const Part::Moments& moments) {
    const Eigen::Vector3d v = fall.velocity_at(state.t);
    energy += moments.momentum.dot(v) + 0.5 * fall.mass * v.squaredNorm();
  });
  return energy;
}

double Model::potential(const State& state) const {
  double energy = pieces_->system->potential(state) + pieces_->static_energy +
                  energy_of_driven_springs(*pieces_, state.t);
  for (const reduce::Flying& flying : pieces_->flying) {
    const Node& node = pieces_->nodes[flying.node];
    energy -= node.mass * flying.gravity.dot(node.position + flying.displacement(state.t));
  }
  for_falling(pieces_->parts, state, [&](const Fall& fall, const Part::Moments& moments) {
    energy -= fall.gravity.dot(moments.first + fall.mass * fall.displacement(state.t));
  });
  return energy;
}

double Model::energy(const State& state) const {
  double energy = total_energy(*pieces_->system, state) + state.work.taken() +
                  pieces_->static_energy + energy_of_driven_springs(*pieces_, 0);
  for (const reduce::Flying& flying : pieces_->flying) {
    const Node& node = pieces_->nodes[flying.node];
    energy += node.mass * (0.5 * flying.velocity.squaredNorm() - flying.gravity.dot(node.position));
  }
  for_falling(pieces_->parts, state, [&](const Fall& fall, const Part::Moments& moments) {
    energy += moments.momentum.dot(fall.velocity_at(state.t)) +
              0.5 * fall.mass * fall.velocity.squaredNorm() - fall.gravity.dot(moments.first);
  });
  return energy;
}

double Model::dissipated(const State& state) const {
  double energy = state.work.dissipated;
  for (const reduce::Flying& flying : pieces_->flying) {
    energy += pieces_->nodes[flying.node].mass * flying.dissipated(state.t);
  }
  for (const Part& part : pieces_->parts) {
    energy += part.fall().mass * part.fall().dissipated(state.t);
  }
  return energy;
}

double Model::driven(const State& state) const {
  return state.work.driven + energy_of_driven_springs(*pieces_, state.t) -
         energy_of_driven_springs(*pieces_, 0);
}

const std::vector<std::size_t>& Model::general_springs() const { return pieces_->general; }
const std::vector<std::size_t>& Model::rods() const { return pieces_->rods; }

Vec Model::tensions(const State& state) const {
  return tensions_by(ConstraintForces(*pieces_->system).at(state));
}

Vec Model::tensions_by(const Vec& multipliers) const {
  if (pieces_->is_own) return multipliers;
  Vec tensions(std::ssize(pieces_->shares));
  for (Index k = 0; k < tensions.size(); ++k) {
    const auto& [constraint, share] = pieces_->shares[static_cast<std::size_t>(k)];
    tensions[k] = share * multipliers[constraint];
  }
  return tensions;
}

std::vector<std::size_t> Model::massless_nodes() const {
  std::vector<std::size_t> massless;
  for (Index first = 0; pieces_->is_own && first < pieces_->system->size();
       first += pieces_->dimension) {
    if ((pieces_->system->mass().segment(first, pieces_->dimension).array() == 0).any())
      massless.push_back(static_cast<std::size_t>(first / pieces_->dimension));
  }
  for (const Part& part : pieces_->parts) {
    for (const std::size_t node : part.nodes()) {
      if (pieces_->nodes[node].mass == 0) massless.push_back(node);
    }
  }
  std::ranges::sort(massless);
  return massless;
}

std::vector<std::vector<std::size_t>> Model::nodes_by_part() const {
  if (pieces_->is_own) {
    std::vector<std::size_t> all(pieces_->nodes.size());
    std::iota(all.begin(), all.end(), 0);
    return {all};
  }
  std::vector<std::vector<std::size_t>> nodes;
  std::vector<std::size_t> part_of(pieces_->nodes.size(), pieces_->parts.size());
  for (const Part& part : pieces_->parts) {
    for (const std::size_t node : part.nodes()) part_of[node] = nodes.size();
    nodes.push_back(part.nodes());
  }
  for (const reduce::Series& series : pieces_->series) {
    const std::size_t part = std::min(part_of[series.ends[0]], part_of[series.ends[1]]);
    if (part == pieces_->parts.size()) continue;  // a spring between two pinned nodes
    for (const auto& joint : series.joints) nodes[part].push_back(joint.node);
  }
  return nodes;
}

std::vector<Index> Model::unknowns_by_part() const {
  if (pieces_->is_own) return {pieces_->system->size()};
  std::vector<Index> unknowns;
  for (const Part& part : pieces_->parts) unknowns.push_back(part.unknowns());
  return unknowns;
}

}  // namespace qddot
