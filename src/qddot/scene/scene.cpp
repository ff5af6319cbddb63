#include "qddot/scene/scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/rods.hpp"

namespace qddot {
namespace {

// An entry of a scene, for the sentence that refuses it: `index` in the list of nodes, springs or
// faces, or the scene itself if `list` is empty.
struct Entry {
  const std::string& source;
  const char* list = "";
  std::size_t index = 0;

  [[noreturn]] void refuse(const char* field, const std::string& why) const {
    const std::string place = *list ? fmt::format("{}[{}].", list, index) : "";
    throw InvalidInput(fmt::format("{}: {}{}: {}", source, place, field, why));
  }
  void check_finite(const char* field, const Eigen::Vector3d& x) const {
    if (x.allFinite()) return;
    refuse(field, fmt::format("[{}, {}, {}] is not allowed; allowed are finite numbers", x[0], x[1],
                              x[2]));
  }
  void check_not_negative(const char* field, double x) const {
    if (std::isfinite(x) && x >= 0) return;
    refuse(field, fmt::format("{} is not allowed; allowed are finite numbers from 0", x));
  }
  void check_positive(const char* field, double x) const {
    if (std::isfinite(x) && x > 0) return;
    refuse(field, fmt::format("{} is not allowed; allowed are finite numbers above 0", x));
  }
};

void check_node(const Entry& entry, const Node& node) {
  entry.check_finite("position", node.position);
  entry.check_finite("velocity", node.velocity);
  entry.check_finite("load", node.load);
  entry.check_not_negative("mass", node.mass);
}

// Refuses springs that go slack or break where nothing says what happens then.
void check_phases(const Entry& entry, const Spring& spring, const std::vector<Node>& nodes) {
  const SpringLaw& law = spring.law;
  const Node &a = nodes[spring.nodes[0]], &b = nodes[spring.nodes[1]];
  if (!(law.breaks_at > 0))
    entry.refuse("breaks_at",
                 fmt::format("{} is not allowed; allowed are strains above 0", law.breaks_at));
  if (law.can_break() && law.rest_length == 0)
    entry.refuse("breaks_at",
                 "a spring of rest length zero has no strain; allowed are rest lengths above 0");
  if (law.can_break() && a.pinned && b.pinned)
    entry.refuse("breaks_at",
                 "the spring joins two pinned nodes; allowed are springs on a node "
                 "that moves");
  const auto is_massless = [](const Node& node) { return !node.pinned && node.mass == 0; };
  if ((law.goes_slack() || law.can_break()) && (is_massless(a) || is_massless(b)))
    entry.refuse(law.can_break() ? "breaks_at" : "pulls_only",
                 "a node without mass is on it, which nothing would hold; allowed are nodes with "
                 "mass or pins");
}

void check_spring(const Entry& entry, const Spring& spring, const std::vector<Node>& nodes) {
  const auto [i, j] = spring.nodes;
  for (const std::size_t node : {i, j}) {
    if (node >= nodes.size())
      entry.refuse("nodes",
                   fmt::format("{} is not a node; allowed are 0 to {}", node, nodes.size() - 1));
  }
  if (i == j)
    entry.refuse(
        "nodes",
        fmt::format("[{}, {}] joins a node to itself; allowed are two different nodes from "
                    "0 to {}",
                    i, j, nodes.size() - 1));
  entry.check_not_negative("stiffness", spring.law.stiffness);
  entry.check_not_negative("rest_length", spring.law.rest_length);
  entry.check_not_negative("quartic", spring.law.quartic);
  entry.check_not_negative("damping", spring.law.damping);
  if (!std::isfinite(spring.law.cubic))
    entry.refuse("cubic",
                 fmt::format("{} is not allowed; allowed are finite numbers", spring.law.cubic));
  check_phases(entry, spring, nodes);
  if (spring.law.rest_length > 0 && (nodes[j].position - nodes[i].position).norm() == 0)
    entry.refuse("rest_length",
                 fmt::format("{} is not allowed as nodes {} and {} coincide; allowed is 0",
                             spring.law.rest_length, i, j));
}

void check_curve(const Entry& entry, const TimeCurve& curve) {
  for (const Eigen::Vector3d& c : curve.polynomial) entry.check_finite("polynomial", c);
  for (const TimeCurve::Harmonic& harmonic : curve.harmonics) {
    entry.check_finite("amplitude", harmonic.amplitude);
    entry.check_not_negative("frequency", harmonic.frequency);
    if (!std::isfinite(harmonic.phase))
      entry.refuse("phase",
                   fmt::format("{} is not allowed; allowed are finite numbers", harmonic.phase));
  }
  for (const PiecewiseCubic& table : curve.tables) {
    for (const Eigen::Vector3d& value : table.values()) entry.check_finite("values", value);
    const std::vector<double>& times = table.times();
    const bool is_ascending =
        std::ranges::all_of(times, [](double t) { return std::isfinite(t); }) &&
        std::ranges::is_sorted(times, std::less_equal<>());
    if (times.size() < 2 || times.size() != table.values().size() || !is_ascending)
      entry.refuse("times", "allowed are two or more finite times that ascend, each with a value");
  }
}

void check_curves(const std::string& source, const Scene& scene) {
  for (std::size_t i = 0; i < scene.curves.size(); ++i)
    check_curve({source, "curves", i}, scene.curves[i]);
  const int count = static_cast<int>(scene.curves.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (node.curve >= count)
      Entry{source, "nodes", i}.refuse(
          "curve", fmt::format("{} is not a curve; there are {}", node.curve, count));
    if (node.curve >= 0 && !node.pinned && !(node.mass > 0))
      Entry{source, "nodes", i}.refuse("curve",
                                       "a load that changes is not allowed on a node without mass");
  }
  if (scene.gravity_curve >= count)
    Entry{source}.refuse("gravity_curve", fmt::format("{} is not a curve; there are {}",
                                                      scene.gravity_curve, count));
}

// Refuses loads that nothing resists: they would move a node at once and without end.
void check_loads(const std::string& source, const Scene& scene) {
  std::vector<bool> has_spring;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (node.mass > 0 || node.acting_load().isZero(0)) continue;
    if (has_spring.empty()) has_spring = nodes_on_springs(scene);
    if (has_spring[i]) continue;
    Entry{source, "nodes", i}.refuse(
        "load", fmt::format("[{}, {}, {}] is not allowed on a node with neither mass nor a spring "
                            "that pulls; allowed is zero",
                            node.load[0], node.load[1], node.load[2]));
  }
}

void check_face(const Entry& entry, const std::array<std::size_t, 3>& face, std::size_t nodes) {
  const auto [i, j, k] = face;
  if (std::max({i, j, k}) >= nodes || i == j || j == k || k == i)
    entry.refuse(
        "nodes",
        fmt::format("[{}, {}, {}] is not allowed; allowed are three different nodes from 0 to {}",
                    i, j, k, nodes - 1));
}

// 64-bit FNV-1a.
class Hash {
 public:
  // Adds the least significant byte first, in the same order on every machine.
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) {
      hash_ = (hash_ ^ (bits & 0xff)) * 0x00000100000001b3ULL;
    }
  }
  // Adding zero turns -0 into 0: equal numbers, equal hashes.
  void add(double x) { add(std::bit_cast<std::uint64_t>(x + 0.0)); }
  void add(const Eigen::Vector3d& x) {
    for (const double component : x) add(component);
  }
  void add(const TimeCurve& curve) {
    for (const Eigen::Vector3d& c : curve.polynomial) add(c);
    for (const TimeCurve::Harmonic& harmonic : curve.harmonics) {
      add(harmonic.amplitude), add(harmonic.frequency), add(harmonic.phase);
    }
    for (const PiecewiseCubic& table : curve.tables) {
      add(std::uint64_t(table.is_straight()));
      for (const double t : table.times()) add(t);
      for (const Eigen::Vector3d& value : table.values()) add(value);
    }
    // Functions are told apart by some of their values.
    constexpr int values = 64;
    for (const TimeCurve::Own& function : curve.own) {
      for (int k = 0; k < values; ++k) add(function.value(0.137 * k));
    }
  }
  std::string digits() const { return fmt::format("{:016x}", hash_); }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace

