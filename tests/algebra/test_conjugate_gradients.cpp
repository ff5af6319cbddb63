#include <boost/test/unit_test.hpp>

#include "qddot/algebra/conjugate_gradients.hpp"
#include "qddot/algebra/factors.hpp"
#include "tests/algebra/matrices.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(conjugate_gradients)

using namespace qddot;

namespace {

// P, the d x d blocks on the diagonal of A.
Eigen::MatrixXd blocks_of(const SymmetricMatrix& a, int d) {
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(a.rows(), a.rows());
  for (Index i = 0; i < a.rows(); i += d)
    p.block(i, i, d, d) = Eigen::MatrixXd(a.block(i, i, d, d));
  return p;
}

// A scene's masses and K a little away from its start, with every spring at about `stretch` times
// its rest length.
Matrix displaced(const std::string& name, const GeneratorValues& values, double stretch,
                 const Reductions& reductions = only_pins) {
  return displaced(stretched(draw(name, values), stretch), reductions, 1e-3);
}

// K of n masses of 1 kg on springs of stiffness `stiffness` between two pins. The eigenvalues of M
// - K are 1 + 4 stiffness sin^2(j pi / (2 (n + 1))). Those of K are negative for a positive
// stiffness.
SymmetricMatrix chain(int n, double stiffness) {
  return stiffness_at(*make_mass_spring(linear_chain(n, 1, stiffness)), Vec::Zero(n));
}

}  // namespace

// The residual in the largest norm is at most the tolerance times the root of n, and times the root
// of the ratio of the largest and smallest block. That ratio is 1e2 for the scenes' masses and
// stiffnesses.
BOOST_AUTO_TEST_CASE(every_scene_is_solved_or_known_to_be_indefinite) {
  int found = 0, indefinite = 0;
  for (const Generator& generator : generators()) {
    for (const auto& reductions : {Reductions{}, only_pins}) {
      for (const double stretch : {0.9, 1.1}) {
        const Matrix at = displaced(generator.name, {}, stretch, reductions);
        const auto factors = make_conjugate_gradients(at.k, at.diagonal);
        const auto reference = make_multifrontal(at.k, at.diagonal);
        factors->set_tolerance(1e-13);
        for (const double s : {0.0, 1e-8, 1e-6, 1e-4, 1e-2}) {
          BOOST_TEST_CONTEXT(generator.name << " of " << at.diagonal.size() << ", s = " << s) {
            const bool positive = reference->factorize_positive(1, s, at.k);
            const bool passes = factors->factorize_positive(1, s, at.k);
            BOOST_TEST((passes || !positive));
            const Vec b = Vec::LinSpaced(at.diagonal.size(), -1, 2);
            Vec x;
            const SolveOutcome outcome = factors->solve(b, x);
            BOOST_TEST(outcome == (positive ? SolveOutcome::found : SolveOutcome::indefinite));
            if (!positive) BOOST_TEST(factors->negative_pivots() == 1);
            if (positive) BOOST_TEST(backward_error(at.whole(1, s), x, b) < 1e-10);
            (positive ? found : indefinite) += 1;
          }
        }
      }
    }
  }
  BOOST_TEST(found >= 40);
  BOOST_TEST(indefinite >= 5);
}

// Rounding of the updated residual, far below the tolerances here, is the 1 %; an iteration never
// shrinks it a thousandfold.
BOOST_AUTO_TEST_CASE(the_tolerance_is_what_is_left) {
  for (const Matrix& at :
       {displaced("lattice", {{"nodes_x", 8}, {"nodes_y", 5}, {"nodes_z", 5}}, 1.2),
        displaced("cloth", {{"nodes", 12}}, 1.2)}) {
    const double s = 1e-5;
    const SymmetricMatrix a = at.whole(1, s);
    const auto factors = make_conjugate_gradients(at.k, at.diagonal);
    BOOST_TEST(factors->factorize_positive(1, s, at.k));
    const Eigen::LLT<Eigen::MatrixXd> p(blocks_of(a, 3));
    const Vec b = Vec::LinSpaced(at.diagonal.size(), -1, 2);
    Vec x;
    for (const double tolerance : {1e-1, 1e-4, 1e-8}) {
      factors->set_tolerance(tolerance);
      BOOST_TEST((factors->solve(b, x) == SolveOutcome::found));
      const Vec r = b - a * x;
      const double left = std::sqrt(r.dot(p.solve(r)) / b.dot(p.solve(b)));
      BOOST_TEST(left < 1.01 * tolerance);
      BOOST_TEST(left > 1e-3 * tolerance);
    }
  }
}

// |e_i|_A <= 2 ((root - 1)/(root + 1))^i |e_0|_A with root = sqrt(kappa), and the relative residual
// is at most root times the relative error. So it is below tol after root/2 ln(2 root/tol)
// iterations. One iteration brings the right-hand side one mass further along.
BOOST_AUTO_TEST_CASE(iterations_grow_with_the_root_of_the_condition_number) {
  constexpr int n = 400;
  constexpr double tolerance = 1e-8;
  for (const double stiffness : {1.0, 30.0, 1e3, 3e4}) {
    const SymmetricMatrix k = chain(n, stiffness);
    const auto factors = make_conjugate_gradients(k, Vec::Ones(n));
    factors->set_tolerance(tolerance);
    factors->factorize_positive(1, 1, k);
    Vec x;
    BOOST_TEST((factors->solve(Vec::Unit(n, 0), x) == SolveOutcome::found));
    const double root = std::sqrt(1 + 4 * stiffness);
    BOOST_TEST(static_cast<double>(factors->iterations()) <
               root / 2 * std::log(2 * root / tolerance) + 1);
    BOOST_TEST(static_cast<double>(factors->iterations()) >
               std::min<double>(n - 1, root / 4 * std::log(1 / tolerance)));
  }
}

