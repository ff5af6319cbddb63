#include <limits>
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/model/block_diagonal_system.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(exact)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
const Method& method = method_named("exact");

Run run_exact(const Problem& p, double t_end, double h) {
  Run r = run(method, p, t_end, {.step_size = h});
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(r.state.t == t_end);
  return r;
}

// linear_chain with every mode in motion, and its closed form: with x_i = i at rest,
//   q_i(t) = i + sum_j sin(i j pi / (n + 1)) (a_j cos w_j t + b_j / w_j sin w_j t).
struct Chain {
  static constexpr int n = 9;
  static constexpr double mass = 0.3, stiffness = 200;

  Chain() : a(n), b(n) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> amplitude(-1, 1);
    for (double& x : a) x = 0.1 * amplitude(random);
    for (double& x : b) x = amplitude(random);
  }
  static double omega(int j) {
    return 2 * std::sqrt(stiffness / mass) * std::sin(j * M_PI / (2 * (n + 1)));
  }
  State at(double t) const {
    State s{t, Vec::LinSpaced(n, 1, n), Vec::Zero(n)};
    for (int j = 1; j <= n; ++j) {
      const double w = omega(j), c = std::cos(w * t), d = std::sin(w * t);
      for (int i = 1; i <= n; ++i) {
        const double shape = std::sin(i * j * M_PI / (n + 1));
        s.q[i - 1] += shape * (a[j - 1] * c + b[j - 1] / w * d);
        s.v[i - 1] += shape * (b[j - 1] * c - a[j - 1] * w * d);
      }
    }
    return s;
  }
  Problem problem() const { return {linear_chain(n, mass, stiffness), at(0)}; }

  Vec a, b;
};

// An overall tolerance for a motion of n unknowns: a phase w t rounds with each of its factors,
// each step rounds all that it puts together.
double rounding(double w, double t, double steps, Index n) {
  return static_cast<double>(n) * eps * (10 * w * t + 4 * steps + 10);
}

}  // namespace

BOOST_AUTO_TEST_CASE(chain_follows_its_closed_form_at_small_and_absurdly_large_steps) {
  const Chain chain;
  const double w = Chain::omega(Chain::n);
  for (const double t : {0.1, 3.0, 100.0}) {
    for (const double h : {0.01, 0.5, 1e6}) {
      const Run r = run_exact(chain.problem(), t, h);
      // Positions up to n; speeds w times the displacements, which are below 1.
      const double tolerance = rounding(w, t, static_cast<double>(r.summary.counts.steps), 9) * 9;
      BOOST_TEST(distance(r.state.q, chain.at(t).q) < tolerance);
      BOOST_TEST(distance(r.state.v, chain.at(t).v) < tolerance * w);
      BOOST_TEST(distance(chain.at(t + 1e-9).v, chain.at(t).v) > tolerance * w);  // would be seen
    }
  }
}

BOOST_AUTO_TEST_CASE(the_step_makes_no_difference) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = linear_hammock(dimension);
    const double t = 7.3;
    const State whole = run_exact(p, t, 1e4).state;
    for (const double h : {0.003, 0.1, 1.0, 5.0}) {
      const Run r = run_exact(p, t, h);
      // 12 unknowns of some 10 m and 100 m/s, below 25 rad/s.
      const double tolerance =
          100 * rounding(25, t, static_cast<double>(r.summary.counts.steps), 12);
      BOOST_TEST(distance(r.state, whole) < tolerance);
    }
    const Run verlet = run(method_named("verlet"), p, t, {.step_size = 0.003});
    BOOST_TEST(distance(verlet.state, whole) > 1e-5);  // as any step error is
  }
}

BOOST_AUTO_TEST_CASE(it_gives_up_on_too_many_unknowns_with_their_number) {
  const auto system = make_mass_spring(linear_chain(2001, 1, 1));
  const State start{0, Vec::LinSpaced(2001, 1, 2001), Vec::Ones(2001)};
  const Run r = run(method, *system, start, 1, {.step_size = 1});
  BOOST_TEST(name(r.summary.outcome) == "solver_failed");
  BOOST_TEST(r.summary.message ==
             "2001 unknowns are too many for all modes; at most 2000 are allowed");
  BOOST_TEST(same(r.state, start));
}

