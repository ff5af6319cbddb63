#include "experiments/advice/true_motion.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/advice/draws.hpp"
#include "experiments/kit/plain_motion.hpp"

namespace qddot::judged_advice {
namespace {

constexpr int looks = 300;
// With joints a step costs much more.
constexpr int most_steps_of_all = 40000, most_steps_with_joints = 3000;
constexpr long double tolerance = 1e-17L;
constexpr double rounding = 0x1p-52;

// Adds all nodes at the times to the path, as far as the motion goes.
template <class Motion>
bool follow(Motion& motion, const std::vector<double>& times, std::vector<std::vector<Node>>& path,
            int most_steps) {
  for (const double t : times) {
    if (!motion.advance(t, most_steps - motion.tried_steps())) return false;
    std::vector<Node> nodes = motion.model().scene().nodes;
    const auto state = motion.state();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto axis = static_cast<Index>(c);
        nodes[i].position[axis] = static_cast<double>(state.x[3 * i + c]);
        nodes[i].velocity[axis] = static_cast<double>(state.v[3 * i + c]);
      }
    }
    path.push_back(std::move(nodes));
  }
  return true;
}

// Moves each coordinate by a rounding of the largest one, to either side.
template <class Motion>
void displace(Motion& motion, Draws& draw) {
  const Scene& scene = motion.model().scene();
  double extent = 0, speed = 0;
  for (const Node& node : scene.nodes) {
    extent = std::max(extent, node.position.cwiseAbs().maxCoeff());
    if (!node.pinned) speed = std::max(speed, node.velocity.norm());
  }
  const auto either = [&](double size) { return draw.happens(0.5) ? size : -size; };
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].pinned || scene.nodes[i].mass == 0) continue;
    for (int c = 0; c < scene.dimension; ++c)
      motion.displace(3 * i + static_cast<std::size_t>(c), either(rounding * extent),
                      either(rounding * speed));
  }
}

template <class Model>
TrueMotion followed(const Model& model, const HardCase& hard) {
  TrueMotion truth;
  Draws draw(hard.number);
  for (int i = 0; i < looks; ++i) truth.times.push_back(hard.until * draw.between(1e-6, 1));
  truth.times.push_back(hard.until);
  std::ranges::sort(truth.times);
  PlainMotion<long double, Model> motion(model, tolerance), twin(model, 10 * tolerance);
  displace(twin, draw);
  const auto energy = [&](const auto& state) { return model.energy(state.x, state.v); };
  const long double own = energy(motion.state());
  truth.energy_conditioning =
      static_cast<double>(std::abs(energy(twin.state()) - own) + rounding * std::abs(own));
  const bool has_joints = std::ranges::any_of(
      hard.scene.nodes, [](const Node& node) { return !node.pinned && node.mass == 0; });
  const int most_steps = has_joints ? most_steps_with_joints : most_steps_of_all;
  std::vector<std::vector<Node>> beside;
  if (!follow(motion, truth.times, truth.path, most_steps) ||
      !follow(twin, truth.times, beside, most_steps)) {
    const bool is_too_long = std::max(motion.tried_steps(), twin.tried_steps()) >= most_steps;
    truth.unknown_because =
        has_joints && !is_too_long ? goes_slack : "the true motion takes too many steps";
    return truth;
  }
  for (std::size_t t = 0; t < beside.size(); ++t) {
    double gap = 0;
    for (std::size_t i = 0; i < beside[t].size(); ++i)
      gap = std::max(gap, (beside[t][i].position - truth.path[t][i].position).norm());
    truth.conditioning = std::max(truth.conditioning, gap);
    truth.conditioning_at_end = gap;
  }
  return truth;
}

}  // namespace

TrueMotion true_motion(const HardCase& hard) {
  if (hard.pairs.empty()) return followed(PlainModel<long double>(hard.scene), hard);
  return followed(PlainPairs<long double>(hard.scene, hard.pairs), hard);
}

}  // namespace qddot::judged_advice
