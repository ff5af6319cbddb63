#include "tests/independent/random_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <Eigen/Geometry>

namespace qddot {
inline namespace tests {
namespace {

using Eigen::Vector3d;

// Random numbers that are the same with every standard library.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  double decades(double low, double high) { return std::pow(10, uniform(low, high)); }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  bool is(double probability) { return uniform(0, 1) < probability; }
  // Its first `dimension` coordinates within `size` of zero.
  Vector3d vector(int dimension, double size) {
    Vector3d x = Vector3d::Zero();
    for (int d = 0; d < dimension; ++d) x[d] = uniform(-size, size);
    return x;
  }
  Eigen::Matrix3d rotation(int dimension) {
    if (dimension == 1) return Eigen::Matrix3d::Identity();
    const Vector3d axis = dimension == 2 ? Vector3d(0, 0, 1) : vector(3, 1).normalized();
    return Eigen::AngleAxisd(uniform(0.1, 3), axis).toRotationMatrix();
  }

 private:
  std::mt19937_64 random_;
};

bool coincide(const Scene& scene, std::size_t i, std::size_t j) {
  return scene.nodes[i].position == scene.nodes[j].position;
}

// A spring between nodes that is stretched or compressed by up to `strain` where they are drawn.
// Nodes at one place are only joined with rest length zero.
void join(Scene& scene, Chance& chance, std::size_t i, std::size_t j, double strain = 0.2) {
  const double length = (scene.nodes[j].position - scene.nodes[i].position).norm();
  SpringLaw law{.stiffness = chance.decades(1, 3)};
  law.rest_length = chance.is(0.1) ? 0 : length * chance.uniform(1 - strain, 1 + strain);
  if (chance.is(0.15)) law.quartic = chance.decades(1, 3);
  scene.springs.push_back({{i, j}, law});
}

// Nodes by chance, each joined to one before it and some to others.
void add_network(Scene& scene, Chance& chance, std::size_t count, int dimension) {
  const std::size_t first = scene.nodes.size();
  for (std::size_t k = 0; k < count; ++k) {
    Node node{.mass = chance.decades(-1, 0.5)};
    // About a metre apart; on a line in a row, so that springs seldom turn over.
    for (int attempt = 0; attempt < 100; ++attempt) {
      node.position = dimension == 1
                          ? Vector3d(static_cast<double>(k) + chance.uniform(-0.3, 0.3), 0, 0)
                          : chance.vector(dimension, 0.6 * std::sqrt(static_cast<double>(count)));
      const auto is_apart = [&](const Node& other) {
        return (other.position - node.position).norm() > 0.5;
      };
      if (std::all_of(scene.nodes.begin() + static_cast<std::ptrdiff_t>(first), scene.nodes.end(),
                      is_apart))
        break;
    }
    node.velocity = chance.vector(dimension, 1);
    scene.nodes.push_back(node);
    const std::size_t own = scene.nodes.size() - 1;
    if (k > 0) join(scene, chance, dimension == 1 ? own - 1 : first + chance.below(k), own);
    if (k > 1 && dimension > 1) {
      for (int extra = 0; extra < 2; ++extra) {
        const std::size_t other = first + chance.below(k);
        join(scene, chance, other, own);
      }
    }
  }
}

void pin_some(Scene& scene, Chance& chance, double probability) {
  for (Node& node : scene.nodes) node.pinned = chance.is(probability);
  if (std::ranges::all_of(scene.nodes, &Node::pinned)) scene.nodes.back().pinned = false;
}

void load_some(Scene& scene, Chance& chance) {
  if (!chance.is(0.4)) return;
  const double share = chance.uniform(0.1, 1);
  for (Node& node : scene.nodes) {
    if (chance.is(share)) node.load = chance.vector(scene.dimension, 0.3);
  }
}

void pull(Scene& scene, Chance& chance) {
  if (chance.is(0.5)) scene.gravity = chance.vector(scene.dimension, 3);
  load_some(scene, chance);
}

// The scene with its mirror images in `planes` coordinate planes, joined across them. Nodes on a
// plane are their own images or, where they `part_there`, one of two that start at one place.
Scene mirrored(const Scene& half, Chance& chance, int planes, bool part_there) {
  Scene scene = half;
  for (int d = 0; d < planes; ++d) {
    scene.gravity[d] = 0;
    for (Node& node : scene.nodes) {
      if (!chance.is(0.4)) continue;
      node.position[d] = 0;
      // Else it and its image start at one place and part.
      if (!part_there) node.velocity[d] = node.load[d] = 0;
    }
  }
  for (int d = 0; d < planes; ++d) {
    const std::size_t count = scene.nodes.size(), springs = scene.springs.size();
    std::vector<std::size_t> image(count);
    for (std::size_t i = 0; i < count; ++i) {
      Node other = scene.nodes[i];
      const bool is_on_plane =
          other.position[d] == 0 && other.velocity[d] == 0 && other.load[d] == 0;
      other.position[d] *= -1, other.velocity[d] *= -1, other.load[d] *= -1;
      image[i] = is_on_plane ? i : scene.nodes.size();
      if (image[i] != i) scene.nodes.push_back(other);
    }
    for (std::size_t e = 0; e < springs; ++e) {
      Spring other = scene.springs[e];
      for (std::size_t& node : other.nodes) node = image[node];
      if (other.nodes != scene.springs[e].nodes) scene.springs.push_back(other);
    }
    // Every node to its own image alike, so that the mirrors before this one stay.
    const double stiffness = chance.decades(1, 3), strain = chance.uniform(0.8, 1.2);
    for (std::size_t i = 0; i < count; ++i) {
      if (image[i] == i) continue;
      const double length = (scene.nodes[i].position - scene.nodes[image[i]].position).norm();
      scene.springs.push_back({{i, image[i]}, {stiffness, strain * length}});
    }
  }
  return scene;
}

// Drops springs of length zero, whose rest length would need a direction.
void drop_impossible(Scene& scene) {
  std::erase_if(scene.springs, [&](const Spring& spring) {
    const auto [i, j] = spring.nodes;
    return i == j || (coincide(scene, i, j) && spring.law.rest_length > 0);
  });
}

Scene lattice(Chance& chance, int dimension, std::size_t side, std::size_t layers) {
  Scene scene{.dimension = dimension};
  const double stiffness = chance.decades(1, 3);
  for (std::size_t layer = 0; layer < layers; ++layer) {
    for (std::size_t i = 0; i < side; ++i) {
      for (std::size_t j = 0; j < side; ++j) {
        scene.nodes.push_back(
            {.position = {static_cast<double>(i), static_cast<double>(j), 0}, .mass = 1});
      }
    }
  }
  const double strain = chance.is(0.5) ? 1 : chance.uniform(0.8, 1.2);
  const auto at = [&](std::size_t layer, std::size_t i, std::size_t j) {
    return (layer * side + i) * side + j;
  };
  for (std::size_t layer = 0; layer < layers; ++layer) {
    for (std::size_t i = 0; i < side; ++i) {
      for (std::size_t j = 0; j < side; ++j) {
        const SpringLaw law{stiffness, strain};
        if (i + 1 < side) scene.springs.push_back({{at(layer, i, j), at(layer, i + 1, j)}, law});
        if (j + 1 < side) scene.springs.push_back({{at(layer, i, j), at(layer, i, j + 1)}, law});
        if (layer > 0) scene.springs.push_back({{at(0, i, j), at(layer, i, j)}, {stiffness}});
      }
    }
  }
  return scene;
}

// A chain along the first axis: between two pins, compressed or stretched, moving along itself.
Scene straight_chain(Chance& chance, int dimension, std::size_t count) {
  Scene scene{.dimension = dimension};
  const double strain = chance.uniform(0.85, 1.15);
  for (std::size_t i = 0; i < count; ++i) {
    scene.nodes.push_back({.position = {static_cast<double>(i), 0, 0},
                           .velocity = {chance.uniform(-0.3, 0.3), 0, 0},
                           .mass = chance.decades(-0.5, 0.5)});
    if (i > 0) scene.springs.push_back({{i - 1, i}, {chance.decades(1, 3), strain}});
  }
  scene.nodes.front().pinned = true;
  scene.nodes.back().pinned = chance.is(0.7);
  return scene;
}

// Massless joints between nodes of a chain in tension; some with three springs, which stay.
Scene jointed(Chance& chance, int dimension) {
  Scene scene{.dimension = dimension};
  add_network(scene, chance, 3 + chance.below(3), dimension);
  scene.nodes[0].pinned = true;
  const std::size_t masses = scene.nodes.size(), springs = scene.springs.size();
  for (Node& node : scene.nodes) node.velocity *= 0.3;
  for (std::size_t e = 0; e < springs; ++e) {
    if (!chance.is(0.5)) continue;
    const auto [i, j] = scene.springs[e].nodes;
    const Vector3d a = scene.nodes[i].position, b = scene.nodes[j].position;
    const double share = chance.uniform(0.3, 0.7), length = (b - a).norm();
    Node joint{.position = a + share * (b - a) + chance.vector(dimension, 0.02)};
    scene.nodes.push_back(joint);
    const std::size_t own = scene.nodes.size() - 1;
    const double slack = chance.uniform(0.5, 0.95);
    scene.springs[e] = {{i, own}, {chance.decades(1, 3), slack * share * length}};
    scene.springs.push_back({{own, j}, {chance.decades(1, 3), slack * (1 - share) * length}});
    if (chance.is(0.3)) {
      scene.springs.push_back({{own, chance.below(masses)}, {chance.decades(1, 2), 0.1}});
    }
  }
  drop_impossible(scene);
  return scene;
}

void move(Scene& scene, const Eigen::Matrix3d& rotation, const Vector3d& shift) {
  for (Node& node : scene.nodes) {
    node.position = rotation * node.position + shift;
    node.velocity = rotation * node.velocity;
    node.load = rotation * node.load;
  }
  scene.gravity = rotation * scene.gravity;
}

// The same scene with its nodes in another order.
void shuffle(Scene& scene, Chance& chance) {
  std::vector<std::size_t> place(scene.nodes.size());
  std::iota(place.begin(), place.end(), 0);
  for (std::size_t i = place.size(); i > 1; --i) std::swap(place[i - 1], place[chance.below(i)]);
  std::vector<Node> nodes = scene.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) scene.nodes[place[i]] = nodes[i];
  for (Spring& spring : scene.springs) {
    for (std::size_t& node : spring.nodes) node = place[node];
  }
}

// A scene without pins, thrown as a whole, under gravity in any direction. It moves about its
// centre of mass in any way, in a plane, along a line, with massless joints, or not at all.
// Sometimes there is another part, which may be pinned.
Scene falling(Chance& chance, int dimension) {
  const std::size_t variant = chance.below(5);
  if (variant == 2) dimension = std::max(dimension, 2);  // joints on a line are another matter
  Scene scene{.dimension = dimension};
  if (variant == 0) {
    scene = straight_chain(chance, dimension, 3 + chance.below(5));
  } else if (variant == 1) {
    add_network(scene, chance, 3 + chance.below(4), std::min(dimension, 2));
  } else if (variant == 2) {
    scene = jointed(chance, dimension);
  } else {
    add_network(scene, chance, 2 + chance.below(6), dimension);
  }
  for (Node& node : scene.nodes) {
    node.pinned = false;
    if (variant == 3) node.velocity.setZero();
  }
  if (variant == 3) {
    for (Spring& spring : scene.springs) {
      const auto [i, j] = spring.nodes;
      spring.law.rest_length = (scene.nodes[j].position - scene.nodes[i].position).norm();
    }
  }
  if (chance.is(0.5)) move(scene, chance.rotation(dimension), chance.vector(dimension, 2));
  const Vector3d thrown = chance.is(0.8) ? chance.vector(dimension, 3) : Vector3d::Zero();
  for (Node& node : scene.nodes) node.velocity += thrown;
  scene.gravity = chance.is(0.8) ? chance.vector(dimension, 9.81) : Vector3d::Zero();
  load_some(scene, chance);
  if (chance.is(0.3)) {
    const std::size_t first = scene.nodes.size();
    add_network(scene, chance, 1 + chance.below(3), dimension);
    scene.nodes[first].pinned = chance.is(0.5);
  }
  return scene;
}

// Some vibrations of the stiffest spring between the lightest nodes.
double some_vibrations(const Scene& scene, Chance& chance) {
  double fastest = 1;
  for (const Spring& spring : scene.springs) {
    double share = 0;
    for (const std::size_t i : spring.nodes) {
      const Node& node = scene.nodes[i];
      if (!node.pinned && node.mass > 0) share += 1 / node.mass;
    }
    fastest = std::max(fastest, spring.law.stiffness * share);
  }
  return 2 * M_PI / std::sqrt(fastest) * chance.uniform(2, 8);
}

Scene of_kind(const std::string& kind, Chance& chance) {
  const int dimension = 1 + static_cast<int>(chance.below(3));
  const auto space = std::max(dimension, 2);
  Scene scene{.dimension = dimension};
  if (kind == "mirrored" || kind == "coincident") {
    Scene half{.dimension = dimension};
    add_network(half, chance, 1 + chance.below(4), dimension);
    for (Node& node : half.nodes)
      node.position +=
          0.8 * Vector3d::Ones().cwiseProduct(Vector3d(1, dimension > 1, dimension > 2));
    pull(half, chance);
    scene = mirrored(half, chance,
                     1 + static_cast<int>(chance.below(static_cast<std::size_t>(dimension))),
                     kind == "coincident");
    if (kind == "coincident" && chance.is(0.3))
      scene = lattice(chance, space, 3 + chance.below(3), 2);
    if (chance.is(0.5))
      move(scene, chance.rotation(scene.dimension), chance.vector(scene.dimension, 2));
  } else if (kind == "straight" || kind == "nearly straight") {
    scene = straight_chain(chance, space, 3 + chance.below(5));
    const bool is_nearly = kind != "straight";
    if (is_nearly) scene.nodes[1].position[1] += chance.decades(-12, -6);
    move(scene, chance.is(0.5) ? chance.rotation(space) : Eigen::Matrix3d::Identity(),
         chance.vector(space, 2));
  } else if (kind == "planar") {
    add_network(scene, chance, 3 + chance.below(5), 2);
    pin_some(scene, chance, 0.2);
    scene.dimension = 2;
    pull(scene, chance);
    scene.dimension = 3;
    move(scene, chance.is(0.5) ? chance.rotation(3) : Eigen::Matrix3d::Identity(),
         chance.vector(3, 2));
  } else if (kind == "parts") {
    for (std::size_t part = 0; part < 2 + chance.below(3); ++part)
      add_network(scene, chance, 1 + chance.below(3), dimension);
    pin_some(scene, chance, 0.2);
    pull(scene, chance);
    const std::size_t springs = scene.springs.size();
    for (std::size_t e = 0; e < springs; ++e) {
      if (!chance.is(0.3)) continue;
      Spring twin = scene.springs[e];
      twin.law.stiffness = chance.is(0.3) ? 0 : chance.decades(1, 3);
      if (chance.is(0.5)) std::swap(twin.nodes[0], twin.nodes[1]);
      scene.springs.push_back(twin);
    }
  } else if (kind == "zero lengths") {
    add_network(scene, chance, 2 + chance.below(6), dimension);
    pin_some(scene, chance, 0.2);
    pull(scene, chance);
    for (Spring& spring : scene.springs) spring.law.rest_length = spring.law.quartic = 0;
  } else if (kind == "massless") {
    scene = jointed(chance, space);
    pull(scene, chance);
  } else if (kind == "falling") {
    scene = falling(chance, dimension == 1 && chance.is(0.7) ? space : dimension);
  } else if (kind == "far") {
    add_network(scene, chance, 3 + chance.below(4), dimension);
    pin_some(scene, chance, 0.2);
    pull(scene, chance);
    move(scene, Eigen::Matrix3d::Identity(), chance.decades(3, 6) * chance.vector(dimension, 1));
  } else {
    add_network(scene, chance, 2 + chance.below(7), dimension);
    pin_some(scene, chance, 0.2);
    pull(scene, chance);
  }
  return scene;
}

}  // namespace