std::vector<bool> nodes_on_springs(const Scene& scene) {
  std::vector<bool> is_held(scene.nodes.size(), false);
  for (const Spring& spring : scene.springs) {
    if (spring.law.stiffness == 0 && spring.law.quartic == 0 && spring.law.cubic == 0) continue;
    for (const std::size_t node : spring.nodes) is_held[node] = true;
  }
  return is_held;
}

bool is_damped(const Scene& scene) {
  return scene.air_damping > 0 || std::ranges::any_of(scene.springs, [](const Spring& spring) {
           return spring.law.damping > 0;
         });
}

bool is_driven(const Scene& scene) {
  return scene.gravity_curve >= 0 ||
         std::ranges::any_of(scene.nodes, [](const Node& node) { return node.curve >= 0; });
}

bool changes_phases(const Scene& scene) {
  return std::ranges::any_of(scene.springs, [](const Spring& spring) {
    return spring.law.goes_slack() || spring.law.can_break();
  });
}

std::optional<Scene> with_supports_at_start(const Scene& scene) {
  std::optional<Scene> placed;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (!node.pinned || node.curve < 0) continue;
    const TimeCurve& curve = scene.curves[static_cast<std::size_t>(node.curve)];
    const Eigen::Vector3d start = curve.at(0);
    if (start.isZero(0)) continue;
    if (!placed) placed = scene;
    placed->nodes[i].position += start;
    placed->nodes[i].curve = static_cast<int>(placed->curves.size());
    placed->curves.push_back(curve);
    placed->curves.back().shift(-start);
  }
  return placed;
}

