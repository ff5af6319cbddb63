#pragma once

#include <complex>

#include <Eigen/Core>

#include "qddot/model/system.hpp"

namespace qddot::inline measure {

// Covariance matrices, n x n, of the means m_1 ... m_n of a process x(t) over blocks [i - 1, i] of
// unit length. They are for unit variance.

// A random walk has x(0) = 0 and Cov(x(s), x(t)) = min(s, t). If i < j, block i is before block j,
// so that Cov(m_i, m_j) = integral of s over block i = i - 1/2. Within a block
//   integral of min(s, t) over both = (i - 1) + integral over the unit square = (i - 1) + 1/3.
// The start of the walk is a constant, which the level of a fit absorbs.
Eigen::MatrixXd walk_covariance(Index n);

// A stationary oscillation forgets its phase: Cov(x(s), x(t)) = Re exp(-rate |s - t|), with rate =
// decay - i frequency, both per block. It is an Ornstein-Uhlenbeck process (coloured noise) if the
// frequency is zero, and a sine of random phase and amplitude if the decay is zero. If g = (1 -
// e^-rate)/rate, then
//   Cov(m_i, m_j) = Re e^(-rate (|i - j| - 1)) g^2,   Var m_i = Re 2 (rate - 1 + e^-rate)/rate^2.
Eigen::MatrixXd oscillation_covariance(Index n, std::complex<double> rate);

}  // namespace qddot::inline measure