RandomScene random_scene(std::uint64_t seed) {
  constexpr std::array<const char*, 11> kinds = {
      "network", "mirrored",     "coincident", "straight", "nearly straight", "planar",
      "parts",   "zero lengths", "massless",   "far",      "falling"};
  Chance chance(seed);
  RandomScene random{{}, kinds[seed % kinds.size()]};
  random.scene = of_kind(random.kind, chance);
  drop_impossible(random.scene);
  if (chance.is(0.5)) shuffle(random.scene, chance);
  random.scene.name = "random";
  random.scene.until = some_vibrations(random.scene, chance);
  for (Node& node : random.scene.nodes) {
    if (node.pinned) node.velocity.setZero();
  }
  validate(random.scene, "random");
  return random;
}

RandomScene damped_scene(std::uint64_t seed) {
  RandomScene random = random_scene(seed);
  Scene& scene = random.scene;
  Chance chance(seed ^ 0x5bd1e995);
  const std::size_t kind = chance.below(4);
  if (kind == 3 || chance.is(0.4)) scene.air_damping = chance.decades(-1, 0.7);
  // Damping ratios of the fastest vibration from some hundredths to some.
  const double time = *scene.until * chance.decades(-3.5, -1.5);
  std::vector<double> stiffnesses = {0};
  for (const Spring& spring : scene.springs) stiffnesses.push_back(spring.law.stiffness);
  const double least = stiffnesses[chance.below(stiffnesses.size())];
  for (Spring& spring : scene.springs) {
    const bool is_held = std::ranges::all_of(spring.nodes, [&](std::size_t i) {
      return scene.nodes[i].pinned || scene.nodes[i].mass > 0;
    });
    double& c = spring.law.damping;
    c = kind == 0 || (kind == 1 && spring.law.stiffness >= least) ? time * spring.law.stiffness
        : kind == 2 && chance.is(0.6)                             ? time * chance.decades(1, 3)
                                                                  : 0;
    if (!is_held) c = 0;
  }
  validate(scene, "damped");
  return random;
}

