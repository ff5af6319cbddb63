#pragma once

namespace qddot::solvers {

// The rate [operations/s] at which one core multiplies dense matrices in its second cache, by the
// installed BLAS, which uses the widest vectors of the processor. The fastest of all passes in
// `seconds`.
double product_flops(double seconds);

}  // namespace qddot::solvers
