#include "tests/measure.hpp"

#include <algorithm>
#include <cmath>

namespace qddot {
inline namespace tests {

double slope(const Vec& x, const Vec& y) {
  const Vec centred = x.array() - x.mean();
  return centred.dot(y) / centred.squaredNorm();
}

double observed_order(std::span<const double> errors) {
  const auto count = static_cast<Index>(errors.size());
  const Vec halvings = Vec::LinSpaced(count, 0, static_cast<double>(count - 1));
  const Vec logarithms = Eigen::Map<const Vec>(errors.data(), count).array().log() / std::log(2.0);
  return -slope(halvings, logarithms);
}

Eigen::MatrixXd finite_difference_jacobian(const std::function<Vec(const Vec&)>& g, const Vec& q,
                                           double h) {
  const auto beside = [&](Index j, double distance) -> Vec {
    Vec moved = q;
    moved[j] += distance;
    return g(moved);
  };
  Eigen::MatrixXd jacobian(g(q).size(), q.size());
  for (Index j = 0; j < q.size(); ++j) {
    jacobian.col(j) =
        (8 * (beside(j, h) - beside(j, -h)) - (beside(j, 2 * h) - beside(j, -2 * h))) / (12 * h);
  }
  return jacobian;
}

Eigen::MatrixXd dense(const SymmetricMatrix& lower) {
  return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
}

bool same_pattern(const SymmetricMatrix& a, const SymmetricMatrix& b) {
  return a.nonZeros() == b.nonZeros() && a.isCompressed() && b.isCompressed() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

bool is_valid_at(const System& system, const Vec& q) {
  const auto* validity = system.validity();
  return !validity || validity->is_valid_at(q);
}
bool is_linear_at(const System& system, const Vec& q) {
  const auto* pieces = system.pieces();
  return pieces ? pieces->is_linear_at(q) : system.stiffness_is_constant();
}

Vec force_at(const System& system, const Vec& q) {
  Vec f(system.size());
  system.force(q, f);
  return f;
}
SymmetricMatrix stiffness_at(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  return k;
}
SymmetricMatrix material_stiffness_at(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  offered(system.split_stiffness()).material_stiffness(q, k);
  return k;
}
Vec mean_force_between(const System& system, const Vec& a, const Vec& b) {
  Vec f(system.size());
  offered(system.discrete_gradient()).mean_force(a, b, f);
  return f;
}

Vec eigenvalues(const Eigen::MatrixXd& lower) {
  return lower.selfadjointView<Eigen::Lower>().eigenvalues();
}
Vec solution(const Eigen::MatrixXd& a, const Vec& b) { return a.fullPivLu().solve(b); }
double smallest_eigenvalue(const Eigen::MatrixXd& a) {
  return a.rows() == 0 ? 0 : eigenvalues(a)[0];
}
double largest_eigenvalue(const Eigen::MatrixXd& a) { return -smallest_eigenvalue(-a); }

Vec squared_frequencies(const System& system, const Vec& q) {
  const Vec root = system.mass().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd k = root.asDiagonal() * dense(stiffness_at(system, q)) * root.asDiagonal();
  return eigenvalues(-k);
}

double distance(const Eigen::Ref<const Eigen::MatrixXd>& a,
                const Eigen::Ref<const Eigen::MatrixXd>& b) {
  if (a.size() == 0) return 0;
  const double largest = (a - b).lpNorm<Eigen::Infinity>();
  return (a - b).allFinite() ? largest : INFINITY;
}

}  // namespace tests
}  // namespace qddot