BOOST_AUTO_TEST_CASE(parts_have_their_modes_each_for_itself) {
  // More unknowns than it would take of one system.
  std::vector<std::unique_ptr<System>> parts;
  constexpr int count = 250, size = 9;
  for (int i = 0; i < count; ++i) parts.push_back(make_mass_spring(Chain().problem().network));
  const BlockDiagonalSystem system(std::move(parts));
  const Chain chain;
  const State start{0, chain.at(0).q.replicate<count, 1>(), chain.at(0).v.replicate<count, 1>()};
  const Run r = run(method, system, start, 3, {.step_size = 3});
  BOOST_TEST(system.size() > 2000);
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(distance(r.state.q.tail(size), chain.at(3).q) <
             9 * rounding(Chain::omega(size), 3, 1, size));
}

BOOST_AUTO_TEST_CASE(free_masses_fly_on_parabolas_at_every_step) {
  const Network network{.dimension = 3, .gravity = {1, 0, -9.81}, .node_mass = Vec{{0.3, 20}}};
  const State start{1, Vec::LinSpaced(6, -1, 3), Vec::LinSpaced(6, 5, -4)};
  const Vec g = Vec{{1, 0, -9.81}}.replicate(2, 1);
  for (const double h : {0.01, 1.0, 1e5}) {
    const double dt = 10;
    const Run r = run_exact({network, start}, start.t + dt, h);
    // Up to 500 m, and a rounding in each step.
    const double steps = static_cast<double>(r.summary.counts.steps);
    BOOST_TEST(distance(r.state.q, start.q + dt * start.v + 0.5 * dt * dt * g) <
               8 * eps * 500 * steps);
    BOOST_TEST(distance(r.state.v, start.v + dt * g) < 8 * eps * 100 * steps);
  }
}

BOOST_AUTO_TEST_CASE(a_free_pair_falls_with_its_centre_and_swings_about_it) {
  // The relative coordinate has w^2 = k (1/m1 + 1/m2) = 100. The centre's w^2 = 0 may become some
  // eps 100 by rounding, which bends its parabola of 30 m by that times t^2.
  Problem p{{.dimension = 1, .gravity = {2, 0, 0}, .node_mass = Vec{{1, 3}}}, {}};
  p.network.links = {{0, 1, {75}}};
  p.initial = {0, Vec{{-1, 2}}, Vec{{4, -2}}};
  const double t = 5;
  for (const double h : {0.05, 1.0, 1e3}) {
    const State s = run_exact(p, t, h).state;
    const double centre = 1.25 - 0.5 * t + t * t;
    const double apart = 3 * std::cos(10 * t) - 0.6 * std::sin(10 * t);
    const double tolerance = 10 * eps * 100 * t * t * 30;
    BOOST_TEST(std::abs((s.q[0] + 3 * s.q[1]) / 4 - centre) < tolerance);
    BOOST_TEST(std::abs(s.q[1] - s.q[0] - apart) < tolerance);
  }
}

BOOST_AUTO_TEST_CASE(it_counts_one_force_a_step_and_one_eigenproblem_a_run) {
  const Problem p = linear_hammock(2);
  const auto system = make_mass_spring(p.network);
  const auto integrator = make_integrator(method, *system, {.step_size = 0.01});
  State end = p.initial;
  for (int repeat = 0; repeat < 2; ++repeat) {
    State state = p.initial;
    const Summary summary = integrator->advance(state, 0.374, {{0.1, 0.2}, [](const State&) {}});
    BOOST_TEST(summary.counts == (Counts{.steps = 38,
                                         .force_evaluations = 38,
                                         .stiffness_evaluations = 1,
                                         .factorizations = 1}));
    BOOST_TEST(state.t == 0.374);
    if (repeat > 0) BOOST_TEST(same(state, end));
    end = state;
  }
}

BOOST_AUTO_TEST_SUITE_END()
