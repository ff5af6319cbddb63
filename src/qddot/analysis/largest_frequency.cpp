#include "qddot/analysis/largest_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/algebra/leading_pairs.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {
namespace {

// The allowed residual, relative to w^2. The error of the eigenvalue is no larger and mostly far
// smaller: 3e-6 for a chain of 1e5 masses, whose eigenvalues crowd at the end.
constexpr double relative_error = 1e-4;
// Up to this size, Lanczos' basis would be the whole space.
constexpr Index most_dense = 40;

// M^-1/2 over the bound; a massless unknown has none.
Vec scaling(const Vec& mass, double bound) {
  return (mass.array() > 0).select(mass.cwiseSqrt().cwiseInverse() / bound, Vec::Zero(mass.size()));
}

// -M^-1/2 K M^-1/2 over the square of the bound, so that no eigenvalue is above 1. A massless
// unknown has no stiffness here.
void scale(const Vec& mass, double bound, SymmetricMatrix& k) {
  const Vec factors = scaling(mass, bound);
  for (Index j = 0; j < k.cols(); ++j) {
    for (SymmetricMatrix::InnerIterator entry(k, j); entry; ++entry)
      entry.valueRef() *= -factors[entry.row()] * factors[j];
  }
}

double bound_by(const Vec& row_sums, const Vec& mass) {
  double largest = 0;
  for (Index i = 0; i < mass.size(); ++i) {
    if (row_sums[i] > 0) largest = std::max(largest, row_sums[i] / mass[i]);
  }
  return std::sqrt(largest);
}

// The phases in which every cable pulls: no others make a system stiffer.
std::vector<Phase> all_taut(const System& system) {
  if (!system.switching()) return {};
  return std::vector<Phase>(static_cast<std::size_t>(system.switching()->phase_count()),
                            Phase::taut);
}

At taut_at(const Vec& q, const std::vector<Phase>& phases) {
  At at(q);
  if (!phases.empty()) at.phases = phases.data();
  return at;
}

SymmetricMatrix stiffness_at(const System& system, const Vec& q) {
  require_stiffness(system);
  SymmetricMatrix k = system.stiffness_pattern();
  const std::vector<Phase> phases = all_taut(system);
  system.stiffness(taut_at(q, phases), k);
  return k;
}

// Products with that matrix. It is not made where the system can multiply without K: for a million
// nodes that takes as long as a thousand forces.
class ScaledStiffness {
 public:
  ScaledStiffness(const System& system, const Vec& q) : system_(system), q_(q) {
    require_stiffness(system);
    scaled_.setZero(q.size());
    product_.resize(q.size());
    if (system.multiply_stiffness(q, scaled_, product_)) {
      bound_ = frequency_bound(system, q);
      if (bound_ > 0) factors_ = scaling(system.mass(), bound_);
      return;
    }
    k_ = stiffness_at(system, q);
    Vec row_sums;
    bound_ = frequency_bound(system.mass(), *k_, row_sums);
    if (bound_ > 0 && std::isfinite(bound_)) scale(system.mass(), bound_, *k_);
  }

  // A bound of w_max [rad/s]. There are products if it is finite and above 0.
  double bound() const { return bound_; }
  Vec operator*(const Vec& x) {
    if (k_) return k_->selfadjointView<Eigen::Lower>() * x;
    scaled_ = factors_.cwiseProduct(x);
    system_.multiply_stiffness(q_, scaled_, product_);
    return -factors_.cwiseProduct(product_);
  }

 private:
  const System& system_;
  const Vec& q_;
  double bound_ = 0;
  std::optional<SymmetricMatrix> k_;
  Vec factors_, scaled_, product_;  // without K
};

}  // namespace

double largest_frequency(const System& system, const Vec& q) {
  SymmetricMatrix k = stiffness_at(system, q);
  Vec row_sums;
  const double bound = frequency_bound(system.mass(), k, row_sums);
  if (bound == 0 || std::isinf(bound)) return bound;
  scale(system.mass(), bound, k);
  if (k.rows() <= most_dense) {
    const double top = dense_values(Eigen::MatrixXd(k)).maxCoeff();
    return bound * std::sqrt(std::max(top, 0.0));
  }
  const auto apply = [&](const Vec& x, Vec& y) { y = k.selfadjointView<Eigen::Lower>() * x; };
  return bound * std::sqrt(std::max(leading_value(apply, k.rows(), relative_error), 0.0));
}

double frequency_at_least(const System& system, const Vec& q, Index products) {
  ScaledStiffness a(system, q);
  const double bound = a.bound();
  if (bound == 0 || std::isinf(bound)) return bound;
  // Lanczos' recurrence from a random vector; rounding makes no value larger.
  const Index steps = std::min(products, q.size());
  Vec before = Vec::Zero(q.size()), now(q.size());
  std::minstd_rand random(1);
  for (double& x : now) x = static_cast<double>(random()) / random.max() - 0.5;
  now.normalize();
  Vec diagonal(steps), beside = Vec::Zero(steps);
  Index taken = 0;
  for (double last = 0; taken < steps; ++taken) {
    Vec next = a * now - last * before;
    diagonal[taken] = next.dot(now);
    next -= diagonal[taken] * now;
    last = next.norm();
    if (!(last > 1e-12)) {
      ++taken;
      break;
    }
    beside[taken] = last;
    before.swap(now);
    now = next / last;
  }
  if (!diagonal.head(taken).allFinite()) return 0;
  const Vec values = tridiagonal_values(diagonal.head(taken), beside.head(taken - 1));
  return bound * std::sqrt(std::max(values.maxCoeff(), 0.0));
}

bool is_quickly_searched(const System& system) {
  constexpr Index most_searched = 6000;  // some seconds
  return system.size() <= most_searched;
}

double quick_frequency(const System& system, const Vec& q) {
  return is_quickly_searched(system) ? largest_frequency(system, q) : frequency_at_least(system, q);
}

double frequency_bound(const System& system, const Vec& q) {
  require_stiffness(system);
  Vec row_sums;
  const std::vector<Phase> phases = all_taut(system);
  if (system.bound_row_sums(taut_at(q, phases), row_sums)) return bound_by(row_sums, system.mass());
  return frequency_bound(system.mass(), stiffness_at(system, q), row_sums);
}

double frequency_bound(const Vec& mass, const SymmetricMatrix& k, Vec& row_sums) {
  row_sums.setZero(mass.size());
  for (Index j = 0; j < k.cols(); ++j) {
    for (SymmetricMatrix::InnerIterator entry(k, j); entry; ++entry) {
      const double size = std::abs(entry.value());
      row_sums[j] += size;
      if (entry.row() != j) row_sums[entry.row()] += size;
    }
  }
  return bound_by(row_sums, mass);
}

}  // namespace qddot
