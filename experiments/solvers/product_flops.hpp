#pragma once

namespace qddot::solvers {

// How fast one core multiplies dense matrices that its second cache holds [operations/s], by the
// BLAS at hand, which takes the widest vectors of the processor: the fastest of the passes of
// `seconds`.
double product_flops(double seconds);

}  // namespace qddot::solvers