RandomScene driven_scene(std::uint64_t seed) {
  RandomScene random = seed % 2 == 0 ? random_scene(seed) : damped_scene(seed);
  Scene& scene = random.scene;
  Chance chance(seed ^ 0x9e3779b9);
  double size = 0, weight = 0;
  for (const Node& node : scene.nodes) {
    size = std::max(size, (node.position - scene.nodes[0].position).norm());
    weight += node.mass;
  }
  size = std::max(size, 0.1);
  const double until = *scene.until, w = 2 * std::numbers::pi / until;
  const bool is_shared = chance.is(0.3), is_along = chance.is(0.5);
  const auto direction = [&] {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    if (is_along) {
      d[0] = 1;
    } else {
      for (int c = 0; c < scene.dimension; ++c) d[c] = chance.uniform(-1, 1);
    }
    return d;
  };
  const auto curve = [&](double amplitude) {
    TimeCurve drawn;
    const double part = amplitude * chance.decades(-2, -0.7);
    if (chance.is(0.7)) {
      const double phase = chance.is(0.5) ? 0 : chance.uniform(0, 6);
      drawn.harmonics.push_back({part * direction(), w * chance.decades(-0.5, 1), phase});
    }
    if (drawn.harmonics.empty() || chance.is(0.3)) {
      drawn.polynomial = {Eigen::Vector3d::Zero(), part / until * direction(),
                          part / (until * until) * direction()};
    }
    return drawn;
  };
  const auto add = [&](const TimeCurve& one) {
    scene.curves.push_back(one);
    return static_cast<int>(scene.curves.size()) - 1;
  };
  // A length in the time of the motion, as a force on the mean mass.
  const double force = weight / static_cast<double>(scene.nodes.size()) * size / (until * until);
  const int shared = is_shared ? add(curve(size)) : -1;
  for (Node& node : scene.nodes) {
    if (node.pinned && (is_shared || chance.is(0.5)))
      node.curve = is_shared ? shared : add(curve(size));
    if (!node.pinned && node.mass > 0 && !is_shared && chance.is(0.2))
      node.curve = add(curve(20 * force));
  }
  if (chance.is(0.3)) scene.gravity_curve = add(curve(10 * size / (until * until)));
  validate(scene, "driven");
  return random;
}

}  // namespace tests
}  // namespace qddot
