#pragma once

#include <vector>

#include <Eigen/Core>

#include "qddot/model/mass_spring.hpp"
#include "qddot/scene/reduce/drawn_part.hpp"
#include "qddot/scene/reduce/mirror.hpp"

namespace qddot::reduce {

// A node of a part as the image diag(signs) y of an original: itself, or another node of its orbit
// under the group of all mirrors (see orbits.hpp). The original lies on the side of each mirror
// where its coordinate is not negative; of coincident nodes, it is the first.
struct ImageOf {
  std::size_t original;
  Eigen::Vector3d signs;
};

// A part folded along its mirrors.
struct FoldedPart {
  std::vector<Eigen::Vector3d> y, w;  // positions and velocities of all nodes in the mirrors' frame
  std::vector<ImageOf> images;        // of all nodes
  std::vector<unsigned> on_planes;    // of all nodes, a bit for each coordinate that stays zero
  struct Spring {
    std::size_t a, b;        // originals
    Eigen::Vector3d mirror;  // the spring ends at y_a and at diag(mirror) y_b
    SpringLaw law;
    Holds holds;
    bool stiff;
  };
  std::vector<Spring> springs;
};

// Folds a part along its mirrors.
FoldedPart folded(const DrawnPart& drawn, const Mirrors& mirrors);

}  // namespace qddot::reduce
