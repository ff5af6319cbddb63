#include "qddot/measure/motion/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

constexpr double fewest_roundings = 1e4;

double divided(double error, double scale) { return scale > 0 ? error / scale : error; }

// Raises `largest` to x if x is larger or not a number.
void raise(double& largest, double x) {
  if (x > largest || std::isnan(x)) largest = x;
}

// The largest |a_i - b_i| of the positions or velocities of some nodes.
double largest_difference(const std::vector<std::size_t>& some, const std::vector<Node>& a,
                          const std::vector<Node>& b, Eigen::Vector3d Node::*vector) {
  double largest = 0;
  for (const std::size_t i : some) raise(largest, (a[i].*vector - b[i].*vector).norm());
  return largest;
}

std::vector<std::size_t> all_of(const std::vector<Node>& nodes) {
  std::vector<std::size_t> all(nodes.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// The nodes without the common fall of parts; if nothing is integrated, as they move.
std::vector<Node> measured(const Model& scene, const State& state) {
  return scene.system().size() > 0 ? scene.expand_beside_falls(state) : scene.expand(state);
}

std::vector<PartScale> parts_of(const Model& scene, const std::vector<Node>& start) {
  std::vector<PartScale> parts;
  for (auto& nodes : scene.nodes_by_part()) {
    PartScale& part = parts.emplace_back(PartScale{.nodes = std::move(nodes)});
    for (const std::size_t i : part.nodes) {
      part.extent = std::max(part.extent, start[i].position.lpNorm<Eigen::Infinity>());
    }
  }
  // Without integrated parts, all moving nodes are in free flight.
  if (parts.empty()) parts.push_back({.nodes = all_of(start)});
  return parts;
}

// The largest error of a part over the part's scale.
double largest_error(const std::vector<Node>& nodes, const std::vector<Node>& reference,
                     Eigen::Vector3d Node::*vector, const Scales& scales, double whole,
                     double (Scales::*scale_of)(const PartScale&) const) {
  if (scales.parts.empty())
    return divided(largest_difference(all_of(nodes), nodes, reference, vector), whole);
  double largest = 0;
  for (const PartScale& part : scales.parts) {
    raise(largest, divided(largest_difference(part.nodes, nodes, reference, vector),
                           (scales.*scale_of)(part)));
  }
  return largest;
}

}  // namespace

bool PartScale::is_at_rest() const {
  return displacement <= fewest_roundings * machine_epsilon * extent;
}

double Scales::displacement_of(const PartScale& part) const {
  return part.is_at_rest() ? displacement : part.displacement;
}

double Scales::speed_of(const PartScale& part) const {
  return part.is_at_rest() ? speed : part.speed;
}

void extend(Scales& scales, const Model& scene, const State& state) {
  if (scales.parts.empty()) scales.parts = parts_of(scene, measured(scene, scene.initial()));
  std::vector<double> displacements = scene.largest_by_part(state.q - scene.initial().q),
                      speeds = scene.largest_by_part(state.v);
  if (displacements.empty()) {
    const auto start = measured(scene, scene.initial()), now = measured(scene, state);
    for (const PartScale& part : scales.parts) {
      displacements.push_back(largest_difference(part.nodes, now, start, &Node::position));
      double& speed = speeds.emplace_back(0);
      for (const std::size_t i : part.nodes) raise(speed, now[i].velocity.norm());
    }
  }
  for (std::size_t p = 0; p < scales.parts.size(); ++p) {
    PartScale& part = scales.parts[p];
    part.displacement = std::max(part.displacement, displacements[p]);
    part.speed = std::max(part.speed, speeds[p]);
    scales.displacement = std::max(scales.displacement, part.displacement);
    scales.speed = std::max(scales.speed, part.speed);
  }
  scales.kinetic =
      std::max(scales.kinetic,
               scene.system().size() > 0 ? scene.system().kinetic(state.v) : scene.kinetic(state));
  if (scene.system().driving()) scales.kinetic = std::max(scales.kinetic, throughput(state.work));
}

double position_error(const std::vector<Node>& nodes, const std::vector<Node>& reference,
                      const Scales& scales) {
  return largest_error(nodes, reference, &Node::position, scales, scales.displacement,
                       &Scales::displacement_of);
}

double position_error(const Model& scene, const State& state, const State& reference,
                      const Scales& scales) {
  const std::vector<double> differences = scene.largest_by_part(state.q - reference.q);
  if (differences.size() != scales.parts.size() || differences.empty())
    return position_error(measured(scene, state), measured(scene, reference), scales);
  double largest = 0;
  for (std::size_t p = 0; p < differences.size(); ++p)
    raise(largest, divided(differences[p], scales.displacement_of(scales.parts[p])));
  return largest;
}

double velocity_error(const std::vector<Node>& nodes, const std::vector<Node>& reference,
                      const Scales& scales) {
  return largest_error(nodes, reference, &Node::velocity, scales, scales.speed, &Scales::speed_of);
}

Errors errors_between(const Model& scene, const State& state, const State& reference, double energy,
                      const Scales& scales) {
  const auto nodes = measured(scene, state), expected = measured(scene, reference);
  return {position_error(nodes, expected, scales), velocity_error(nodes, expected, scales),
          divided(std::abs(scene.energy(state) - energy), scales.kinetic)};
}

double worse(const Errors& errors) { return std::max(errors.position, errors.velocity); }

Errors larger(const Errors& one, const Errors& other) {
  return {std::max(one.position, other.position), std::max(one.velocity, other.velocity),
          std::max(one.energy, other.energy)};
}

}  // namespace qddot::inline measure
