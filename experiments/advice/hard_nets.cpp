#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "experiments/advice/hard_kinds.hpp"
#include "experiments/advice/hard_scenes.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::judged_advice {

void fold(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  const bool is_pinned = draw.happens(0.7);
  c.scene = net(draw, d, 4 + draw.one_of(5), 0.3, is_pinned);
  const double v = draw.by_logarithm(1, 20);
  for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, v);
  if (d == 2 && draw.happens(0.5)) turn(c.scene, draw);
  c.until = draw.by_logarithm(1, 30) / v;
}

void uneven_masses(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  c.scene = net(draw, d, 3 + draw.one_of(6), 0.1, true);
  const double lightest = draw.by_logarithm(1e-8, 1e-2);
  for (Node& node : c.scene.nodes) {
    node.mass = draw.by_logarithm(lightest, 1);
    node.velocity = draw.in_box(d, 1);
  }
  if (draw.happens(0.5)) c.scene.gravity[d - 1] = -9.81;
  // The light ones start near rest in half of the cases: else they alone are seen.
  if (draw.happens(0.5)) {
    for (Node& node : c.scene.nodes) node.velocity *= std::min(1.0, node.mass / 0.1);
  }
  c.until = 2 * std::numbers::pi / fastest(c) * draw.by_logarithm(3, 400);
}

void small_motion(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  const double size = draw.by_logarithm(1e-11, 1e-3);
  c.scene = net(draw, d, 2 + draw.one_of(6), 0, true);
  for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, size);
  c.until = 2 * std::numbers::pi / fastest(c) * draw.by_logarithm(0.5, 400);
}

// The last tenth before the positions of a chaotic motion are lost, as a run of a pilot with a
// start moved by 1e-12 says; or a regular motion's whole time.
void before_horizon(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  if (draw.happens(0.5)) {  // an elastic pendulum of two or three links
    c.scene = {.dimension = d};
    c.scene.gravity[1] = -9.81;
    c.scene.nodes = {{.pinned = true}};
    Eigen::Vector3d end = Eigen::Vector3d::Zero();
    const int links = 2 + draw.one_of(2);
    for (int i = 0; i < links; ++i) {
      end += random_direction(draw, d);
      c.scene.nodes.push_back({.position = end, .mass = draw.by_logarithm(0.3, 3)});
      const auto own = static_cast<std::size_t>(i);
      join(c.scene, own, own + 1, draw.by_logarithm(100, 3000), 1);
    }
  } else {
    c.scene = net(draw, d, 4 + draw.one_of(4), 0.3, true);
    for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, 3);
  }
  const double longest = 2 * std::numbers::pi / fastest(c) * 150;
  const Model model = c.as_drawn();
  std::vector<double> times;
  for (int i = 1; i <= 300; ++i) times.push_back(longest * i / 300);
  const auto path_of = [&](const State& start) {
    std::vector<Vec> path;
    const auto integrator = make_integrator(*find_method("dprkn12"), model.system(),
                                            options_for(*find_method("dprkn12"), 1e-12, model));
    State state = start;
    integrator->advance(state, times.back(), {times, [&](const State& s) { path.push_back(s.q); }});
    return path;
  };
  State moved = model.initial();
  for (Index i = 0; i < moved.q.size(); ++i) moved.q[i] += 1e-12 * draw.between(-1, 1);
  const auto one = path_of(model.initial()), other = path_of(moved);
  c.until = longest;
  for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i) {
    // A rounding is some four digits less than that: it is as large as this a little later.
    const double gap = (one[i] - other[i]).cwiseAbs().maxCoeff() * 1e-4;
    if (gap > 0.03 * c.accuracy) {
      c.until = times[i];
      break;
    }
  }
  c.until *= draw.between(0.9, 1);
}

