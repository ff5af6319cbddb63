#include "qddot/analysis/natural_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "qddot/algebra/dense_cholesky.hpp"
#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/algebra/leading_pairs.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/model/capabilities.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

using Eigen::MatrixXd;

// Up to this size the dense decomposition takes no longer than Lanczos' method, and it cannot fail.
constexpr Index most_dense_modes = 400;
// The distance of a shift from the spectrum, over the spectrum's width; more by factors of
// `growth`.
constexpr double least_offset = 1e-8;
constexpr double growth = 4;
constexpr int most_tries = 40;
// Values below this part of another are computed again.
constexpr double small_part = 1e-3;

// The pencil -K x = w^2 M x at one q.
struct Pencil {
  const System& system;
  const Vec& mass;
  SymmetricMatrix k;
  std::vector<Index> massive{}, massless{};
  double width = 0;  // Gershgorin's bound of all finite w^2; 1 without springs

  Pencil(const System& s, const Vec& q, const Vec& m)
      : system(s), mass(m), k(s.stiffness_pattern()) {
    require_stiffness(system);
    system.stiffness(q, k);
    const SymmetricMatrix sizes = k.cwiseAbs();
    const Vec row_sums = sizes.selfadjointView<Eigen::Lower>() * Vec::Ones(system.size());
    for (Index i = 0; i < system.size(); ++i) {
      (mass[i] > 0 ? massive : massless).push_back(i);
      if (mass[i] > 0) width = std::max(width, row_sums[i] / mass[i]);
    }
    if (width == 0) width = 1;
  }
};

[[noreturn]] void refuse_loose_massless() {
  throw std::domain_error(
      "there are no natural modes: a massless node is not held by its springs, so nothing says how "
      "it moves");
}

// Eigenvalues that are small beside the largest have its rounding errors, but their vectors are
// accurate to rounding. In the space of these vectors, only the rounding of the matrix entries that
// they meet remains. This is repeated for values that are small even there. `projected` is X'AX for
// some of the vectors.
template <class Projected>
void look_again_at_small(const Projected& projected, Vec& values, MatrixXd& vectors) {
  Index first = 0, count = values.size();
  for (;;) {
    const Vec sizes = values.segment(first, count).cwiseAbs();
    const double small = small_part * sizes.maxCoeff();
    const auto begin = std::ranges::find_if(sizes, [&](double size) { return size <= small; });
    first += begin - sizes.begin();
    count = (sizes.array() <= small).count();
    if (count == 0 || small == 0) break;
    const MatrixXd own = vectors.middleCols(first, count);
    const EigenPairs again = dense_pairs(projected(own));
    values.segment(first, count) = again.values;
    vectors.middleCols(first, count) = own * again.vectors;
  }
  std::vector<Index> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](Index j) { return values[j]; });
  values = Vec(values(order));
  vectors = MatrixXd(vectors(Eigen::all, order));
}

// All finite modes. The massless unknowns b are eliminated from the massive ones a: -K_bb
// x_b = K_ba x_a and (-K_aa - K_ab (-K_bb)^-1 K_ba) x_a = w^2 M_a x_a.
NaturalModes dense_modes(const Pencil& p) {
  const auto &a = p.massive, &b = p.massless;
  const Vec root = p.mass(a).cwiseSqrt();
  const Vec per_root = root.cwiseInverse();
  const MatrixXd stiff = -MatrixXd(MatrixXd(p.k).selfadjointView<Eigen::Lower>());
  MatrixXd follow(b.size(), a.size());  // x_b = follow x_a
  if (!b.empty()) {
    const DenseCholesky held(stiff(b, b));
    // Rounding may make a singular matrix positive; its reciprocal condition is then tiny.
    if (!held.is_positive() ||
        held.reciprocal_condition() < machine_epsilon * static_cast<double>(b.size())) {
      refuse_loose_massless();
    }
    follow = -held.solve(stiff(b, a));
  }
  const MatrixXd condensed = stiff(a, a) + stiff(a, b) * follow;
  const MatrixXd per_mass = per_root.asDiagonal() * condensed * per_root.asDiagonal();
  auto [values, vectors] = dense_pairs(per_mass);
  NaturalModes modes{values, MatrixXd(p.system.size(), std::ssize(a))};
  look_again_at_small([&](const MatrixXd& x) { return MatrixXd(x.transpose() * (per_mass * x)); },
                      modes.squares, vectors);
  const MatrixXd shapes = per_root.asDiagonal() * vectors;
  modes.shapes(a, Eigen::all) = shapes;
  modes.shapes(b, Eigen::all) = follow * shapes;
  return modes;
}

