#include "qddot/scene/scene_arrays.hpp"

#include <limits>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot {
namespace {

using Eigen::Index;

void require_size(bool fits, const char* array, Index has, const std::string& allowed) {
  if (!fits) throw InvalidInput(fmt::format("{}: {} entries; allowed are {}", array, has, allowed));
}

// An array with one entry for all, or with one for each of `count`.
class Values {
 public:
  Values(const char* name, const Eigen::VectorXd& values, std::size_t count)
      : values_(values), is_one_(values.size() == 1) {
    require_size(is_one_ || values.size() == static_cast<Index>(count), name, values.size(),
                 fmt::format("1 or {}", count));
  }
  double operator[](std::size_t i) const { return values_[is_one_ ? 0 : static_cast<Index>(i)]; }

 private:
  const Eigen::VectorXd& values_;
  bool is_one_;
};

void require_node(std::size_t node, std::size_t count, const std::string& where) {
  if (node < count) return;
  throw InvalidInput(
      fmt::format("{}: node {} is none of the {} nodes, which count from 0", where, node, count));
}

void require_as_positions(const SceneArrays& a, const char* name, const Eigen::MatrixXd& array) {
  const bool fits = array.rows() == a.positions.rows() && array.cols() == a.positions.cols();
  require_size(array.size() == 0 || fits, name, array.size(),
               fmt::format("{}", a.positions.size()));
}

std::vector<Node> nodes_of(const SceneArrays& a) {
  const auto count = static_cast<std::size_t>(a.positions.rows());
  const Index dimension = a.positions.cols();
  const bool is_moving = a.velocities.size() > 0, is_loaded = a.load.size() > 0;
  require_as_positions(a, "velocities", a.velocities);
  require_as_positions(a, "load", a.load);
  const Values mass("mass", a.mass, count);
  std::vector<Node> nodes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Index>(i);
    nodes[i].position.head(dimension) = a.positions.row(row).transpose();
    if (is_moving) nodes[i].velocity.head(dimension) = a.velocities.row(row).transpose();
    if (is_loaded) nodes[i].load.head(dimension) = a.load.row(row).transpose();
    nodes[i].mass = mass[i];
  }
  for (std::size_t k = 0; k < a.pinned.size(); ++k) {
    require_node(a.pinned[k], count, fmt::format("pinned[{}]", k));
    nodes[a.pinned[k]].pinned = true;
  }
  return nodes;
}

std::vector<Spring> springs_of(const SceneArrays& a, const std::vector<Node>& nodes) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(1);
  const bool is_drawn = a.rest_length.size() == 0;
  const std::size_t count = a.springs.size();
  const Values stiffness("stiffness", a.stiffness, count);
  const Values rest_length("rest_length", is_drawn ? none : a.rest_length, count);
  const Values quartic("quartic", a.quartic.size() == 0 ? none : a.quartic, count);
  const Values damping("damping", a.damping.size() == 0 ? none : a.damping, count);
  const Eigen::VectorXd never =
      Eigen::VectorXd::Constant(1, std::numeric_limits<double>::infinity());
  const Values cubic("cubic", a.cubic.size() == 0 ? none : a.cubic, count);
  const Values breaks_at("breaks_at", a.breaks_at.size() == 0 ? never : a.breaks_at, count);
  const Values pulls_only("pulls_only", a.pulls_only.size() == 0 ? none : a.pulls_only, count);
  const Values rigid("rigid", a.rigid.size() == 0 ? none : a.rigid, count);
  std::vector<Spring> springs;
  springs.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [from, to] = a.springs[i];
    for (const std::size_t node : {from, to}) {
      require_node(node, nodes.size(), fmt::format("springs[{}]", i));
    }
    const double length = (nodes[to].position - nodes[from].position).norm();
    if (rigid[i] != 0) {
      springs.push_back(
          {{from, to}, {.rest_length = is_drawn ? length : rest_length[i], .rigid = true}});
      continue;
    }
    springs.push_back({{from, to},
                       {.stiffness = stiffness[i],
                        .rest_length = is_drawn ? length : rest_length[i],
                        .quartic = quartic[i],
                        .damping = damping[i],
                        .cubic = cubic[i],
                        .breaks_at = breaks_at[i],
                        .pulls_only = pulls_only[i] != 0}});
  }
  return springs;
}

}  // namespace

Scene scene_of(const SceneArrays& arrays) {
  const Index dimension = arrays.positions.cols();
  if (dimension < 1 || dimension > 3) {
    throw InvalidInput(
        fmt::format("positions: {} columns; allowed are 1, 2 or 3, a coordinate each", dimension));
  }
  Scene scene{.name = "arrays", .dimension = static_cast<int>(dimension)};
  if (arrays.gravity.size() > 0) {
    require_size(arrays.gravity.size() == dimension, "gravity", arrays.gravity.size(),
                 fmt::format("{}", dimension));
    scene.gravity.head(dimension) = arrays.gravity;
  }
  scene.air_damping = arrays.air_damping;
  scene.nodes = nodes_of(arrays);
  scene.springs = springs_of(arrays, scene.nodes);
  scene.curves = arrays.curves;
  scene.gravity_curve = arrays.gravity_curve;
  const std::vector<int>& curves = arrays.curve_of_node;
  require_size(curves.empty() || curves.size() == scene.nodes.size(), "curve_of_node",
               std::ssize(curves), fmt::format("{}", scene.nodes.size()));
  for (std::size_t i = 0; i < curves.size(); ++i) scene.nodes[i].curve = curves[i];
  validate(scene, scene.name);
  return scene;
}

}  // namespace qddot
