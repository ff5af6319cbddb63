#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(newton)

using namespace qddot;

namespace {

constexpr int masses = 5;
constexpr double mass = 0.1, stiffness = 1e4;

// A chain along x in 2D between pins at 0 and 6 m whose springs are 1/0.7 of their room long. It is
// at rest, bent by `bend` m to one side and the other.
Problem strut(double bend) {
  return row_between_pins(masses, mass, {.stiffness = stiffness, .rest_length = 1 / 0.7},
                          [=](int i) { return (i % 2 == 0 ? bend : -bend) * (1 + 0.1 * i); });
}

// An implicit Euler step as a minimisation over v.
struct Minimisation {
  State start;
  double h;
  std::unique_ptr<System> system;

  Minimisation(const Problem& p, double size)
      : start(p.initial), h(size), system(make_mass_spring(p.network)) {}

  double objective(const Vec& v) const {
    return system->kinetic(v - start.v) + system->potential(Vec(start.q + h * v));
  }
  Vec gradient(const Vec& v) const {
    return system->mass().cwiseProduct(v - start.v) - h * force_at(*system, start.q + h * v);
  }
  // The smallest eigenvalue of M - h^2 K, in units of the mass.
  double least_curvature(const Vec& v) const {
    const Eigen::MatrixXd m = system->mass().asDiagonal();
    return smallest_eigenvalue(m - h * h * dense(stiffness_at(*system, start.q + h * v))) / mass;
  }
  Run run(double t_end) const {
    return tests::run(method_named("implicit_euler"), *system, start, t_end,
                      {.step_size = h, .solve_tolerance = 1e-12});
  }
};

// A minimum, below the start.
bool is_solved(const Minimisation& problem, const Vec& v) {
  // Corrections down to 1e-12 of what the prediction missed: gradients down to 1e-9 of the first,
  // for matrices of condition ten and more.
  return problem.gradient(v).norm() < 1e-9 * problem.gradient(problem.start.v).norm() &&
         problem.least_curvature(v) > 0 &&
         problem.objective(v) < problem.objective(problem.start.v);
}

bool is_named_failure(const Run& r) {
  return (r.summary.outcome == Outcome::newton_failed ||
          r.summary.outcome == Outcome::indefinite_matrix) &&
         !r.summary.message.empty();
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_bent_strut_is_solved_where_compression_outweighs_the_mass) {
  for (const double bend : {0.001, 0.01, 0.1}) {
    for (const double h : {0.01, 0.03, 0.1}) {
      BOOST_TEST_CONTEXT("bend " << bend << " m, h = " << h << " s") {
        const Minimisation problem(strut(bend), h);
        BOOST_TEST(problem.least_curvature(problem.start.v) < -1);
        const Run r = problem.run(h);
        BOOST_TEST(r.summary.message == "");
        BOOST_TEST(is_solved(problem, r.state.v));
        BOOST_TEST(total_energy(*problem.system, r.state) <
                   total_energy(*problem.system, problem.start));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_bent_strut_buckles_and_comes_to_rest_without_compression) {
  const Problem p = strut(0.01);
  const Minimisation problem(p, 0.03);
  const Run r = problem.run(3);
  BOOST_TEST(r.summary.message == "");
  // The energy is zero if springs have their rest length in the room that they have. The energy
  // after 100 strongly damped steps is far below the first 1/2 k (0.43 m)^2 = 900 J of each of 6
  // springs.
  BOOST_TEST(total_energy(*problem.system, r.state) < 1);
  BOOST_TEST(total_energy(*problem.system, p.initial) > 5000);
}

BOOST_AUTO_TEST_CASE(a_straight_strut_is_solved_or_refused_by_name_after_few_iterations) {
  // Its straightness is an equilibrium, though no stable one.
  for (const double h : {0.01, 0.1, 1.0}) {
    const Minimisation problem(strut(0), h);
    const Run r = problem.run(h);
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
    for_springs(p.network, [=](auto& spring) { spring.law.stiffness *= stiffer; });
    const Minimisation problem(p, h);
    const Run r = problem.run(h);
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