// The modes nearest to a shift, by the factors of `matrix` = +-(-K - shift M). Its inverse must be
// positive on the massive unknowns.
NaturalModes modes_beside(const Pencil& p, EffectiveMass& matrix, double offset, Index count) {
  const Vec root = p.mass.cwiseSqrt();
  // The operator M^1/2 matrix^-1 M^1/2 with eigenvalues 1 / |w^2 - shift|, zero for massless
  // unknowns.
  const auto apply = [&](const Vec& z, Vec& y) {
    matrix.solve(root.cwiseProduct(z), y);
    y = offset * root.cwiseProduct(y);
  };
  const EigenPairs pairs = leading_pairs(apply, p.system.size(), count);
  MatrixXd shapes(p.system.size(), count);
  Vec x(p.system.size());
  for (Index j = 0; j < count; ++j) {
    matrix.solve(root.cwiseProduct(pairs.vectors.col(j)), x);
    shapes.col(j) = x * (offset / pairs.values[j]);
  }
  // Rayleigh-Ritz in the space of these shapes: the errors of w^2 are of second order in the
  // shapes' errors.
  const auto projected = [&](const MatrixXd& some) {
    return MatrixXd(-some.transpose() * (p.k.selfadjointView<Eigen::Lower>() * some));
  };
  const MatrixXd masses = shapes.transpose() * p.mass.asDiagonal() * shapes;
  const EigenPairs ritz = dense_pairs(projected(shapes), masses);
  NaturalModes modes{ritz.values, shapes * ritz.vectors};
  look_again_at_small(projected, modes.squares, modes.shapes);
  return modes;
}

bool is_small(const Pencil& p, Index count) {
  return p.system.size() <= most_dense_modes || 4 * count >= p.system.size();
}

}  // namespace

Index finite_modes(const System& system) { return (system.mass().array() > 0).count(); }

NaturalModes lowest_modes(const System& system, const Vec& q, Index count) {
  return lowest_modes(system, q, count, system.mass());
}

NaturalModes lowest_modes(const System& system, const Vec& q, Index count, const Vec& mass) {
  const Pencil p(system, q, mass);
  count = std::min(count, std::ssize(p.massive));
  if (count == 0) return {Vec(0), MatrixXd(system.size(), 0)};
  if (is_small(p, count)) {
    const NaturalModes all = dense_modes(p);
    return {all.squares.head(count), all.shapes.leftCols(count)};
  }
  EffectiveMass matrix(system, mass);
  double offset = least_offset * p.width;
  for (int tries = 0; !matrix.factorize_positive(offset, 1, p.k); ++tries) {
    if (tries == most_tries) refuse_loose_massless();
    offset *= growth;
  }
  NaturalModes modes = modes_beside(p, matrix, offset, count);
  // A shift far from the spectrum makes different modes nearly equal.
  for (int tries = 0; tries < most_tries; ++tries) {
    const double size = modes.squares.lpNorm<Eigen::Infinity>();
    if (size >= small_part * offset) break;
    offset = std::max(10 * size, small_part * offset);
    if (!matrix.factorize_positive(offset, 1, p.k)) break;
    modes = modes_beside(p, matrix, offset, count);
  }
  return modes;
}

NaturalModes highest_modes(const System& system, const Vec& q, Index count) {
  const Pencil p(system, q, system.mass());
  count = std::min(count, std::ssize(p.massive));
  if (count == 0) return {Vec(0), MatrixXd(system.size(), 0)};
  if (is_small(p, count)) {
    const NaturalModes all = dense_modes(p);
    return {all.squares.tail(count), all.shapes.rightCols(count)};
  }
  // If s is above all finite w^2, s M + K has one negative pivot for each massless unknown only.
  EffectiveMass matrix(system);
  const auto is_above = [&](double shift) {
    if (p.massless.empty()) return matrix.factorize_positive(shift, -1, p.k);
    return matrix.factorize(shift, -1, p.k) != EffectiveMass::Definiteness::singular &&
           matrix.negative_pivots() == std::ssize(p.massless);
  };
  const double w = p.massless.empty() ? largest_frequency(system, q) : std::sqrt(p.width);
  double offset = least_offset * p.width;
  for (int tries = 0; !is_above(w * w + offset); ++tries) {
    if (tries == most_tries) refuse_loose_massless();
    offset *= growth;
  }
  return modes_beside(p, matrix, offset, count);
}

double damping_ratio(const System& system, const Vec& q, const Vec& shape, double omega) {
  if (!system.damping()) return 0;
  Vec friction(q.size());
  system.damping()->friction({0, q, shape}, friction);
  return -shape.dot(friction) / (2 * omega);
}

}  // namespace qddot
