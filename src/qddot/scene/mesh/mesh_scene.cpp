#include "qddot/scene/mesh/mesh_scene.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <boost/pending/disjoint_sets.hpp>
#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/mesh/lumped_mass.hpp"
#include "qddot/scene/mesh/mesh.hpp"
#include "qddot/scene/mesh/weld.hpp"
#include "qddot/scene/node_choice.hpp"

namespace qddot {
namespace {

using namespace mesh;

Mesh read_file(const TomlTable& table, const std::filesystem::path& folder, const TextSource& read,
               double scale) {
  const std::string file = table.text("file");
  const bool has_control =
      std::ranges::any_of(file, [](unsigned char c) { return std::iscntrl(c); });
  if (has_control || file.size() > 1000)  // messages hold it
    table.refuse("file", "names of up to 1000 bytes without control characters");
  try {
    return read_mesh(folder / file, read, table.number_or(-1, "weld", not_negative) / scale);
  } catch (const InvalidInput& refusal) {
    table.fail("file", refusal.what());
  }
}

// The pairs of nodes that bending springs join.
std::vector<std::array<std::size_t, 2>> bending_pairs(const TomlTable& table, const Mesh& mesh) {
  const double stiffness = table.number_or(0, "bending_stiffness", not_negative);
  if (stiffness == 0) return {};
  auto pairs = opposite_vertices(mesh);
  if (pairs.empty())
    table.fail(
        "bending_stiffness",
        fmt::format("{} is not allowed as {} has no edge between two triangles; allowed is 0",
                    stiffness, shown(table.text("file"))));
  return pairs;
}

// Throws InvalidInput unless exactly one key gives the masses.
void require_one_mass(const TomlTable& table) {
  const bool by_node = table.has("node_mass"), by_total = table.has("total_mass"),
             by_density = table.has("density");
  if (by_node + by_total + by_density == 1) return;
  table.fail(by_node || !by_density ? "node_mass" : "density",
             "allowed is exactly one of node_mass, total_mass and density");
}

// The mass of each vertex by the mesh's density; none without that key.
std::vector<double> masses_by_density(const TomlTable& table, const Mesh& mesh) {
  if (!table.has("density")) return {};
  const double density = table.number("density", positive);
  const std::vector<double> masses = lumped_masses(mesh, density);
  std::vector<bool> is_seen(masses.size(), false);
  std::size_t without = 0;
  for (const auto& edge : mesh.edges) {
    for (const std::size_t vertex : edge) {
      without += !is_seen[vertex] && masses[vertex] == 0;
      is_seen[vertex] = true;
    }
  }
  if (without > 0)
    table.fail("density",
               fmt::format("{} is not allowed as {} belong{} to no {}; allowed are "
                           "node_mass and total_mass",
                           density, without == 1 ? "1 vertex" : fmt::format("{} vertices", without),
                           without == 1 ? "s" : "",
                           mesh.cells.highest_dimension() == 3 ? "element with volume"
                                                               : "element with area"));
  return masses;
}

void add_springs(const std::vector<std::array<std::size_t, 2>>& pairs, double stiffness,
                 Scene& scene) {
  for (const auto& [i, j] : pairs) {
    const double length = (scene.nodes[j].position - scene.nodes[i].position).norm();
    scene.springs.push_back({{i, j}, {.stiffness = stiffness, .rest_length = length}});
  }
}

// Leaves out the vertices at which no edge ends, and their masses; the others keep their order.
// Returns how many. Elements (Mesh::cells) keep the old numbers.
std::size_t leave_out_unused(Mesh& mesh, std::vector<double>& masses) {
  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const auto& edge : mesh.edges) is_used[edge[0]] = is_used[edge[1]] = true;
  std::vector<std::size_t> number(mesh.vertices.size());
  std::size_t used = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    number[i] = used;
    if (!is_used[i]) continue;
    if (!masses.empty()) masses[used] = masses[i];
    mesh.vertices[used++] = mesh.vertices[i];
  }
  const std::size_t unused = mesh.vertices.size() - used;
  if (unused == 0) return 0;
  mesh.vertices.resize(used);
  const auto renumber = [&](auto& all) {
    for (auto& corners : all) {
      for (std::size_t& corner : corners) corner = number[corner];
    }
  };
  renumber(mesh.edges);
  // A triangle that names a corner twice may have corners at which no edge ends: it has no area.
  std::erase_if(mesh.triangles, [&](const auto& corners) {
    return std::ranges::any_of(corners, [&](std::size_t corner) { return !is_used[corner]; });
  });
  renumber(mesh.triangles);
  renumber(mesh.faces);  // whose corners are three, so that an edge ends at each
  for (Group& group : mesh.groups) {
    std::erase_if(group.vertices, [&](std::size_t vertex) { return !is_used[vertex]; });
    for (std::size_t& vertex : group.vertices) vertex = number[vertex];
  }
  std::erase_if(mesh.groups, [](const Group& group) { return group.vertices.empty(); });
  return unused;
}

std::string unused_sentence(const std::string& file, std::size_t unused) {
  return fmt::format("{}: {} {} left out; nodes are numbered without {}", file,
                     unused == 1 ? "1 vertex that no edge uses"
                                 : fmt::format("{} vertices that no edge uses", unused),
                     unused == 1 ? "is" : "are", unused == 1 ? "it" : "them");
}

