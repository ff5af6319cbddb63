#pragma once

#include <memory>

#include "qddot/algebra/factors.hpp"
#include "qddot/algebra/symbolic_factorization.hpp"

namespace qddot {

// Makes Factors P (a D - s K) P' = L E L' without pivoting, by the multifrontal method (Duff, Reid,
// ACM TOMS 9:3, 1983; Liu, SIAM Review 34:1, 1992). Order and supernodes are those of
// symbolic_factorization.hpp. Throws std::bad_alloc or std::runtime_error when out of memory, here
// only.
std::unique_ptr<Factors> make_multifrontal(const SymmetricMatrix& pattern, Vec diagonal);
// The same for a pattern that is analysed already.
std::unique_ptr<Factors> make_multifrontal(const SymmetricMatrix& pattern, Vec diagonal,
                                           SymbolicFactorization symbolic);

}  // namespace qddot
