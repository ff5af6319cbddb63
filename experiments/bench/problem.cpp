#include "experiments/bench/problem.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/reference_file.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::bench {
namespace {

Reference reference_of(const Scene& drawn, const Scene& start, const ReducedScene& scene,
                       double until, const std::string& folder, const nlohmann::json& origin) {
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

Reference in_all_unknowns(Reference reference, const ReducedScene& smallest, int dimension) {
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

}  // namespace qddot::bench