// Moves vertices as the keys scale, rotation and shift say, in this order. `rotation`: the axis,
// with the angle [degrees] as its length.
void place(const TomlTable& table, double scale, std::vector<Eigen::Vector3d>& vertices) {
  const Eigen::Vector3d turn = table.vector_or_zero("rotation", 3) * (std::numbers::pi / 180),
                        shift = table.vector_or_zero("shift", 3);
  const double angle = turn.norm();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (angle > 0) rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  // Right angles are exact.
  for (double& entry : rotation.reshaped()) {
    if (std::abs(entry - std::round(entry)) < 1e-15) entry = std::round(entry);
  }
  for (Eigen::Vector3d& x : vertices) {
    x *= scale;
    if (angle > 0) x = rotation * x;
    x += shift;
  }
}

// A sentence about parts that no edge joins, as a mesh has along seams; empty if there is one part.
std::string parts_sentence(const std::string& file, const Scene& scene) {
  std::vector<unsigned char> rank(scene.nodes.size());
  std::vector<std::size_t> parent(scene.nodes.size());
  boost::disjoint_sets sets(rank.data(), parent.data());
  for (std::size_t i = 0; i < parent.size(); ++i) sets.make_set(i);
  std::size_t parts = scene.nodes.size();
  for (const Spring& spring : scene.springs) {
    const std::size_t a = sets.find_set(spring.nodes[0]), b = sets.find_set(spring.nodes[1]);
    if (a == b) continue;
    sets.link(a, b);
    --parts;
  }
  if (parts == 1) return "";
  std::vector<Eigen::Vector3d> places;
  for (const Node& node : scene.nodes) places.push_back(node.position);
  const auto to = welded(places, 0);
  std::size_t doubled = 0;
  for (std::size_t i = 0; i < to.size(); ++i) doubled += to[i] != i;
  return fmt::format(
      "{}: it falls into {} parts that no edge joins{}", file, parts,
      doubled == 0 ? ""
                   : fmt::format("; {} lie in the place of another; weld = 1e-9 joins them",
                                 doubled == 1 ? "1 vertex" : fmt::format("{} vertices", doubled)));
}

void pin(const TomlTable& choice, const Mesh& mesh, const CurveReader& curves, Scene& scene) {
  choice.allow_keys({"min", "max", "nodes", "group", "dimension", "motion"});
  const int curve = curves.read(choice, "motion");
  for (const std::size_t node : chosen_nodes(choice, scene, mesh.groups)) {
    scene.nodes[node].pinned = true;
    if (curve >= 0) scene.nodes[node].curve = curve;
  }
}

}  // namespace

void add_mesh(const TomlTable& table, const std::filesystem::path& folder, const TextSource& read,
              const SceneLimits& limits, const CurveReader& curves, Scene& scene) {
  table.allow_keys({"file", "scale", "rotation", "shift", "weld", "velocity", "stiffness",
                    "bending_stiffness", "node_mass", "total_mass", "density", "pin", "load",
                    "air_damping", "damping_time", "pulls_only", "breaks_at"});
  const double scale = table.number_or(1, "scale", positive);
  const double stiffness = table.number("stiffness", not_negative);
  const double bending_stiffness = table.number_or(0, "bending_stiffness", not_negative);
  Mesh mesh = read_file(table, folder, read, scale);
  const std::string file = shown(table.text("file"));
  if (mesh.edges.empty())
    table.fail("file", fmt::format("{} has no edge; allowed are meshes with some", file));
  for (const std::string& warning : mesh.warnings)
    scene.warnings.push_back(fmt::format("{}: {}", file, warning));
  require_one_mass(table);
  place(table, scale, mesh.vertices);
  std::vector<double> masses = masses_by_density(table, mesh);
  if (const std::size_t unused = leave_out_unused(mesh, masses); unused > 0)
    scene.warnings.push_back(unused_sentence(file, unused));
  const auto bending = bending_pairs(table, mesh);
  const SceneSize size{mesh.vertices.size(), mesh.edges.size() + bending.size()};
  require_within(limits, size, table.place());

  if (table.has("node_mass")) masses.assign(size.nodes, table.number("node_mass", not_negative));
  if (table.has("total_mass"))
    masses.assign(size.nodes,
                  table.number("total_mass", not_negative) / static_cast<double>(size.nodes));
  scene.nodes.reserve(size.nodes);
  scene.springs.reserve(size.springs);
  const Eigen::Vector3d velocity = table.vector_or_zero("velocity", 3);
  for (std::size_t i = 0; i < size.nodes; ++i)
    scene.nodes.push_back({.position = mesh.vertices[i], .velocity = velocity, .mass = masses[i]});
  add_springs(mesh.edges, stiffness, scene);
  add_springs(bending, bending_stiffness, scene);
  scene.faces = std::move(mesh.faces);
  for (const TomlTable& choice : table.tables("pin")) pin(choice, mesh, curves, scene);
  add_loads(table, mesh.groups, curves, scene);
  if (const std::string parts = parts_sentence(file, scene); !parts.empty())
    scene.warnings.push_back(parts);
}

}  // namespace qddot
