#pragma once

#include "experiments/symmetric_roots/formula_of_cosines.hpp"

namespace qddot::spurious_roots {

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
