#include "qddot/analysis/curvature_signs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/stability.hpp"
#include "qddot/model/capabilities.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

// Rounding changes the entries of a spring's block by some 9 eps k; a row of K has one or two such
// blocks. It changes the sums by some eps/4 for each spring. The rest is for the pivots.
constexpr double roundings = 32;
// Positions are moved by this many of their roundings, so that the rounding of K itself does not
// matter.
constexpr double magnified = 1 << 20;
constexpr int probes = 2;
// The largest part of E that errors of the pivots may take, and the factor by which E is raised if
// they take more.
constexpr double share_of_pivots = 0.25, raised_to = 8;
constexpr int most_raises = 20;
// A dense decomposition is cheap up to this size, and it has no pivots.
constexpr Index largest_dense = 1000;

// The stiffness that the springs at each row of K have. A spring's k is absent from the rows across
// it, but the rounding of its length is not.
Vec stiffness_of_rows(const System& system, const SymmetricMatrix& k) {
  const Vec rows = row_sums(k);
  const auto* laplacian = system.laplacian();
  if (laplacian && laplacian->bounds_stiffness()) {
    SymmetricMatrix l = system.stiffness_pattern();
    laplacian->assemble_laplacian(l);
    return rows + row_sums(l);
  }
  // The rows along the spring belong to the same node, and so to the same block of the pattern.
  Vec most = rows;
  for (Index j = 0; j < k.cols(); ++j) {
    for (SymmetricMatrix::InnerIterator entry(k, j); entry; ++entry) {
      most[j] = std::max(most[j], rows[entry.row()]);
      most[entry.row()] = std::max(most[entry.row()], rows[j]);
    }
  }
  return rows + most;
}

// The diagonal E [N/m] of the rounding errors (see curvature_signs()).
Vec rounding_of_rows(const System& system, const Vec& q, const SymmetricMatrix& k) {
  Vec e = roundings * machine_epsilon * stiffness_of_rows(system, k);
  std::minstd_rand random(1);
  SymmetricMatrix moved = system.stiffness_pattern();
  for (int probe = 0; probe < probes; ++probe) {
    const Vec to = q.unaryExpr(
        [&](double x) { return x * (1 + (random() % 2 ? 1 : -1) * magnified * machine_epsilon); });
    system.stiffness(to, moved);
    moved.coeffs() -= k.coeffs();
    e += row_sums(moved) / magnified;
  }
  return e;
}

// The error of the factors of -K + a E in units of E: the residual of a solution over the solution,
// in the metric of E.
double error_of_factors(EffectiveMass& factors, double a, const SymmetricMatrix& k, const Vec& e) {
  const Vec root = e.cwiseSqrt();
  std::minstd_rand random(2);
  const Vec b = root.unaryExpr([&](double x) { return random() % 2 ? x : -x; });
  Vec x(b.size());
  factors.solve(b, x);
  const Vec residual = b - a * e.cwiseProduct(x) + k.selfadjointView<Eigen::Lower>() * x;
  const double error = residual.cwiseQuotient(root).norm() / x.cwiseProduct(root).norm();
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

struct Below {
  int minus = 0, plus = 0;  // eigenvalues of E^-1 (-K) below -1 and below 1
};

Below by_decomposition(const SymmetricMatrix& k, const Vec& e) {
  const Vec scale = e.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd dense = -Eigen::MatrixXd(scale.asDiagonal() * k * scale.asDiagonal());
  const Vec values = dense_values(dense);
  if (!values.allFinite()) throw std::range_error("the eigenvalues of K were not found");
  return {static_cast<int>((values.array() < -1).count()),
          static_cast<int>((values.array() < 1).count())};
}

Below by_pivots(const System& system, const SymmetricMatrix& k, Vec& e) {
  for (int raises = 0; raises < most_raises; ++raises) {
    EffectiveMass factors(system, e);
    double error = 0;
    const auto below = [&](double value) {
      if (factors.factorize(-value, 1, k) == EffectiveMass::Definiteness::singular) {
        error = 1;
        return 0;
      }
      error = std::max(error, error_of_factors(factors, -value, k, e));
      return static_cast<int>(factors.negative_pivots());
    };
    Below counts;
    counts.plus = below(1);
    if (counts.plus > 0) counts.minus = below(-1);
    if (error <= share_of_pivots) return counts;
    if (system.size() <= largest_dense) return by_decomposition(k, e);
    e *= std::isfinite(error) ? raised_to * error : 1e3;
  }
  throw SolverFailure("the stiffness matrix cannot be factorised, so its signs are not known");
}

}  // namespace

CurvatureSigns curvature_signs(const System& system, const Vec& q) {
  if (system.size() == 0) return {};
  require_stiffness(system);
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  if (!k.coeffs().allFinite()) throw std::range_error("the stiffness matrix is not finite");
  Vec e = rounding_of_rows(system, q, k);
  if (!e.allFinite()) throw std::range_error("the stiffness matrix overflows");
  const double largest = e.maxCoeff();
  if (largest == 0) return {.negative = 0, .flat = static_cast<int>(system.size())};
  // The metric may have any positive number where no spring pulls.
  const auto is_pulled = (e.array() > 0).eval();
  Vec metric = is_pulled.select(e, largest);
  const Below counts = by_pivots(system, k, metric);
  CurvatureSigns signs{.negative = counts.minus, .flat = counts.plus - counts.minus};
  if (signs.flat == 0) return signs;
  // -K >= -K~ - E >= -2 E on all but the negative directions of -K~ + E.
  const Vec rates = is_pulled.select(metric.cwiseQuotient(system.mass()), Vec::Zero(q.size()));
  signs.flat_rate = std::sqrt(2 * rates.maxCoeff());
  return signs;
}

}  // namespace qddot
