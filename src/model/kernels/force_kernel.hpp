#pragma once

#include "qddot/model/kernels/springs_by_node.hpp"

namespace qddot::kernels {

// f = offset + the forces of the springs [N], of each node
//   sum over its springs of (tau/l) (x_j - x_i),
// which differs from a sum spring by spring by rounding, and by nothing with the number of threads.
// q, offset, f: n. May be called from any thread.
template <int D>
void sum_forces(const SpringsByNode<D>& springs, const Vec& q, const Vec& offset, Vec& f);

}  // namespace qddot::kernels
