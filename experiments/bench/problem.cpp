#include "experiments/bench/problem.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/reference_file.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::bench {
namespace {

Reference reference_of(const Scene& drawn, const Scene& start, const Model& scene, double until,
                       const std::string& folder, const nlohmann::json& origin) {
  require_kept_energy(drawn, drawn.name,
                      "the other solvers are asked for motions that keep their energy");
  require_no_rods(drawn, drawn.name, "the other solvers are not asked for them");
  const auto is_plain = [](const Spring& spring) { return spring.law.is_plain(); };
  if (!std::ranges::all_of(drawn.springs, is_plain)) {
    throw InvalidInput(
        fmt::format("{}: the other solvers have no cubic springs and no cables; allowed are scenes "
                    "without cubic and pulls_only",
                    drawn.name));
  }
  require_reference_exists(scene, drawn.name);
  Reference reference = reference_for(drawn, start, scene, until, folder, origin);
  if (reference.is_beyond_horizon()) {
    throw InvalidInput(
        fmt::format("{}: beyond t = {:.2g} s the motion is chaotic and nobody knows the positions; "
                    "allowed are earlier ends",
                    drawn.name, reference.horizon));
  }
  return reference;
}

Reference in_all_unknowns(Reference reference, const Model& smallest, int dimension) {
  reference.end = state_of(smallest.expand(reference.end), dimension, reference.end.t);
  return reference;
}

}  // namespace

State state_of(const std::vector<Node>& nodes, int dimension, double t) {
  const auto free = std::ranges::count(nodes, false, &Node::pinned);
  State state{t, Vec(dimension * free), Vec(dimension * free)};
  Index at = 0;
  for (const Node& node : nodes) {
    if (node.pinned) continue;
    state.q.segment(at, dimension) = node.position.head(dimension);
    state.v.segment(at, dimension) = node.velocity.head(dimension);
    at += dimension;
  }
  return state;
}

Problem::Problem(const Scene& drawn, const Scene& started, double end, const std::string& folder,
                 const nlohmann::json& origin)
    : start(started),
      until(end),
      smallest(start),
      reference(reference_of(drawn, start, smallest, until, folder, origin)),
      scene(start, Reductions::only({Reduction::pins})),
      own(in_all_unknowns(reference, smallest, start.dimension)) {
  const Options scales = with_tolerance_scales({}, scene);
  length = scales.length;
  speed = scales.speed;
}

double Problem::error(const State& end) const {
  const double error = errors_between(scene, end, own.end, own.energy, own.scales).position;
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

PlainForce::PlainForce(const Scene& scene) : dimension_(scene.dimension), gravity_(scene.gravity) {
  constexpr int none = -1;
  const bool is_loaded = has_loads(scene);
  std::vector<int> place(scene.nodes.size(), none);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].pinned) continue;
    place[i] = static_cast<int>(mass_.size());
    mass_.push_back(scene.nodes[i].mass);
    if (is_loaded) load_.push_back(scene.nodes[i].load);
  }
  for (const Spring& spring : scene.springs) {
    const auto [a, b] = spring.nodes;
    if (place[a] != none && place[b] != none) {
      links_.push_back({place[a], place[b], spring.law});
    } else if (place[a] != none) {
      anchors_.push_back({place[a], scene.nodes[b].position, spring.law});
    } else if (place[b] != none) {
      anchors_.push_back({place[b], scene.nodes[a].position, spring.law});
    }
  }
}

template <int D>
void PlainForce::sum(const double* q, double* f) const {
  using Vector = Eigen::Matrix<double, D, 1>;
  const auto x = [q](int i) { return Eigen::Map<const Vector>(q + D * i); };
  const auto at = [f](int i) { return Eigen::Map<Vector>(f + D * i); };
  const Vector gravity = gravity_.head<D>();
  for (std::size_t i = 0; i < mass_.size(); ++i) at(static_cast<int>(i)) = mass_[i] * gravity;
  for (std::size_t i = 0; i < load_.size(); ++i) at(static_cast<int>(i)) += load_[i].head<D>();
  for (const Link& link : links_) {
    const Vector d = x(link.j) - x(link.i);
    const double l = d.norm();
    const Vector pull = l > 0 ? Vector(link.law.tension(l) / l * d) : Vector(Vector::Zero());
    at(link.i) += pull;
    at(link.j) -= pull;
  }
  for (const Anchor& anchor : anchors_) {
    const Vector d = anchor.point.head<D>() - x(anchor.i);
    const double l = d.norm();
    if (l > 0) at(anchor.i) += anchor.law.tension(l) / l * d;
  }
}

void PlainForce::force(const double* q, double* f) const {
  dimension_ == 1 ? sum<1>(q, f) : dimension_ == 2 ? sum<2>(q, f) : sum<3>(q, f);
}

void PlainForce::acceleration(const double* q, double* a) const {
  force(q, a);
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    for (int d = 0; d < dimension_; ++d) *a++ /= mass_[i];
  }
}

Acceleration::Acceleration(const Scene& start, const System& system, ForceKind kind)
    : plain_(start),
      system_(system),
      kind_(kind),
      per_mass_(system.mass().cwiseInverse()),
      q_(system.size()),
      f_(system.size()) {}

void Acceleration::operator()(const double* q, double* a) {
  ++evaluations_;
  if (kind_ == ForceKind::plain) {
    plain_.acceleration(q, a);
    return;
  }
  q_ = Vec::Map(q, q_.size());
  system_.force(q_, f_);
  Vec::Map(a, f_.size()) = per_mass_.cwiseProduct(f_);
}

}  // namespace qddot::bench
