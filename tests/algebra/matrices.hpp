#pragma once

#include <string>

#include <boost/test/unit_test.hpp>

#include "qddot/algebra/effective_mass.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

// Types without text, declared once for all tests as Boost.Test requires.
BOOST_TEST_DONT_PRINT_LOG_VALUE(qddot::Definiteness)
BOOST_TEST_DONT_PRINT_LOG_VALUE(qddot::SolveOutcome)

namespace qddot {
inline namespace tests {

// D - s K, both triangles.
inline SymmetricMatrix whole(const Vec& diagonal, double s, const SymmetricMatrix& k) {
  SymmetricMatrix sum = -s * k;
  for (Index i = 0; i < diagonal.size(); ++i) sum.coeffRef(i, i) += diagonal[i];
  return sum.selfadjointView<Eigen::Lower>();
}

// A diagonal and a K to solve with.
struct Matrix {
  std::string name;
  Vec diagonal;
  SymmetricMatrix k;

  SymmetricMatrix whole(double a, double s) const { return tests::whole(a * diagonal, s, k); }
};

// The masses and the K of a scene whose coordinates are moved by up to `part` of the largest.
inline Matrix displaced(const Scene& scene, const Reductions& reductions, double part) {
  const Model reduced(scene, reductions);
  std::mt19937 random(13);
  const Vec& q = reduced.initial().q;
  const double size = q.size() > 0 ? std::max(q.cwiseAbs().maxCoeff(), 1e-3) : 0;
  return {scene.name, reduced.system().mass(),
          stiffness_at(reduced.system(), moved(reduced, part * size, random).q)};
}
inline const Reductions only_pins = Reductions::only({Reduction::pins});

// |A x - b| over |A| |x| + |b|, in the largest norm: how far the matrix that was solved with is
// from A.
inline double backward_error(const SymmetricMatrix& a, const Vec& x, const Vec& b) {
  if (b.size() == 0) return 0;
  const double norm = (a.cwiseAbs() * Vec::Ones(a.rows())).maxCoeff();
  return distance(a * x, b) / (norm * x.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}
// The backward error of a solve with factors of A.
template <class Factors>
double backward_error(Factors& factors, const SymmetricMatrix& a) {
  const Vec b = Vec::LinSpaced(a.rows(), -1, 2);
  Vec x(a.rows());
  factors.solve(b, x);
  return backward_error(a, x, b);
}

// n eps bounds the backward error where L and D do not grow; rounding errors of random sign add up
// to its root.
inline double tolerance_of(const SymmetricMatrix& a) {
  return 10 * eps * std::sqrt(static_cast<double>(std::max<Index>(a.rows(), 1)));
}
// LDL' without pivoting multiplies that by the growth of its entries, which a small pivot makes
// large; this leaves room for a factor of 1e4.
constexpr double indefinite_tolerance = 1e-10;

}  // namespace tests
}  // namespace qddot
