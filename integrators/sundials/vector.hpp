#pragma once

#include "integrators/sundials/support.hpp"

namespace qddot::sundials {

// A zero vector of length 2n for y = (q, v): SUNDIALS' own serial one.
Vector make_stock_vector(Index n, SUNContext context);
// The same with the main operations of a step compiled for this processor. Sums of several vectors
// are made in one pass, and the weighted norm adds in several lanes. Its clones are alike.
Vector make_vector(Index n, SUNContext context);
// Another zero vector of the same kind.
Vector clone(N_Vector y);

}  // namespace qddot::sundials
