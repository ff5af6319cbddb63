#include "qddot/algebra/leading_pairs.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include <Spectra/SymEigsSolver.h>

#include "qddot/algebra/solver.hpp"

namespace qddot {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double tolerance = 1e-10;
constexpr Index most_restarts = 2000;
// The number of pairs that a later round asks for; most rounds only show that nothing was missed.
constexpr Index later_count = 4;

// A without the space of some orthonormal vectors, as an operator for Spectra.
class Deflated {
 public:
  using Scalar = double;

  Deflated(const SymmetricOperator& a, Index n, const MatrixXd& found)
      : a_(a), found_(found), x_(n), y_(n) {}

  Index rows() const { return x_.size(); }
  Index cols() const { return x_.size(); }
  void perform_op(const double* in, double* out) const {
    x_ = VectorXd::Map(in, rows());
    project(x_);
    a_(x_, y_);
    project(y_);
    VectorXd::Map(out, rows()) = y_;
  }

 private:
  void project(VectorXd& x) const {
    if (found_.cols() > 0) x -= found_ * (found_.transpose() * x);
  }

  const SymmetricOperator& a_;
  const MatrixXd& found_;
  mutable VectorXd x_, y_;
};

Spectra::SymEigsSolver<Deflated> lanczos(Deflated& a, Index count, double tol) {
  // A basis of twice the wanted pairs converges in few restarts; 20 is for few pairs.
  Spectra::SymEigsSolver solver(a, count, std::min(a.rows(), 2 * count + 20));
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, most_restarts, tol);
  if (solver.info() != Spectra::CompInfo::Successful) {
    throw SolverFailure("Lanczos' iteration for eigenvalues did not converge");
  }
  return solver;
}

// The `count` largest of two sets of pairs.
EigenPairs merged(const EigenPairs& a, const EigenPairs& b, Index count) {
  VectorXd values(a.values.size() + b.values.size());
  values << a.values, b.values;
  MatrixXd vectors(b.vectors.rows(), values.size());
  vectors << a.vectors, b.vectors;
  std::vector<Index> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater{}, [&](Index i) { return values[i]; });
  order.resize(std::min(count, values.size()));
  return {values(order), vectors(Eigen::all, order)};
}

}  // namespace

EigenPairs leading_pairs(const SymmetricOperator& a, Index n, Index count) {
  EigenPairs found{VectorXd(0), MatrixXd(n, 0)};
  // Each round but the last replaces at least one pair by a larger one that belongs there.
  for (Index round = 0; round <= count; ++round) {
    Deflated rest(a, n, found.vectors);
    const auto solver = lanczos(rest, round == 0 ? count : std::min(count, later_count), tolerance);
    const EigenPairs more{solver.eigenvalues(), solver.eigenvectors()};
    if (round > 0 && more.values[0] <= found.values[count - 1] * (1 + tolerance)) break;
    found = merged(found, more, count);
  }
  return found;
}

double leading_value(const SymmetricOperator& a, Index n, double tol) {
  const MatrixXd none(n, 0);
  Deflated all(a, n, none);
  return lanczos(all, 1, tol).eigenvalues()[0];
}

}  // namespace qddot
