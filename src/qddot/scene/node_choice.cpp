#include "qddot/scene/node_choice.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/scene/text_file.hpp"

namespace qddot {
namespace {

using mesh::Group;

std::string point_in_words(const Eigen::Vector3d& x, int dimension) {
  std::vector<std::string> numbers;
  for (int d = 0; d < dimension; ++d) numbers.push_back(fmt::format("{:.6g}", x[d]));
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}

std::vector<std::size_t> nodes_in_box(const TomlTable& choice, const Scene& scene) {
  const int dimension = scene.dimension;
  const Eigen::Vector3d low = choice.vector("min", dimension),
                        high = choice.vector("max", dimension);
  if ((low.array() > high.array()).any()) choice.refuse("max", "arrays that are nowhere below min");
  std::vector<std::size_t> inside;
  Eigen::AlignedBox3d all;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const auto x = scene.nodes[i].position.array();
    if ((low.array() <= x && x <= high.array()).all()) inside.push_back(i);
    all.extend(scene.nodes[i].position);
  }
  if (inside.empty())
    choice.fail("min", fmt::format("the box {} to {} holds no node of the scene, which spans {} to "
                                   "{}; allowed are boxes that hold one",
                                   point_in_words(low, dimension), point_in_words(high, dimension),
                                   point_in_words(all.min(), dimension),
                                   point_in_words(all.max(), dimension)));
  return inside;
}

// "left" of dimension 2, or 7 of dimension 1.
std::string in_words(const Group& group) {
  return fmt::format(
      "{} of dimension {}",
      group.name.empty() ? std::to_string(group.tag) : fmt::format("\"{}\"", shown(group.name)),
      group.dimension);
}

std::string list_of(std::span<const Group> groups) {
  constexpr std::size_t most = 20;
  if (groups.empty()) return "meshes with groups, and this one has none";
  std::vector<std::string> words;
  for (const Group& group : groups.first(std::min(most, groups.size())))
    words.push_back(in_words(group));
  return fmt::format("{}{}", fmt::join(words, ", "), groups.size() > most ? ", ..." : "");
}

std::vector<std::size_t> nodes_of_group(const TomlTable& choice, std::span<const Group> groups) {
  const bool by_name = choice.is_text("group");
  const std::string name = by_name ? choice.text("group") : "";
  constexpr int most = std::numeric_limits<int>::max();
  const int tag = by_name ? 0 : choice.integer("group", -most, most);
  const bool has_dimension = choice.has("dimension");
  const int dimension = has_dimension ? choice.integer("dimension", 0, 3) : 0;
  std::vector<Group> found;
  for (const Group& group : groups) {
    if (by_name ? group.name != name : group.tag != tag) continue;
    if (!has_dimension || group.dimension == dimension) found.push_back(group);
  }
  if (found.empty()) choice.refuse("group", list_of(groups));
  if (found.size() > 1)
    choice.fail("group", fmt::format("it is not clear which of these it is: {}; allowed is to say "
                                     "the dimension of its elements, as dimension = {}",
                                     list_of(found), found[0].dimension));
  return found[0].vertices;
}

}  // namespace

std::vector<std::size_t> chosen_nodes(const TomlTable& choice, const Scene& scene,
                                      std::span<const Group> groups) {
  const bool by_nodes = choice.has("nodes"), by_group = choice.has("group"),
             by_box = choice.has("min") || choice.has("max");
  if (by_nodes + by_group + by_box > 1)
    choice.fail(by_nodes ? "nodes" : "group",
                "allowed is one of nodes, group, and a box from min to max");
  if (choice.has("dimension") && !by_group)
    choice.fail("dimension", "it is that of a group's elements; allowed is it beside group alone");
  if (by_group) return nodes_of_group(choice, groups);
  if (!by_nodes) return nodes_in_box(choice, scene);
  std::vector<std::size_t> nodes = choice.nodes("nodes", scene.nodes.size());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void add_loads(const TomlTable& source, std::span<const Group> groups, const CurveReader& curves,
               Scene& scene) {
  for (const TomlTable& load : source.tables("load")) {
    load.allow_keys(
        {"min", "max", "nodes", "group", "dimension", "force", "total_force", "force_in_time"});
    const std::vector<std::size_t> nodes = chosen_nodes(load, scene, groups);
    const bool is_total = load.has("total_force"), is_driven = load.has("force_in_time");
    if (is_total + load.has("force") + is_driven != 1)
      load.fail(is_total ? "total_force" : "force",
                "allowed is exactly one of force, on each node, total_force, and force_in_time, on "
                "each node");
    if (is_driven) {
      const int curve = curves.read(load, "force_in_time");
      for (const std::size_t node : nodes) {
        if (scene.nodes[node].curve >= 0)
          load.fail("force_in_time", fmt::format("node {} has a curve already", node));
        if (!scene.nodes[node].pinned) scene.nodes[node].curve = curve;
      }
      continue;
    }
    Eigen::Vector3d force = load.vector(is_total ? "total_force" : "force", scene.dimension);
    if (is_total) force /= static_cast<double>(nodes.size());
    for (const std::size_t node : nodes) scene.nodes[node].load += force;
  }
}

}  // namespace qddot