void damp_springs(double damping_time, Scene& scene) {
  for (Spring& spring : scene.springs) {
    if (spring.law.damping == 0) spring.law.damping = damping_time * spring.law.stiffness;
  }
}

void validate(const Scene& scene, const std::string& source) {
  const Entry whole{source};
  if (scene.dimension < 1 || scene.dimension > 3)
    whole.refuse("dimension",
                 fmt::format("{} is not allowed; allowed are 1, 2 and 3", scene.dimension));
  whole.check_finite("gravity", scene.gravity);
  if (scene.until) whole.check_positive("until", *scene.until);
  if (scene.stiff_above) whole.check_positive("stiff_above", *scene.stiff_above);
  whole.check_not_negative("air_damping", scene.air_damping);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    check_node({source, "nodes", i}, scene.nodes[i]);
  for (std::size_t i = 0; i < scene.springs.size(); ++i)
    check_spring({source, "springs", i}, scene.springs[i], scene.nodes);
  check_loads(source, scene);
  check_curves(source, scene);
  validate_rods(scene, source);
  for (std::size_t i = 0; i < scene.faces.size(); ++i)
    check_face({source, "faces", i}, scene.faces[i], scene.nodes.size());
}

std::string content_hash(const Scene& scene) {
  Hash hash;
  hash.add(std::uint64_t(scene.dimension));
  hash.add(scene.gravity);
  hash.add(scene.nodes.size());
  for (const Node& node : scene.nodes) {
    hash.add(std::uint64_t(node.pinned));
    hash.add(node.position);
    if (node.pinned) continue;  // its mass and velocity have no effect
    hash.add(node.velocity);
    hash.add(node.mass);
  }
  for (const Spring& spring : scene.springs) {
    for (const std::size_t node : spring.nodes) hash.add(node);
    hash.add(spring.law.stiffness);
    hash.add(spring.law.rest_length);
    hash.add(spring.law.quartic);
  }
  // The flag is added only if it is true, which keeps the hashes of all other scenes.
  if (scene.starts_at_equilibrium) hash.add(std::uint64_t(1));
  // Likewise loads.
  if (has_loads(scene)) {
    for (const Node& node : scene.nodes) hash.add(node.acting_load());
  }
  // Likewise damping.
  if (is_damped(scene)) {
    hash.add(scene.air_damping);
    for (const Spring& spring : scene.springs) hash.add(spring.law.damping);
  }
  // Likewise springs that are not plain.
  for (const Spring& spring : scene.springs) {
    if (spring.law.is_plain()) continue;
    hash.add(static_cast<std::uint64_t>(&spring - scene.springs.data()));
    hash.add(spring.law.cubic);
    hash.add(spring.law.breaks_at);
    hash.add(std::uint64_t(spring.law.goes_slack()));
    if (spring.law.rigid) hash.add(std::uint64_t(2));
  }
  // Likewise what changes with time.
  if (is_driven(scene)) {
    for (const TimeCurve& curve : scene.curves) hash.add(curve);
    for (const Node& node : scene.nodes) hash.add(std::uint64_t(node.curve + 1));
    hash.add(std::uint64_t(scene.gravity_curve + 1));
  }
  return hash.digits();
}

}  // namespace qddot
