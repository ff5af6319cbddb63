#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(newton)

using namespace qddot;

namespace {

using Eigen::MatrixXd;

constexpr int masses = 5;
constexpr double mass = 0.1, stiffness = 1e4;

// A chain along x in 2D between pins at 0 and 6 m whose springs are 1/0.7 of their room long. It is
// at rest, bent by `bend` m to one side and the other.
Problem strut(double bend) {
  return row_between_pins(masses, mass, {.stiffness = stiffness, .rest_length = 1 / 0.7},
                          [=](int i) { return (i % 2 == 0 ? bend : -bend) * (1 + 0.1 * i); });
}

// An implicit Euler step as a minimisation over v.
class Minimisation {
 public:
  Minimisation(const Problem& p, double h)
      : h_(h), initial_(p.initial), system_(make_mass_spring(p.network)) {}

  double objective(const Vec& v) const {
    return system_->kinetic(v - initial_.v) + system_->potential(q(v));
  }
  Vec gradient(const Vec& v) const {
    return system_->mass().cwiseProduct(v - initial_.v) - h_ * force_at(*system_, q(v));
  }
  // The smallest eigenvalue of M - h^2 K, in units of the mass.
  double least_curvature(const Vec& v) const {
    return Eigen::SelfAdjointEigenSolver<MatrixXd>(hessian(v)).eigenvalues()[0] / mass;
  }
  const Vec& start() const { return initial_.v; }
  Run step(double t_end) const {
    return run(method_named("implicit_euler"), *system_, initial_, t_end,
               {.step_size = h_, .solve_tolerance = 1e-12});
  }
  const System& system() const { return *system_; }

 private:
  Vec q(const Vec& v) const { return initial_.q + h_ * v; }
  MatrixXd hessian(const Vec& v) const {
    return MatrixXd(system_->mass().asDiagonal()) - h_ * h_ * dense(stiffness_at(*system_, q(v)));
  }

  double h_;
  State initial_;
  std::unique_ptr<System> system_;
};

// A minimum, below the start.
bool is_solved(const Minimisation& problem, const Vec& v) {
  // Corrections down to 1e-12 of what the prediction missed: gradients down to 1e-9 of the first,
  // for matrices of condition ten and more.
  return problem.gradient(v).norm() < 1e-9 * problem.gradient(problem.start()).norm() &&
         problem.least_curvature(v) > 0 &&
         problem.objective(v) < problem.objective(problem.start());
}

bool is_named_failure(const Run& r) {
  return (r.summary.outcome == Outcome::newton_failed ||
          r.summary.outcome == Outcome::indefinite_matrix) &&
         !r.summary.message.empty();
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_bent_strut_buckles_and_comes_to_rest_without_compression) {
  const Problem p = strut(0.01);
  const Minimisation problem(p, 0.03);
  BOOST_TEST(problem.least_curvature(problem.start()) < -1);  // compression outweighs the mass
  const Run r = problem.step(3);
  BOOST_TEST(r.summary.message == "");
  // The energy is zero if springs have their rest length in the room that they have. The energy
  // after 100 strongly damped steps is far below the first 1/2 k (0.43 m)^2 = 900 J of each of 6
  // springs.
  BOOST_TEST(total_energy(problem.system(), r.state) < 1);
  BOOST_TEST(total_energy(problem.system(), p.initial) > 5000);
}

BOOST_AUTO_TEST_CASE(a_straight_strut_is_solved_or_refused_by_name_after_few_iterations) {
  // Its straightness is an equilibrium, though no stable one.
  for (const double h : {0.01, 0.1, 1.0}) {
    const Minimisation problem(strut(0), h);
    const Run r = problem.step(h);
    if (r.summary.outcome == Outcome::reached_end) {
      BOOST_TEST(problem.gradient(r.state.v).norm() < 1e-9);
    } else {
      BOOST_TEST(is_named_failure(r));
      BOOST_TEST(r.state.t == 0);
      BOOST_TEST(r.state.v.norm() == 0);
    }
    BOOST_TEST(r.summary.counts.newton_iterations <= 100);
    BOOST_TEST(r.summary.counts.factorizations <= 400);
  }
}

BOOST_AUTO_TEST_CASE(compressed_random_networks_end_lower_or_refused_by_name) {
  std::mt19937 random(8);
  int solved = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Problem p = random_network(random, 2 + trial % 2, 2 + trial % 5, 0.6);
    const double stiffer = std::pow(10, trial % 4), h = std::pow(10, -1 - trial % 3);
    for (auto& link : p.network.links) link.law.stiffness *= stiffer;
    for (auto& anchor : p.network.anchors) anchor.law.stiffness *= stiffer;
    const Minimisation problem(p, h);
    const Run r = problem.step(h);
    if (r.summary.outcome == Outcome::reached_end) {
      ++solved;
      BOOST_TEST(is_solved(problem, r.state.v));
    } else {
      BOOST_TEST(is_named_failure(r));
      BOOST_TEST(same(r.state, p.initial));
    }
  }
  BOOST_TEST(solved >= 190);  // in practice it solves nearly all
}

BOOST_AUTO_TEST_SUITE_END()
