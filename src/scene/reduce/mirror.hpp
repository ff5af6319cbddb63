#pragma once

#include <vector>

#include <Eigen/Core>

#include "qddot/scene/reduce/drawn_part.hpp"
#include "qddot/scene/reduce/frame.hpp"

namespace qddot::reduce {

// Planes (in two dimensions lines, in one points) that mirror a part onto itself, at right angles
// to each other: coordinate d of the part, the first `count` of them, changes its sign.
//
// A reflection S that maps positions, velocities, masses, pins and springs of a part onto
// themselves, and gravity to itself, maps its motion q(t) to a motion with the same start, which is
// therefore the same one: S q(t) = q(t) for all t. So the nodes on one side determine those on the
// other, and a node on the plane stays on it. With several such planes the same holds for the group
// that they generate; being at right angles they commute, and each node's images are
// diag(+-1, ...) of it.
//
// Where nodes coincide, several permutations of them belong to one reflection. Any will do that
// maps springs to springs, as long as those of all reflections commute as these do: only then does
// the group act on the nodes, and an orbit has one original. A plane without such a permutation is
// none.
struct Mirrors {
  Frame frame;                             // the part's, turned so that the planes are y_d = 0
  int count = 0;                           // of planes
  std::vector<std::vector<int>> images{};  // of each node under each reflection
};

// Looks for such planes among those through the part's middle that are normal to an axis of
// `frame`, to the diagonal of two of them (which swaps the two coordinates), or to a principal axis
// of its free nodes or of its pins. Everything has to agree within rounding (see drawn_part.hpp),
// and no spring of some rest length may be as short as that. n log n operations for n nodes and
// springs, of which few coincide.
Mirrors mirrors_of(const DrawnPart& drawn, const Frame& frame);

}  // namespace qddot::reduce
