#pragma once

#include <memory>
#include <vector>

#include "qddot/algebra/factors.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {

// Solves (M + s L) x = b with the L of Laplacian, which a system must offer. M + s L falls
// apart into matrices that nothing couples, one for each axis at least, and most of them are the
// same: the N x N matrix of a network in D dimensions is made and factorised once, and solves for D
// right-hand sides at a time.
class LaplacianMass {
 public:
  explicit LaplacianMass(const System& system);

  // Factorises for s [s^2] >= 0; false where the matrix is not positive definite, which takes
  // massless unknowns or numbers that are none.
  bool factorize(double s);
  // x = (M + s L)^-1 b with the last factors; b, x: n, x sized by the caller.
  void solve(const Vec& b, Vec& x);

  // How many different matrices there are, and the unknowns of each.
  std::vector<Index> sizes() const;

 private:
  // A matrix that stands in M + s L as often as `unknowns` has lists of rows.
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