void prestressed(HardCase& c, Draws& draw) {
  const int side = 3 + draw.one_of(4), d = draw.happens(0.7) ? 3 : 2;
  const double stretch = draw.by_logarithm(1.02, 4), k = draw.by_logarithm(30, 3000);
  c.scene = {.dimension = d};
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * side + j); };
  const double m = draw.by_logarithm(0.01, 1);
  const double pluck = draw.by_logarithm(1e-6, 0.5);
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const bool edge = i == 0 || j == 0 || i + 1 == side || j + 1 == side;
      Node node{.position = Eigen::Vector3d(i, j, 0), .mass = m, .pinned = edge};
      if (!edge && draw.happens(0.5)) node.position += draw.in_box(d, pluck);
      c.scene.nodes.push_back(node);
    }
  }
  Node& inner = c.scene.nodes[at(1, 1)];
  if (side == 3 && inner.position == Eigen::Vector3d(1, 1, 0))
    inner.position += draw.in_box(d, pluck);
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      if (i + 1 < side) join(c.scene, at(i, j), at(i + 1, j), k, 1 / stretch);
      if (j + 1 < side) join(c.scene, at(i, j), at(i, j + 1), k, 1 / stretch);
    }
  }
  if (draw.happens(0.5)) turn(c.scene, draw);
  c.until = 2 * std::numbers::pi * std::sqrt(m / k) * draw.by_logarithm(0.3, 100);
}

void spinning(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  const double strain = draw.happens(0.5) ? 0 : 0.1;
  c.scene = net(draw, d, 2 + draw.one_of(6), strain, false);
  const double stiffer = draw.by_logarithm(1, 100);
  for (Spring& spring : c.scene.springs) spring.law.stiffness *= stiffer;
  const double part = draw.by_logarithm(0.003, 0.7), w = fastest(c) * part;
  const Eigen::Vector3d axis = d == 2 ? Eigen::Vector3d(0, 0, 1) : random_direction(draw, 3);
  const Eigen::Vector3d along = draw.happens(0.5) ? draw.in_box(d, 2) : Eigen::Vector3d(0, 0, 0);
  for (Node& node : c.scene.nodes) node.velocity = along + w * axis.cross(node.position);
  if (draw.happens(0.4)) c.scene.gravity[1] = -9.81;
  c.until = 2 * std::numbers::pi / w * draw.by_logarithm(0.3, std::max(1.0, 400 * part));
}

void stiff(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  const double strain = draw.happens(0.5) ? 0.02 : 0;
  c.scene = net(draw, d, 4 + draw.one_of(5), strain, true);
  const double ratio = draw.by_logarithm(1e2, 1e6);
  for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, draw.by_logarithm(0.1, 2));
  bool any = false;
  for (Spring& spring : c.scene.springs) {
    if (!draw.happens(0.4)) continue;
    spring.law.stiffness *= ratio;
    any = true;
  }
  if (!any) c.scene.springs[0].law.stiffness *= ratio;
  c.scene.stiff_above = 100.5;
  c.until = 2 * std::numbers::pi / fastest(c) * draw.by_logarithm(3, 500);
}

void two_parts(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  const bool rests = draw.happens(0.2);
  c.scene = net(draw, d, 2 + draw.one_of(4), 0.1, true);
  const bool is_pinned = draw.happens(0.7);
  Scene other = net(draw, d, 2 + draw.one_of(4), rests ? 0 : 1e-3, is_pinned);
  for (Node& node : c.scene.nodes) node.velocity = draw.in_box(d, 1);
  const double stiffer = draw.by_logarithm(1, 1e4), size = draw.by_logarithm(1e-6, 1);
  const std::size_t first = c.scene.nodes.size();
  for (Node& node : other.nodes) {
    if (!rests) node.velocity = draw.in_box(d, size);
    node.position[0] += 6;
    c.scene.nodes.push_back(node);
  }
  for (Spring& spring : other.springs) {
    spring.law.stiffness *= stiffer;
    for (std::size_t& node : spring.nodes) node += first;
    c.scene.springs.push_back(spring);
  }
  c.until = 2 * std::numbers::pi / fastest(c) * draw.by_logarithm(3, 300);
}

void far_from_zero(HardCase& c, Draws& draw) {
  constexpr std::array motions = {near_miss, fold, spinning, weakly_coupled, small_motion};
  motions[static_cast<std::size_t>(draw.one_of(std::ssize(motions)))](c, draw);
  const double far = draw.by_logarithm(10, 1e6);
  const Eigen::Vector3d by = far * random_direction(draw, c.scene.dimension);
  for (Node& node : c.scene.nodes) node.position += by;
}

}  // namespace qddot::judged_advice
