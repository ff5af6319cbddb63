#pragma once

#include <memory>
#include <vector>

#include "qddot/algebra/factors.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {

// Solves (M + s L) x = b with the L of Laplacian, which the system must offer. With Damping, L has
// a multiple of the matrix that bounds C as well. M + s L splits into uncoupled matrices, at least
// one for each axis, most of which are equal. So the N x N matrix of a network in D dimensions is
// factorised once, and solves for D right-hand sides at a time.
class LaplacianMass {
 public:
  // Finds the different matrices and analyses their patterns. `rate` [1/s]: the multiple of the
  // matrix of Damping::bound_damping, if the system has that.
  explicit LaplacianMass(const System& system, double rate = 0);

  // Factorises M + s L, s [s^2] >= 0. Returns false if it is not positive definite, as with
  // massless unknowns or numbers that are not finite.
  bool factorize(double s);
  // x = (M + s L)^-1 b with the last factors; b, x: n, x sized by the caller.
  void solve(const Vec& b, Vec& x);

  // The number of unknowns of each different matrix.
  std::vector<Index> sizes() const;

 private:
  // A matrix that occurs in M + s L once for each list of rows in `unknowns`.
  struct Block {
    Vec mass{};
    SymmetricMatrix l{};
    std::vector<std::vector<Index>> unknowns{};
    std::unique_ptr<Factors> factors{};
    Vec b{}, x{};                    // of one of them
    FourColumns four_b{}, four_x{};  // of up to four
  };

  std::vector<Block> blocks_;
};

}  // namespace qddot