BOOST_AUTO_TEST_CASE(too_many_iterations_are_given_up) {
  constexpr int n = 30000;  // so many it takes for the end of the chain to hear of its start
  const SymmetricMatrix k = chain(n, 1);
  const auto factors = make_conjugate_gradients(k, Vec::Zero(n));
  BOOST_TEST(factors->factorize_positive(0, 1, k));
  Vec x;
  BOOST_TEST((factors->solve(Vec::Unit(n, 0), x) == SolveOutcome::not_converged));
}

// s lies on both sides of the value at which the largest eigenvalue lambda of M^-1 K makes M - s K
// indefinite.
BOOST_AUTO_TEST_CASE(an_indefinite_matrix_is_found_out_by_a_right_hand_side_that_sees_it) {
  for (const Matrix& at :
       {displaced("lattice", {{"nodes_x", 6}, {"nodes_y", 4}, {"nodes_z", 4}}, 0.9),
        displaced("cloth", {{"nodes", 8}}, 0.9)}) {
    const Vec root = at.diagonal.cwiseSqrt().cwiseInverse();
    const double lambda = largest_eigenvalue(root.asDiagonal() * dense(at.k) * root.asDiagonal());
    BOOST_TEST_REQUIRE(lambda > 0);
    const auto factors = make_conjugate_gradients(at.k, at.diagonal);
    Vec x;
    const Vec b = Vec::LinSpaced(at.diagonal.size(), -1, 2);
    BOOST_TEST(factors->factorize_positive(1, 0.99 / lambda, at.k));
    BOOST_TEST((factors->solve(b, x) == SolveOutcome::found));
    const bool passes = factors->factorize_positive(1, 1.01 / lambda, at.k);
    BOOST_TEST((factors->solve(b, x) == SolveOutcome::indefinite));
    BOOST_TEST(factors->negative_pivots() == 1);
    // A right-hand side in the eigenvectors of P^-1 A with positive eigenvalues does not find it
    // out; it is solved.
    if (!passes) continue;
    BOOST_TEST(factors->factorize_positive(1, 1.01 / lambda, at.k));
    const SymmetricMatrix a = at.whole(1, 1.01 / lambda);
    const Eigen::MatrixXd p = blocks_of(a, 3);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> parts{Eigen::MatrixXd(a), p};
    Vec among = b;
    for (Index i = 0; i < b.size() && parts.eigenvalues()[i] <= 0; ++i) {
      const auto v = parts.eigenvectors().col(i);
      among -= v * v.dot(p * among);
    }
    const Vec right = p * among;
    factors->set_tolerance(1e-4);
    BOOST_TEST((factors->solve(right, x) == SolveOutcome::found));
    BOOST_TEST(backward_error(a, x, right) < 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(a_block_that_is_not_positive_definite_is_seen_at_once) {
  const SymmetricMatrix k = chain(9, 1);
  const auto factors = make_conjugate_gradients(k, Vec::Ones(9));
  Vec x;
  BOOST_TEST((factors->factorize(1, -0.6, k) == Definiteness::indefinite));  // 1 - 1.2
  BOOST_TEST((factors->solve(Vec::Ones(9), x) == SolveOutcome::indefinite));
  BOOST_TEST((factors->factorize(1, -0.5, k) == Definiteness::singular));
  BOOST_TEST((factors->factorize(INFINITY, 1, k) == Definiteness::singular));
  BOOST_TEST(!factors->factorize_positive(0, 0, k));
  // And nothing of it is left.
  BOOST_TEST((factors->factorize(1, 1, k) == Definiteness::positive));
  BOOST_TEST(factors->negative_pivots() == 0);
  BOOST_TEST((factors->solve(Vec::Ones(9), x) == SolveOutcome::found));
}

BOOST_AUTO_TEST_CASE(zero_is_solved_by_zero_and_no_number_by_none) {
  const SymmetricMatrix k = chain(9, 1);
  const auto factors = make_conjugate_gradients(k, Vec::Ones(9));
  factors->factorize_positive(1, 1, k);
  Vec x;
  BOOST_TEST((factors->solve(Vec::Zero(9), x) == SolveOutcome::found));
  BOOST_TEST(x == Vec::Zero(9));
  factors->solve(Vec::Constant(9, NAN), x);
  BOOST_TEST(!x.allFinite());
  const SymmetricMatrix none(0, 0);
  const auto empty = make_conjugate_gradients(none, Vec());
  BOOST_TEST(empty->factorize_positive(1, 1, none));
  BOOST_TEST((empty->solve(Vec(), x) == SolveOutcome::found));
  BOOST_TEST(x.size() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
