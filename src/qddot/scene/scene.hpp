#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "qddot/model/spring.hpp"
#include "qddot/model/time_curve.hpp"

namespace qddot {

// A point mass. Coordinates beyond the scene's dimension are zero.
struct Node {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // [m/s]
  double mass = 0;                                     // [kg], 0 = massless; ignored where pinned
  bool pinned = false;  // stays at its position for ever, unless it has a curve
  // An index into Scene::curves, or -1. The curve is the displacement from `position` if the node
  // is pinned, else a load beside `load`.
  int curve = -1;
  // A constant force beside the weight [N]; a pin carries it.
  Eigen::Vector3d load = Eigen::Vector3d::Zero();

  // The load that acts on its motion [N]: zero where it is pinned.
  Eigen::Vector3d acting_load() const {
    return pinned ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : load;
  }
};

// A spring between two nodes, by their indices.
struct Spring {
  std::array<std::size_t, 2> nodes{};
  SpringLaw law;
  // The defaults are those of a drawn spring. A reduction may replace several springs by one, and
  // marks the stiff ones.
  Holds holds = Holds::always;
  bool stiff = false;
};

// A scene as the user drew it: nodes, springs, gravity and loads, with nothing derived or left out.
// Faces are for pictures only.
struct Scene {
  std::string name{};
  int dimension = 3;                                  // 1, 2 or 3
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // [m/s^2]
  std::optional<double> until{};                      // [s], the end time if none is asked for
  std::vector<Node> nodes{};
  std::vector<Spring> springs{};
  // Triangles of a surface, by the indices of their three nodes. Changes no motion.
  std::vector<std::array<std::size_t, 3>> faces{};
  // Whether the motion begins at the stable equilibrium that is reached from the drawn positions,
  // with the velocities as drawn.
  bool starts_at_equilibrium = false;
  // Springs with more stiffness [N/m] are stiff, for methods that treat their forces apart
  // (Split). If missing, none are named. Changes no motion.
  std::optional<double> stiff_above{};
  std::vector<TimeCurve> curves{};  // what changes with time, from t = 0 on
  int gravity_curve = -1;           // of `curves`: an acceleration beside `gravity`
  double air_damping = 0;           // alpha [1/s]: air takes the force -alpha m v from each node
  // Sentences that tell the user how the scene was read. Changes no motion.
  std::vector<std::string> warnings{};
};

// Whether a spring of that law is a stiff one of the scene.
inline bool is_stiff(const SpringLaw& law, std::optional<double> stiff_above) {
  return stiff_above && law.stiffness > *stiff_above;
}

// Whether anything takes energy from the motion: a dashpot or the air.
bool is_damped(const Scene& scene);

// Whether anything depends on time: a support moves, or a load or gravity changes.
bool is_driven(const Scene& scene);

// Whether a spring may go slack or break.
bool changes_phases(const Scene& scene);

// The same scene with all moving supports where they are at t = 0, and displaced from there;
// nothing if they are there already.
std::optional<Scene> with_supports_at_start(const Scene& scene);

// Sets the dashpot of each spring that has none to beta times its stiffness [N s/m]; beta in s.
void damp_springs(double damping_time, Scene& scene);

// Whether a node that moves has a load.
inline bool has_loads(const Scene& scene) {
  return std::ranges::any_of(scene.nodes,
                             [](const Node& node) { return !node.acting_load().isZero(0); });
}

// Whether each node is an end of a spring that can pull.
std::vector<bool> nodes_on_springs(const Scene& scene);

// Throws InvalidInput, in a sentence that starts with `source` and names node or spring and field,
// unless
//   every number is finite, and the dimension is 1, 2 or 3;
//   every number of a curve is finite, frequencies are not negative, and times of tables ascend;
//   masses, stiffnesses, rest lengths and dampings are not negative; `until` and `stiff_above` are
//   above 0; strains at which springs break are above 0, and such springs and cables have no
//   massless node; each spring joins two different existing nodes, which are apart if its
//   rest_length > 0 (else it has no direction); a node with a load has mass, a pin, or a spring
//   that pulls; each face has three different existing nodes; rods are as validate_rods (rods.hpp)
//   says.
void validate(const Scene& scene, const std::string& source);

// A hash of everything in the scene that decides its motion, so not of its name; the same on every
// machine. 64-bit FNV-1a over the numbers' bytes, as 16 hexadecimal digits.
std::string content_hash(const Scene& scene);

}  // namespace qddot
