#include "qddot/scene/scene_file.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/scene/curve_reader.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/mesh/mesh.hpp"
#include "qddot/scene/mesh/mesh_scene.hpp"
#include "qddot/scene/node_choice.hpp"
#include "qddot/scene/rods.hpp"
#include "qddot/scene/toml_table.hpp"

namespace qddot {
namespace {

Node node_in(const TomlTable& table, int dimension, const CurveReader& curves) {
  table.allow_keys({"position", "velocity", "mass", "pinned", "load", "motion", "load_in_time"});
  Node node;
  node.position = table.vector("position", dimension);
  node.velocity = table.vector_or_zero("velocity", dimension);
  node.pinned = table.flag_or_false("pinned");
  node.load = table.vector_or_zero("load", dimension);
  if (!node.pinned || table.has("mass")) node.mass = table.number("mass", not_negative);
  const char* wrong = node.pinned ? "load_in_time" : "motion";
  if (table.has(wrong))
    table.fail(wrong, node.pinned ? "a pin carries it; allowed is motion"
                                  : "it is for pinned nodes; allowed is load_in_time");
  node.curve = curves.read(table, node.pinned ? "motion" : "load_in_time");
  return node;
}

constexpr double never = std::numeric_limits<double>::infinity();

Spring spring_in(const TomlTable& table, const std::vector<Node>& nodes) {
  table.allow_keys({"nodes", "stiffness", "rest_length", "cubic", "quartic", "damping",
                    "pulls_only", "breaks_at"});
  const auto [i, j] = table.node_pair("nodes", nodes.size());
  const double distance = (nodes[j].position - nodes[i].position).norm();
  return {.nodes = {i, j},
          .law = {.stiffness = table.number("stiffness", not_negative),
                  .rest_length = table.number_or(distance, "rest_length", not_negative),
                  .quartic = table.number_or(0, "quartic", not_negative),
                  .damping = table.number_or(0, "damping", not_negative),
                  .cubic = table.number_or(0, "cubic"),
                  .breaks_at = table.number_or(never, "breaks_at", positive),
                  .pulls_only = table.flag_or_false("pulls_only")}};
}

Spring rod_in(const TomlTable& table, const std::vector<Node>& nodes) {
  table.allow_keys({"nodes", "length"});
  const auto [i, j] = table.node_pair("nodes", nodes.size());
  const double distance = (nodes[j].position - nodes[i].position).norm();
  return {.nodes = {i, j},
          .law = {.rest_length = table.number_or(distance, "length", positive), .rigid = true}};
}

// The keys of [mesh] and of [generator] that are for each of its springs.
void set_laws(const TomlTable& table, Scene& scene) {
  const double breaks_at = table.number_or(never, "breaks_at", positive);
  const bool pulls_only = table.flag_or_false("pulls_only");
  for (Spring& spring : scene.springs) {
    if (table.has("breaks_at")) spring.law.breaks_at = breaks_at;
    spring.law.pulls_only = spring.law.pulls_only || pulls_only;
  }
}

void add_nodes_and_springs(const TomlTable& file, const SceneLimits& limits,
                           const CurveReader& curves, Scene& scene) {
  file.allow_keys({"name", "dimension", "gravity", "until", "start", "stiff_above", "rods_above",
                   "air_damping", "damping_time", "gravity_in_time", "curves", "nodes", "springs",
                   "rods"});
  const std::vector<TomlTable> nodes = file.tables("nodes"), springs = file.tables("springs"),
                               rods = file.tables("rods");
  require_within(limits, {nodes.size(), springs.size() + rods.size()}, file.place());
  for (const TomlTable& table : nodes)
    scene.nodes.push_back(node_in(table, scene.dimension, curves));
  if (scene.nodes.empty()) file.refuse("nodes", "lists of at least one node");
  for (const TomlTable& table : springs) scene.springs.push_back(spring_in(table, scene.nodes));
  for (const TomlTable& table : rods) scene.springs.push_back(rod_in(table, scene.nodes));
}

// The keys of a scene, of [mesh] and of [generator]. One in the table is for the whole scene.
void add_damping(const TomlTable& table, Scene& scene) {
  if (table.has("air_damping")) scene.air_damping = table.number("air_damping", not_negative);
  if (table.has("damping_time")) damp_springs(table.number("damping_time", not_negative), scene);
}

std::string generator_names() {
  std::vector<std::string> names;
  for (const Generator& generator : generators()) names.push_back(generator.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

// Moves the pinned nodes of each choice.
void move_supports(const TomlTable& source, const CurveReader& curves, Scene& scene) {
  for (const TomlTable& motion : source.tables("motion")) {
    motion.allow_keys({"min", "max", "nodes", "curve"});
    const int curve = curves.read(motion, "curve");
    if (curve < 0) motion.refuse("curve", "tables and names of [[curves]]");
    bool any = false;
    for (const std::size_t node : chosen_nodes(motion, scene, {})) {
      if (!scene.nodes[node].pinned) continue;
      scene.nodes[node].curve = curve;
      any = true;
    }
    if (!any) motion.fail("curve", "none of the chosen nodes is pinned; allowed are pinned ones");
  }
}

// The generator's scene. Curves are read when it is drawn, as its dimension is known then.
Scene generated(const TomlTable& file, const TomlTable& table, const SceneLimits& limits) {
  const std::string kind = table.text("kind");
  const Generator* generator = find_generator(kind);
  if (!generator) table.refuse("kind", generator_names());
  GeneratorValues values;
  for (const std::string& key : table.keys()) {
    constexpr std::array own{"kind", "load", "motion", "pulls_only", "breaks_at"};
    if (std::ranges::find(own, key) == own.end()) values[key] = table.number(key);
  }
  Scene scene = generate(*generator, values, table.place(), limits);
  set_laws(table, scene);
  const CurveReader curves(file, scene);
  scene.gravity_curve = curves.read(file, "gravity_in_time");
  add_loads(table, {}, curves, scene);
  move_supports(table, curves, scene);
  return scene;
}

// Throws InvalidInput unless the nodes come from exactly one of their possible origins.
void require_one_origin(const TomlTable& file) {
  std::vector<std::string> given;
  for (const auto& [key, written] : {std::pair("nodes", "[[nodes]]"), std::pair("mesh", "[mesh]"),
                                     std::pair("generator", "[generator]")}) {
    if (file.has(key)) given.emplace_back(written);
  }
  if (given.size() == 1) return;
  constexpr const char* allowed = "allowed is exactly one of [[nodes]], [mesh] and [generator]";
  if (given.empty())
    throw InvalidInput(fmt::format("{}: a scene needs nodes; {}", file.place(), allowed));
  throw InvalidInput(fmt::format("{}: {} each make a scene of their own; {}", file.place(),
                                 fmt::join(given, " and "), allowed));
}

bool starts_at_equilibrium(const TomlTable& file) {
  if (!file.has("start")) return false;
  const std::string start = file.text("start");
  if (start != "drawn" && start != "equilibrium")
    file.refuse("start", "\"drawn\" and \"equilibrium\"");
  return start == "equilibrium";
}

// Warns of nodes with undetermined motion: no mass, no pin, and no spring that pulls.
void warn_of_loose_nodes(Scene& scene) {
  const std::vector<bool> is_held = nodes_on_springs(scene);
  std::vector<std::size_t> loose;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (!scene.nodes[i].pinned && scene.nodes[i].mass == 0 && !is_held[i]) loose.push_back(i);
  }
  if (loose.empty()) return;
  constexpr std::size_t most = 8;
  const std::span listed(loose.data(), std::min(most, loose.size()));
  scene.warnings.push_back(fmt::format(
      "node{} {}{} {} neither a mass nor a spring that pulls, so that nothing decides {} motion: "
      "{} the drawn velocity for ever, without weight",
      loose.size() == 1 ? "" : "s", fmt::join(listed, ", "), loose.size() > most ? ", ..." : "",
      loose.size() == 1 ? "has" : "have", loose.size() == 1 ? "its" : "their",
      loose.size() == 1 ? "it keeps" : "they keep"));
}

// Warns of loads on pinned nodes, as boxes may put them there.
void warn_of_carried_loads(Scene& scene) {
  const auto carried = std::ranges::count_if(
      scene.nodes, [](const Node& node) { return node.pinned && !node.load.isZero(0); });
  if (carried == 0) return;
  scene.warnings.push_back(fmt::format(
      "{} and move{} nothing",
      carried == 1 ? "the load of 1 pinned node is carried by its pin"
                   : fmt::format("the loads of {} pinned nodes are carried by their pins", carried),
      carried == 1 ? "s" : ""));
}

void require_no_mesh(const std::string& path) {
  if (!mesh::is_mesh_file(path)) return;
  throw InvalidInput(fmt::format(
      "{}: it is a mesh, not a scene; allowed are scene files, which name a mesh in a table [mesh] "
      "with file = \"{}\"",
      path, std::filesystem::path(path).filename().string()));
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& path,
                  const std::filesystem::path& folder, const SceneLimits& limits,
                  const TextSource& read) {
  const toml::table content = parse_toml(text, path);
  const TomlTable file(content, path);
  require_one_origin(file);
  Scene scene;
  if (file.has("generator")) {
    file.allow_keys({"name", "until", "start", "stiff_above", "rods_above", "air_damping",
                     "damping_time", "gravity_in_time", "curves", "generator"});
    scene = generated(file, file.table("generator"), limits);
  } else if (file.has("mesh")) {
    file.allow_keys({"name", "dimension", "gravity", "until", "start", "stiff_above", "rods_above",
                     "air_damping", "damping_time", "gravity_in_time", "curves", "mesh"});
    if (file.has("dimension")) file.integer("dimension", 3, 3);
    const CurveReader curves(file, scene);
    scene.gravity_curve = curves.read(file, "gravity_in_time");
    add_mesh(file.table("mesh"), folder, read, limits, curves, scene);
    add_damping(file.table("mesh"), scene);
    set_laws(file.table("mesh"), scene);
  } else {
    scene.dimension = file.integer("dimension", 1, 3);
    const CurveReader curves(file, scene);
    scene.gravity_curve = curves.read(file, "gravity_in_time");
    add_nodes_and_springs(file, limits, curves, scene);
  }
  scene.name = file.has("name") ? file.text("name") : std::filesystem::path(path).stem().string();
  if (file.has("until")) scene.until = file.number("until", positive);
  if (file.has("gravity")) scene.gravity = file.vector("gravity", scene.dimension);
  if (file.has("stiff_above")) scene.stiff_above = file.number("stiff_above", positive);
  if (file.has("rods_above")) make_rods_above(file.number("rods_above", positive), scene);
  scene.starts_at_equilibrium = starts_at_equilibrium(file);
  add_damping(file, scene);
  validate(scene, path);
  warn_of_loose_nodes(scene);
  warn_of_carried_loads(scene);
  return scene;
}

Scene read_scene(const std::string& path) {
  require_no_mesh(path);
  return parse_scene(read_text(path), path, std::filesystem::path(path).parent_path());
}

Scene load_scene(const std::string& name_or_path, const TextSource& read,
                 const SceneLimits& limits) {
  if (const Generator* generator = find_generator(name_or_path))
    return generate(*generator, {}, name_or_path, limits);
  std::error_code ignored;
  if (std::filesystem::exists(name_or_path, ignored)) {
    require_no_mesh(name_or_path);
    return parse_scene(read(name_or_path), name_or_path,
                       std::filesystem::path(name_or_path).parent_path(), limits, read);
  }
  throw InvalidInput(fmt::format("{}: it is neither a file nor a generator; allowed are {}",
                                 name_or_path, generator_names()));
}

}  // namespace qddot
