#include "src/scene/mesh_scene.hpp"

#include "src/scene/invalid_input.hpp"
#include "src/scene/mesh.hpp"

namespace qddot {
namespace {

Mesh read_file(const Table& table, const std::filesystem::path& folder) {
  const std::string file = table.text("file");
  try {
    return read_mesh(folder / file);
  } catch (const InvalidInput& refusal) {
    table.fail("file", refusal.what());
  }
}

double mass_of_each(const Table& table, std::size_t nodes) {
  if (table.has("node_mass") == table.has("total_mass"))
    table.fail("node_mass", "allowed is exactly one of node_mass and total_mass");
  if (table.has("node_mass")) return table.number("node_mass", not_negative);
  return table.number("total_mass", not_negative) / static_cast<double>(nodes);
}

void add_springs(const std::vector<std::array<std::size_t, 2>>& pairs, double stiffness,
                 Scene& scene) {
  for (const auto& [i, j] : pairs) {
    const double length = (scene.nodes[j].position - scene.nodes[i].position).norm();
    scene.springs.push_back({{i, j}, {.stiffness = stiffness, .rest_length = length}});
  }
}

void pin(const Table& box, std::vector<Node>& nodes) {
  box.allow_keys({"min", "max"});
  const Eigen::Vector3d low = box.vector("min", 3), high = box.vector("max", 3);
  if ((low.array() > high.array()).any()) box.refuse("max", "arrays that are nowhere below min");
  for (Node& node : nodes) {
    const auto x = node.position.array();
    node.pinned |= (low.array() <= x && x <= high.array()).all();
  }
}

}  // namespace

void add_mesh(const Table& table, const std::filesystem::path& folder, Scene& scene) {
  table.allow_keys(
      {"file", "scale", "stiffness", "bending_stiffness", "node_mass", "total_mass", "pin"});
  const double scale = table.number_or(1, "scale", positive);
  const double stiffness = table.number("stiffness", not_negative);
  const double bending_stiffness = table.number_or(0, "bending_stiffness", not_negative);
  const Mesh mesh = read_file(table, folder);

  const double mass = mass_of_each(table, mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    scene.nodes.push_back({.position = scale * vertex, .mass = mass});
  add_springs(mesh.edges, stiffness, scene);
  if (bending_stiffness > 0) add_springs(opposite_vertices(mesh), bending_stiffness, scene);
  for (const Table& box : table.tables("pin")) pin(box, scene.nodes);
}

}  // namespace qddot
