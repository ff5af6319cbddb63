#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "qddot/scene/scene.hpp"

namespace qddot {

// A mass-spring network as arrays. A value that is the same everywhere may be given once.
struct SceneArrays {
  Eigen::MatrixXd positions{};                        // nodes x dimension (1, 2 or 3) [m]
  std::vector<std::array<std::size_t, 2>> springs{};  // the two nodes of each
  Eigen::VectorXd mass{};                             // [kg], of each node or of all
  Eigen::VectorXd stiffness{};                        // [N/m], of each spring or of all
  std::vector<std::size_t> pinned{};                  // nodes that do not move
  Eigen::VectorXd gravity{};                          // dimension [m/s^2]; empty: none
  Eigen::MatrixXd velocities{};                       // as positions [m/s]; empty: at rest
  Eigen::MatrixXd load{};                             // as positions [N]; empty: none
  Eigen::VectorXd rest_length{};  // [m], of each spring or of all; empty: its length as given
  Eigen::VectorXd quartic{};      // [N/m^3], likewise; empty: none
  Eigen::VectorXd damping{};      // of dashpots [N s/m], likewise; empty: none
  Eigen::VectorXd cubic{};        // [N/m^2], likewise; empty: none
  Eigen::VectorXd breaks_at{};    // strains, likewise; empty, or infinite: never
  Eigen::VectorXd pulls_only{};   // 1 where a spring is a cable, else 0, likewise; empty: none
  // 1 where it is a rod of the rest length, whose other values are not read; else 0, likewise.
  Eigen::VectorXd rigid{};
  double air_damping = 0;  // [1/s]
  // Curves of time, the number of that of each node or -1, and that of gravity; see Scene.
  std::vector<TimeCurve> curves{};
  std::vector<int> curve_of_node{};  // empty: none has one
  int gravity_curve = -1;
};

// Makes the scene of these arrays. Throws InvalidInput, in a sentence that names array and entry,
// if sizes do not fit or a value is not allowed (see validate).
Scene scene_of(const SceneArrays& arrays);

}  // namespace qddot
