#include <boost/test/unit_test.hpp>

#include "integrators/sundials/newton_matrix.hpp"
#include "integrators/sundials/support.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(newton_matrix)

using namespace qddot;

namespace {

using Eigen::MatrixXd;
using namespace qddot::sundials;

enum class Form { explicit_gamma, implicit_c };
constexpr Form both_forms[] = {Form::explicit_gamma, Form::implicit_c};

using Make = std::unique_ptr<NewtonMatrix> (*)(const System&, SUNContext, qddot::Solver);

// A Newton matrix of a system and the solver behind it, used as SUNDIALS does.
class Solver {
 public:
  Solver(Make make, const System& system)
      : x_(make_stock_vector(2 * system.size(), context_.get())),
        b_(clone(x_.get())),
        matrix_(make(system, context_.get(), qddot::Solver::multifrontal)) {}

  int factorize(Form form, double gamma, const SymmetricMatrix& k) {
    if (form == Form::explicit_gamma) matrix_->set_explicit_form(gamma, k);
    if (form == Form::implicit_c) matrix_->set_implicit_form(1 / gamma, k);
    return SUNLinSolSetup(matrix_->solver(), matrix_->matrix());
  }
  int try_to_solve(const Vec& b, Vec& x) {
    Eigen::Map<Vec>(N_VGetArrayPointer(b_.get()), b.size()) = b;
    const int flag = SUNLinSolSolve(matrix_->solver(), matrix_->matrix(), x_.get(), b_.get(), 0);
    x = Eigen::Map<const Vec>(N_VGetArrayPointer(x_.get()), b.size());
    return flag;
  }
  Vec solve(const Vec& b) {
    Vec x;
    BOOST_TEST_REQUIRE(try_to_solve(b, x) == 0);
    return x;
  }
  std::int64_t indefinite() const { return matrix_->indefinite(); }

 private:
  Context context_ = make_context();
  Vector x_, b_;
  std::unique_ptr<NewtonMatrix> matrix_;
};

MatrixXd dense_mass(const System& system) { return system.mass().asDiagonal(); }

// The 2n x 2n matrix as its definition has it.
MatrixXd dense_matrix(Form form, const System& system, double gamma, const SymmetricMatrix& k) {
  const Index n = system.size();
  const MatrixXd one = MatrixXd::Identity(n, n);
  MatrixXd a(2 * n, 2 * n);
  if (form == Form::explicit_gamma) {
    a << one, -gamma * one, -gamma * system.mass().cwiseInverse().asDiagonal() * dense(k), one;
  } else {
    const Vec has_mass = (system.mass().array() > 0).cast<double>();
    const MatrixXd of_mass = has_mass.asDiagonal();
    a << of_mass / gamma, -one, -dense(k), dense_mass(system) / gamma;
  }
  return a;
}

// M - gamma^2 K.
MatrixXd effective(const System& system, double gamma, const SymmetricMatrix& k) {
  return dense_mass(system) - gamma * gamma * dense(k);
}
double condition(const MatrixXd& symmetric) {
  const Vec sizes = eigenvalues(symmetric).cwiseAbs();
  return sizes.maxCoeff() / sizes.minCoeff();
}

// The distance of the solution of `solver` to that of dense LU, as a multiple of the expected
// rounding. Rounding is eps times the condition of the n x n matrix, times the size of the
// solution. In the second half, differences of the first are multiplied by 1/gamma.
double roundings(Solver& solver, Form form, const System& system, double gamma,
                 const SymmetricMatrix& k, const Vec& b) {
  const MatrixXd a = dense_matrix(form, system, gamma, k);
  const Vec x = solution(a, b);
  const double worst =
      eps * condition(effective(system, gamma, k)) * (1 + 1 / gamma) * x.lpNorm<Eigen::Infinity>();
  return distance(solver.solve(b), x) / worst;
}
// Sums of up to 36 terms, and LU's own rounding.
constexpr double most_roundings = 100;

Vec random_vector(std::mt19937& random, Index n) {
  std::normal_distribution<double> normal;
  return Vec::NullaryExpr(n, [&] { return normal(random); });
}

// A unit mass at the end of a spring twice as long as its room of 1 m: across it, K = 1.
Network strut() {
  Network network{.dimension = 2, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {0, 0, 0}, {.stiffness = 1, .rest_length = 2}}};
  return network;
}

}  // namespace

