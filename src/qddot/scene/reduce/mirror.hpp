#pragma once

#include <vector>

#include <Eigen/Core>

#include "qddot/scene/reduce/drawn_part.hpp"
#include "qddot/scene/reduce/frame.hpp"

namespace qddot::reduce {

// Planes (in two dimensions lines, in one points) that mirror a part onto itself, at right angles
// to each other. Reflection d of the `count` planes changes the sign of coordinate d.
//
// Let a reflection S map positions, velocities, masses, loads, pins and springs of a part onto
// themselves, and gravity to itself. It maps the motion q(t) to one with the same start, which is
// therefore the same: S q(t) = q(t) for all t. So the nodes on one side determine those on the
// other, and a node on the plane stays on it. The same holds for the group that several such planes
// generate. Being at right angles they commute, and each node's images are diag(+-1, ...) of it.
//
// If nodes coincide, several permutations of them belong to one reflection. Any will do that maps
// springs to springs, if those of all reflections commute as the reflections do. Only then does the
// group act on the nodes, and an orbit has one original. A plane without such a permutation does
// not count.
struct Mirrors {
  Frame frame;                             // the part's, turned so that the planes are y_d = 0
  int count = 0;                           // of planes
  std::vector<std::vector<int>> images{};  // of each node under each reflection
};

// Looks for such planes through the part's middle. A normal is an axis of `frame`, the diagonal of
// two axes, or a principal axis of the free nodes or of the pins. A diagonal swaps two coordinates.
// Everything has to agree within rounding (see drawn_part.hpp), and no spring with a rest length
// may be as short as that. Takes n log n operations for n nodes and springs, of which few coincide.
Mirrors mirrors_of(const DrawnPart& drawn, const Frame& frame);

}  // namespace qddot::reduce
