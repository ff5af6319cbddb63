#pragma once

#include <Eigen/Core>

#include "qddot/scene/reduce/drawn_part.hpp"

namespace qddot::reduce {

// Coordinates y of a D-dimensional subspace: x = origin + axes y. The axes are the first D columns
// of an orthonormal matrix. A coordinate is either one of the scene's own, to the bit, or a rotated
// one.
struct Frame {
  int dimension = 3;  // D
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

  // Coordinates of a point and of a direction; zero beyond D.
  Eigen::Vector3d point(const Eigen::Vector3d& x) const { return direction(x - origin); }
  Eigen::Vector3d direction(const Eigen::Vector3d& v) const {
    Eigen::Vector3d y = axes.transpose() * v;
    for (int d = dimension; d < 3; ++d) y[d] = 0;
    return y;
  }
  // The point and the direction of coordinates y, which must be zero beyond D.
  Eigen::Vector3d from_point(const Eigen::Vector3d& y) const { return origin + axes * y; }
  Eigen::Vector3d from_direction(const Eigen::Vector3d& y) const { return axes * y; }
};

// An orthonormal matrix whose first `count` columns are those of `axes`, which must be orthonormal.
Eigen::Matrix3d complete(Eigen::Matrix3d axes, int count);

// The smallest subspace in which the part's motion stays. Let all positions (of free nodes and of
// the pinned ones they are held to), all velocities, gravity and loads lie in a subspace W. A
// spring pulls along the difference of its ends, so all forces lie in W while all positions do. The
// components normal to W obey y'' = 0 with y = y' = 0, and stay zero. First, the scene's
// coordinates are left out that all positions share to the bit and in which nothing moves or pulls.
// Then, among the others, any plane or line is found that holds everything within rounding.
// `dimension`: of the scene.
//
// A coordinate that is shared almost, but not to the bit, counts as not shared: the deviation may
// be there on purpose, to start a buckling.
Frame frame_of(const DrawnPart& drawn, int dimension);

}  // namespace qddot::reduce