BOOST_AUTO_TEST_CASE(both_solvers_solve_the_dense_system_in_both_forms) {
  std::mt19937 random(1);
  std::int64_t definite = 0, indefinite = 0;
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.5, 0.9, 1.2}) {
      for (const bool is_massless : {false, true}) {
        Problem p = random_network(random, dimension, 6, stretch);
        if (is_massless) p.network.node_mass[1] = p.network.node_mass[4] = 0;
        const auto system = make_mass_spring(p.network);
        const SymmetricMatrix k = stiffness_at(*system, p.initial.q);
        Solver structured(make_structured, *system), klu(make_klu, *system);
        for (const Form form : both_forms) {
          if (is_massless && (form == Form::explicit_gamma || stretch < 1)) continue;
          for (const double gamma : {1e-3, 0.02, 0.1, 0.5}) {
            BOOST_TEST_CONTEXT(dimension << "D, stretch " << stretch << ", gamma " << gamma) {
              const bool is_not_positive = smallest_eigenvalue(effective(*system, gamma, k)) < 0;
              ++(is_not_positive ? indefinite : definite);
              const std::int64_t before = structured.indefinite();
              BOOST_TEST_REQUIRE(structured.factorize(form, gamma, k) == 0);
              BOOST_TEST(structured.indefinite() - before == is_not_positive);
              BOOST_TEST_REQUIRE(klu.factorize(form, gamma, k) == 0);
              for (int sample = 0; sample < 3; ++sample) {
                const Vec b = random_vector(random, 2 * system->size());
                BOOST_TEST(roundings(structured, form, *system, gamma, k, b) < most_roundings);
                BOOST_TEST(roundings(klu, form, *system, gamma, k, b) < most_roundings);
              }
            }
          }
        }
        BOOST_TEST(klu.indefinite() == 0);  // which LU does not ask about
      }
    }
  }
  // Each kind is seen often.
  BOOST_TEST(definite > 20);
  BOOST_TEST(indefinite > 10);
}

BOOST_AUTO_TEST_CASE(a_singular_matrix_is_refused_so_that_a_smaller_step_is_tried) {
  const auto compressed = make_mass_spring(strut());
  const SymmetricMatrix k = stiffness_at(*compressed, Vec{{1, 0}});
  Network loose = strut();
  loose.node_mass.setZero();
  loose.anchors.clear();
  const auto nothing = make_mass_spring(loose);
  for (const Form form : both_forms) {
    // 1 - gamma^2 K = 0 across the spring, exactly.
    Solver structured(make_structured, *compressed), klu(make_klu, *compressed);
    BOOST_TEST(structured.factorize(form, 1, k) == 1);
    BOOST_TEST(structured.indefinite() == 0);
    BOOST_TEST(klu.factorize(form, 1, k) != 0);
    BOOST_TEST(structured.factorize(form, 0.5, k) == 0);
    BOOST_TEST(structured.indefinite() == 0);
    BOOST_TEST(structured.factorize(form, 2, k) == 0);
    BOOST_TEST(structured.indefinite() == 1);
  }
  // A massless node on no spring.
  Solver structured(make_structured, *nothing), klu(make_klu, *nothing);
  const SymmetricMatrix zero = stiffness_at(*nothing, Vec::Zero(2));
  BOOST_TEST(structured.factorize(Form::implicit_c, 1, zero) == 1);
  BOOST_TEST(klu.factorize(Form::implicit_c, 1, zero) != 0);
}

BOOST_AUTO_TEST_CASE(pivots_near_zero_are_made_up_for_by_refinement_or_refused) {
  // M - K = [[d, -1], [-1, d]] is well conditioned, but its first pivot is d, which rounding is
  // divided by. A solution without refinement is wrong by eps/d.
  const auto system =
      make_mass_spring({.dimension = 1, .node_mass = Vec::Ones(2), .links = {{0, 1, {1}}}});
  SymmetricMatrix k = system->stiffness_pattern();
  int solved = 0;
  for (int digits = 4; digits <= 16; ++digits) {
    const double d = std::pow(10, -digits);
    k.coeffRef(0, 0) = k.coeffRef(1, 1) = 1 - d;
    k.coeffRef(1, 0) = 1;
    Solver solver(make_structured, *system);
    for (const Form form : both_forms) {
      BOOST_TEST_CONTEXT("pivot " << d) {
        const Eigen::MatrixXd a = dense_matrix(form, *system, 1, k);
        const Vec b{{1.3, -0.7, 0.4, 2.1}};
        Vec x;
        if (solver.factorize(form, 1, k) == 0 && solver.try_to_solve(b, x) == 0) {
          ++solved;
          BOOST_TEST(distance(a * x, b) < 1e-7);  // 1e-8 of the n x n system
        } else {
          BOOST_TEST(digits > 11);  // where even a second look is wrong by (eps/d)^2 > 1e-10
        }
      }
    }
  }
  BOOST_TEST(solved >= 16);
}

BOOST_AUTO_TEST_SUITE_END()
