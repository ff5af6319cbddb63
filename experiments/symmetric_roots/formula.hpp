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

// The motion of a formula on q'' = -w^2 q, by the roots of its recurrence rho + h^2 w^2 beta.

// The least h w at which a root leaves the unit circle, so that the motion grows beyond.
double stability_limit(const Coefficients& formula);

// The angles of the roots with 0 <= angle <= pi, ascending; of those off the circle, that of the
// nearest point on it.
std::vector<double> root_angles(const Coefficients& formula, double h_omega);

// The relative error of the phase in each period: |theta - h w| / (h w), with theta the angle [rad]
// of the root nearest to the exact motion's.
double phase_error(const Coefficients& formula, double h_omega);

// The smallest angle [rad] between two roots, one of them spurious, at any of `h_omegas`. Where two
// meet they may leave the circle, and a motion whose frequency changes moves them.
double root_gap(const Coefficients& formula, const std::vector<double>& h_omegas);

}  // namespace qddot::spurious_roots
