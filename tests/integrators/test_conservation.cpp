#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(conservation)

using namespace qddot;

namespace {

using boost::unit_test::data::make;
using Eigen::Vector3d;

constexpr double m1 = 1, m2 = 2, k = 100, l0 = 1, mu = m1 * m2 / (m1 + m2), t_end = 2;
const double w = std::sqrt(k / mu);

// A free pair with its centre of mass, at the origin at first, adrift.
Scene drifting_pair(double stretch, double spin, const Vector3d& drift) {
  Scene scene = generate(*find_generator("pair"), {{"stretch", stretch}, {"spin", spin}}, "pair");
  for (Node& node : scene.nodes) node.velocity += drift;
  return scene;
}

// The centre of mass and the difference of both positions after a run of order 8 to t_end.
struct Pair {
  Vector3d centre, apart;
};
Pair pair_after(const Scene& scene, const Reductions& reductions) {
  const auto nodes = nodes_after(scene, reductions, method_named("kahan_li8"), 0.002, t_end);
  const Vector3d &x1 = nodes[0].position, &x2 = nodes[1].position;
  return {(m1 * x1 + m2 * x2) / (m1 + m2), x2 - x1};
}
// Order 8 at h w = 0.025 errs by 1e-13 and less; 1000 steps of 17 substeps round coordinates of up
// to 10 m.
constexpr double tolerance = 1e-11;

// Two random bodies and a node on no spring, far from each other.
Scene free_bodies(int dimension, const Vector3d& gravity) {
  std::mt19937 random(static_cast<unsigned>(dimension));
  Scene scene{.dimension = dimension, .gravity = gravity};
  add_random_body(random, 7, {0, 0, 0}, scene);
  add_random_body(random, 5, {0, 20, 0}, scene);
  add_random_body(random, 1, {0, -20, 0}, scene);
  return scene;
}

struct Momenta {
  double mass = 0;
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
};
Momenta momenta(const std::vector<Node>& nodes) {
  Momenta sum;
  for (const Node& node : nodes) {
    sum.mass += node.mass;
    sum.linear += node.mass * node.velocity;
    sum.angular += node.position.cross(node.mass * node.velocity);
  }
  return sum;
}

// The change of the momenta in 200 steps of 1/100 s.
Momenta change(const Scene& scene, const Reductions& reductions, const Method& method) {
  const Momenta before = momenta(scene.nodes);
  const Momenta after = momenta(nodes_after(scene, reductions, method, 0.01, t_end));
  return {after.mass, after.linear - before.linear, after.angular - before.angular};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_free_pair_swings_at_its_frequency_about_a_centre_that_moves_uniformly) {
  const double length = l0 + 0.1 * std::cos(w * t_end);
  for (const Vector3d& drift : {Vector3d(0, 0, 0), Vector3d(2, 0, 0), Vector3d(1, -3, 2)}) {
    for (const Reductions& reductions : with_and_without) {
      const Pair pair = pair_after(drifting_pair(1.1, 0, drift), reductions);
      BOOST_TEST((pair.centre - t_end * drift).norm() < tolerance);
      BOOST_TEST((pair.apart - length * Vector3d::UnitX()).norm() < tolerance);
      const Pair other = pair_after(drifting_pair(1.1 + 1e-9, 0, drift), reductions);  // noticed
      BOOST_TEST((other.apart - length * Vector3d::UnitX()).norm() > tolerance);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_pair_on_a_line_is_solved_exactly) {
  const Model reduced(drifting_pair(1.1, 0, {2, 0, 0}));
  BOOST_TEST(reduced.system().stiffness_is_constant());
  const auto nodes = reduced.expand(state_after(reduced, method_named("exact"), t_end, t_end));
  const double apart = nodes[1].position.x() - nodes[0].position.x();
  // A phase of 24 rad, and coordinates of 5 m.
  BOOST_TEST(std::abs(apart - (l0 + 0.1 * std::cos(w * t_end))) < 1e-13);
}

BOOST_AUTO_TEST_CASE(a_pair_whose_spring_holds_it_on_a_circle_keeps_its_radius) {
  const double spin = 2;
  const double l = k * l0 / (k - mu * spin * spin);  // k (l - l0) = mu w^2 l
  const Vector3d drift(0.5, 1, -1);
  const Vector3d apart = l * Vector3d(std::cos(spin * t_end), std::sin(spin * t_end), 0);
  for (const Reductions& reductions : with_and_without) {
    const Pair pair = pair_after(drifting_pair(l / l0, spin, drift), reductions);
    BOOST_TEST((pair.centre - t_end * drift).norm() < tolerance);
    BOOST_TEST((pair.apart - apart).norm() < tolerance);
    const Pair other =
        pair_after(drifting_pair(l / l0, spin + 1e-8, drift), reductions);  // noticed
    BOOST_TEST((other.apart - apart).norm() > tolerance);
  }
}

BOOST_DATA_TEST_CASE(momentum_changes_by_weight_alone_and_the_registry_says_where_spin_is_kept,
                     methods_of(Knob::step_size) * make({2, 3}), method, dimension) {
  for (const Vector3d& gravity : {Vector3d(0, 0, 0), Vector3d(1, -9.81, 0)}) {
    const Scene scene = free_bodies(dimension, gravity);
    for (const Reductions& reductions : with_and_without) {
      const Momenta changed = change(scene, reductions, method);
      // Each of 200 steps rounds p of up to 300 kg m/s in 13 nodes, and solves a few times more.
      BOOST_TEST((changed.linear - changed.mass * t_end * gravity).norm() < 1e-10);
      if (!gravity.isZero()) continue;
      const double lost = changed.angular.norm();
      // 200 steps round x p of up to 100 kg m^2/s; Newton's iteration of ARKODE leaves an error of
      // 1e-10 of it. Other methods have errors by their order, 1, 2 or 4.
      if (keeps_angular_momentum(method)) {
        BOOST_TEST(lost < (method.family == Family::sundials ? 1e-6 : 1e-10));
      } else if (method.order < 8) {  // whose error is rounding here
        BOOST_TEST(lost > (method.order == 1 ? 1e-3 : 1e-6));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_mass_let_go_on_its_spring_swings_about_where_it_would_hang) {
  const double mass = 1, spring = 1000, g = 9.81;
  const double period = 2 * M_PI * std::sqrt(mass / spring), sag = mass * g / spring;
  const Scene scene = generate(*find_generator("pendulum"), {{"angle", 0}, {"speed", 0}}, "test");
  for (const Reductions& reductions : with_and_without) {
    for (const double periods : {0.25, 0.5, 1.0, 3.0}) {
      const auto nodes =
          nodes_after(scene, reductions, method_named("kahan_li8"), period / 200, periods * period);
      const double z = -1 - sag + sag * std::cos(2 * M_PI * periods);
      // Order 8 at h w = 0.03 of a swing of 1 cm, and rounding of 600 steps on 1 m.
      BOOST_TEST((nodes[1].position - Vector3d(0, 0, z)).norm() < 1e-12);
    }
  }
}

BOOST_DATA_TEST_CASE(one_step_methods_run_backwards_to_their_start_where_the_registry_says_so,
                     methods_of(Knob::step_size), method) {
  if (method.is(Trait::remembers_steps)) return;
  const Problem p = hammock(3);
  const auto system = make_mass_spring(p.network);
  // 400 steps (of up to 17 substeps) on numbers of 10, each rounding by 1e-15, which the motion may
  // enlarge some ten times. Newton's iteration of ARKODE leaves 1e-10 a step. Others are off by
  // 1e-5 and more.
  // Splittings of high order that are not reversible come back nearly; at longer steps they miss as
  // clearly.
  const bool misses_little =
      method.is(Trait::symplectic) && !method.is(Trait::reversible) && method.order >= 4;
  const bool misses_least = !method.is(Trait::symplectic) && method.order >= 8;
  const Options options{.step_size = misses_least    ? 0.16
                                     : misses_little ? 0.08
                                                     : 0.02,
                        .solve_tolerance = 1e-13};
  State state = p.initial;
  for (int i = 0; i < 2; ++i) {
    state = run(method, *system, {0, state.q, state.v}, 4, options).state;
    state.v = -state.v;
  }
  const double missed = distance(state, p.initial);
  if (method.is(Trait::reversible)) {
    BOOST_TEST(missed < (method.family == Family::sundials ? 1e-6 : 1e-10));
  } else {
    BOOST_TEST(missed > (method.order == 1 ? 1e-3 : 1e-5));
  }
}

BOOST_AUTO_TEST_SUITE_END()
