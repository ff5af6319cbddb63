#pragma once

#include <vector>

#include "qddot/integrators/base/symmetric_formula.hpp"

namespace qddot::spurious_roots {

// The coefficients of a symmetric formula of k steps as numbers, as SymmetricFormula has them as
// fractions: rho_k ... rho_0 and beta_{k-1} ... beta_1.
struct Coefficients {
  std::vector<double> rho, beta;

  int steps() const { return static_cast<int>(rho.size()) - 1; }
};

Coefficients coefficients_of(const SymmetricFormula& formula);

// The formula of k = 2 n + 2 steps and order k with n pairs of spurious roots exp(+-i phi).
// `cosines` are those of the n phi, each from -1 to 1 and none twice; n >= 1.
Coefficients formula_of_cosines(const std::vector<double>& cosines);

// Set number `index` of `pairs` cosines, from -1 to 0.95, descending. The sets are points of
// Halton's sequence (Numerische Mathematik 2 (1960) 84-90), which fills that space evenly and is
// the same each time. index from 1; pairs from 1 to 5.
std::vector<double> sampled_cosines(int index, int pairs);

}  // namespace qddot::spurious_roots
