#pragma once

#include <memory>

#include "qddot/algebra/factors.hpp"

namespace qddot {

// Makes Factors that use the multifrontal method or conjugate gradients, whichever takes less work.
// The symbolic analysis tells the work of a factorisation and of a solve with it. The work of
// conjugate gradients is observed: iterations of a solve, and solves with one matrix.
//
// If a factorisation is small, all is multifrontal. Otherwise a run begins with conjugate
// gradients. Each matrix is solved with in the way that would have been cheaper for the last one.
// When the iterations with one matrix have taken as much work as factorising it, it is factorised
// after all. So no matrix takes more than twice the least work. Work is counted, not timed: a run
// is the same each time.
//
// Conjugate gradients need a positive definite matrix. If they find that it is not, a matrix of
// factorize() is factorised and solved with directly, and one of factorize_positive() is reported.
// They are used at any cost if L would take half of the machine's memory.
//
// K, when factorised, must stay unchanged until the last solve.
std::unique_ptr<Factors> make_automatic_factors(const SymmetricMatrix& pattern, Vec diagonal);

}  // namespace qddot
