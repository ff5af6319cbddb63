#pragma once

#include <memory>

#include "qddot/algebra/factors.hpp"

namespace qddot {

// Factors that do their work in solve().
class IterativeFactors : public Factors {
 public:
  // The iterations of all solves so far; each multiplies with the matrix once.
  virtual Index iterations() const = 0;
};

// Makes Factors by conjugate gradients (Hestenes and Stiefel, J. Research NBS 49 (1952) 409-436).
// The preconditioner P is block Jacobi: the blocks on the diagonal, one for each node. Memory and
// the work of an iteration are proportional to the springs; L of a direct factorisation grows
// faster. The number of iterations grows with the root of the condition number of P^-1 A: in a
// cloth or block, with the number of nodes that a wave passes in one step.
//
// factorize() only inverts those blocks. It finds that a matrix is not positive definite only if
// one of the blocks is not. Otherwise solve() finds out, and says so, when a search direction p has
// p'Ap <= 0. While all have p'Ap > 0, the solution is one of A x = b with b'x > 0, whatever A does
// elsewhere. So a matrix may pass as positive definite with one right-hand side and not with the
// next. negative_pivots() is 1 if the matrix is known not to be positive definite, else 0: this
// method cannot count eigenvalues.
//
// A solve ends when r'P^-1 r is below the tolerance squared times b'P^-1 b, r being the updated
// residual. b - A x differs from r by rounding, as in any backward stable solve (Greenbaum, SIAM J.
// Matrix Analysis and Applications 18 (1997) 535-551). The default tolerance is 1e-10, as small as
// this because methods of high order and reversible ones notice larger errors. A caller who needs a
// correction less exactly should set a larger one. A solve of more than 10 000 iterations ends as
// not_converged: so many cost more than most factorisations.
std::unique_ptr<IterativeFactors> make_conjugate_gradients(const SymmetricMatrix& pattern,
                                                           Vec diagonal);

}  // namespace qddot
