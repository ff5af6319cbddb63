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

// Conjugate gradients (Hestenes and Stiefel, J. Research NBS 49 (1952) 409-436) with the blocks on
// the diagonal, one for each node, as preconditioner P (block Jacobi). Memory and the work of an
// iteration are proportional to the springs, where L of a direct factorisation grows faster; how
// many iterations it takes grows with the root of the condition number of P^-1 A, of a cloth or
// block at a given step with how many nodes a wave passes in it.
//
// What is called factorising here inverts those blocks: it knows that a matrix is not positive
// definite only where already one of them is not. Otherwise solve() finds out, and says so, where a
// direction of search p has p'Ap <= 0. While all have p'Ap > 0 the solution is one of A x = b and
// b'x > 0, whatever A does elsewhere; so a matrix may pass for positive definite with one
// right-hand side and not with the next. negative_pivots() is 1 where the matrix is known not to be
// positive definite and else 0: eigenvalues cannot be counted in this way.
//
// An iteration ends where r'P^-1 r is below the tolerance squared times b'P^-1 b. It looks at the r
// that it updates; b - A x differs from that by rounding as in any backward stable solve
// (Greenbaum, SIAM J. Matrix Analysis and Applications 18 (1997) 535-551). The tolerance is 1e-10
// unless set: so far from round-off only because methods of high order and reversible ones notice
// more. Who solves for a correction that is itself only good to some part should set that part. A
// solve that takes more than 10 000 iterations has not_converged: that many cost more than most
// factorisations.
std::unique_ptr<IterativeFactors> make_conjugate_gradients(const SymmetricMatrix& pattern,
                                                           Vec diagonal);

}  // namespace qddot
