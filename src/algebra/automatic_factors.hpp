#pragma once

#include <memory>

#include "qddot/algebra/factors.hpp"

namespace qddot {

// Factors by the multifrontal method or conjugate gradients, whichever takes less work. What a
// factorisation and a solve with it take is known from the symbolic analysis; what conjugate
// gradients take is seen: how many iterations there were, and how many solves with one matrix.
// Where a factorisation is small all is multifrontal. Else a run begins with conjugate gradients;
// each matrix is solved with in the way that would have been the cheaper one for the last; and
// where the iterations with one matrix have taken as much work as to factorise it, it is factorised
// after all, so that no matrix takes more than twice the least. Work is counted and not timed: a
// run is the same each time.
//
// Conjugate gradients need a positive definite matrix. Where they find that it is not, a matrix of
// factorize() is factorised and solved with as by a direct solver, and one of factorize_positive()
// is reported. They are used whatever they cost where L would take half of the machine's memory.
//
// K, when factorised, must stay as it is until the last solve.
std::unique_ptr<Factors> make_automatic_factors(const SymmetricMatrix& pattern, Vec diagonal);

}  // namespace qddot
