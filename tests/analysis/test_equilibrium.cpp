#include <boost/test/unit_test.hpp>

#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/equilibrium.hpp"
#include "qddot/analysis/stability.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(equilibrium)

using namespace qddot;

namespace {

using Outcome = Equilibrium::Outcome;

// Checks that the equilibrium is a minimum: no force, up to the rounding of its coordinates, and an
// energy that falls in no direction. The curvature may be negative by rounding, 1e-11 of the row
// sum.
void check_minimum(const System& system, const Equilibrium& e, double length) {
  BOOST_TEST((e.outcome == Outcome::reached), e.message);
  BOOST_TEST(e.message == "");
  BOOST_TEST_REQUIRE(e.q.allFinite());
  const double row_sum = largest_row_sum(stiffness_at(system, e.q));
  const Vec f = force_at(system, e.q);
  BOOST_TEST(f.lpNorm<Eigen::Infinity>() == e.residual);
  BOOST_TEST(e.residual <= 8 * eps * row_sum * std::max(e.q.lpNorm<Eigen::Infinity>(), length));
  const CurvatureSigns signs = qddot::curvature_signs(system, e.q);
  BOOST_TEST(signs.negative == 0);
  BOOST_TEST(e.smallest_eigenvalue >= -1e-11 * row_sum);
  // The value at the place before the last Newton steps differs by rounding only.
  const double smallest = smallest_curvature(system, e.q).value;
  BOOST_TEST(std::abs(e.smallest_eigenvalue - smallest) < 1e-9 * row_sum);
  BOOST_TEST(e.isolated == (signs.flat == 0));
  BOOST_TEST(e.flat_directions == signs.flat);
  if (e.smallest_eigenvalue > 1e-11 * row_sum) BOOST_TEST(e.isolated);
}

// The distance of a coordinate from the exact minimum: the remaining force over the stiffness.
double position_tolerance(const Equilibrium& e) {
  return 100 * e.residual / e.smallest_eigenvalue + 100 * eps;
}

Model drawn(const std::string& name, const GeneratorValues& values) {
  return Model(draw(name, values), Reductions::all_directions());
}

// Nodes on a line along x between two pins that stand closer than the springs are long.
Problem strut(int dimension, int nodes, double gravity) {
  Problem p{row_of_masses(dimension, nodes, 0.1, {.stiffness = 50, .rest_length = 1.1}), {}};
  p.network.gravity[dimension - 1] = -gravity;
  p.initial.q = Vec::Zero(dimension * nodes);
  for (int i = 0; i < nodes; ++i) p.initial.q[dimension * i] = i + 1;
  return p;
}

}  // namespace

BOOST_AUTO_TEST_CASE(one_mass_hangs_where_its_weight_says) {
  const auto system = make_mass_spring({.dimension = 1,
                                        .gravity = {-9.81, 0, 0},
                                        .node_mass = Vec::Constant(1, 2),
                                        .anchors = {{0, {0, 0, 0}, {.stiffness = 50}}}});
  const Equilibrium e = find_equilibrium(*system, Vec::Constant(1, 3), 1);
  check_minimum(*system, e, 1);
  BOOST_TEST(std::abs(e.q[0] + 2 * 9.81 / 50) < 4 * eps);
  BOOST_TEST(std::abs(e.smallest_eigenvalue - 50) < 50 * 4 * eps);
  BOOST_TEST(e.isolated);
}

BOOST_AUTO_TEST_CASE(hanging_chain_is_stretched_by_the_weight_below_each_spring) {
  // The chain starts horizontal, soft or stiff, with 1 kg in all on 1 m.
  for (const double stiffness : {30.0, 1e3, 1e6}) {
    const int nodes = 30;
    const auto scene = drawn("chain", {{"nodes", nodes}, {"stiffness", stiffness}});
    const Equilibrium e = find_equilibrium(scene.system(), scene.initial().q, 1);
    check_minimum(scene.system(), e, 1);
    double z = 0;
    for (int i = 0; i + 1 < nodes; ++i) {
      const double weight = 9.81 * (nodes - 1 - i) / nodes;
      z -= 1.0 / (nodes - 1) + weight / stiffness;
      const Eigen::Vector3d expected(0, 0, z);
      BOOST_TEST(distance(e.q.segment<3>(3 * i), expected) < position_tolerance(e));
    }
    BOOST_TEST(position_tolerance(e) < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(straight_strut_buckles_although_it_starts_in_balance) {
  for (const int dimension : {2, 3}) {
    for (const int nodes : {1, 2, 9}) {
      for (const double gravity : {0.0, 9.81}) {
        const auto [network, initial] = strut(dimension, nodes, gravity);
        const auto system = make_mass_spring(network);
        if (gravity == 0) {
          BOOST_TEST(force_at(*system, initial.q).norm() < 1e-12);  // rounding of 5 N
          BOOST_TEST(smallest_curvature(*system, initial.q).value < -1);
        }
        const Equilibrium e = find_equilibrium(*system, initial.q, nodes + 1.0);
        check_minimum(*system, e, nodes + 1.0);
        BOOST_TEST(system->potential(e.q) < system->potential(initial.q));
        const auto across = e.q.reshaped(dimension, nodes).bottomRows(dimension - 1);
        BOOST_TEST(across.cwiseAbs().maxCoeff() > 0.1);
        if (gravity > 0) BOOST_TEST(across.bottomRows(1).maxCoeff() < 0);  // it hangs
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(upright_pendulum_ends_hanging) {
  const double m = 2, g = 9.81, k = 500, l0 = 0.7;
  for (const int dimension : {2, 3}) {
    Network network{.dimension = dimension, .node_mass = Vec::Constant(1, m)};
    network.gravity[dimension - 1] = -g;
    network.anchors = {{0, {0, 0, 0}, {k, l0}}};
    const auto system = make_mass_spring(network);
    Vec down = Vec::Zero(dimension);
    down[dimension - 1] = -(l0 + m * g / k);
    // The mass starts in exact balance on its compressed spring, and above and below that.
    for (const double height : {l0 - m * g / k, l0, 0.3, 2.0}) {
      Vec up = Vec::Zero(dimension);
      up[dimension - 1] = height;
      const Equilibrium e = find_equilibrium(*system, up, 1);
      check_minimum(*system, e, 1);
      BOOST_TEST(distance(e.q, down) < position_tolerance(e));
      BOOST_TEST(e.isolated);
    }
  }
}

BOOST_AUTO_TEST_CASE(saddle_is_left_to_the_lower_side) {
  // A node in balance between two compressed springs along x. A third spring pushes from below and
  // cancels its weight; its energy 1/4 c (y - 0.3)^4 is steeper downwards.
  const SpringLaw beside{.stiffness = 100, .rest_length = 1.1};
  const SpringLaw below{.stiffness = 5, .rest_length = 1.3, .quartic = 20};
  for (const double turn : {1.0, -1.0}) {
    const auto system = make_mass_spring(
        {.dimension = 2,
         .gravity = {0, turn * below.tension(1.0), 0},
         .node_mass = Vec::Ones(1),
         .anchors = {{0, {-1, 0, 0}, beside}, {0, {1, 0, 0}, beside}, {0, {0, -turn, 0}, below}}});
    const Vec start = Vec::Zero(2);
    BOOST_TEST(force_at(*system, start).norm() < 1e-14);
    BOOST_TEST(smallest_curvature(*system, start).value < -1);
    const Equilibrium e = find_equilibrium(*system, start, 1);
    check_minimum(*system, e, 1);
    BOOST_TEST(turn * e.q[1] > 0.1);
  }
}

BOOST_AUTO_TEST_CASE(what_nothing_holds_falls_for_ever) {
  const auto free_chain = drawn("chain", {{"nodes", 30}, {"pinned_ends", 0}});
  // A cloth with one node that hangs on nothing.
  Scene torn = draw("cloth", {{"nodes", 8}});
  std::erase_if(torn.springs, [](const Spring& s) { return s.nodes[0] == 20 || s.nodes[1] == 20; });
  const Model torn_cloth(torn, Reductions::all_directions());
  for (const Model* scene : {&free_chain, &torn_cloth}) {
    const Equilibrium e = find_equilibrium(scene->system(), scene->initial().q, 1);
    BOOST_TEST((e.outcome == Outcome::unbounded));
    BOOST_TEST(e.message.find("falls for ever") != e.message.npos);
    BOOST_TEST(e.q.allFinite());
    BOOST_TEST(e.residual > 1e-4);  // some weight
    BOOST_TEST(e.iterations < 500);
  }
}

BOOST_AUTO_TEST_CASE(slack_cloth_comes_to_rest) {
  for (const double nodes : {6, 13, 20}) {
    const auto scene = drawn("cloth", {{"nodes", nodes}});
    const Equilibrium e = find_equilibrium(scene.system(), scene.initial().q, 1.5);
    check_minimum(scene.system(), e, 1.5);
    // The force that is left against the weight of a node.
    BOOST_TEST(e.residual < 1e-9 * 0.5 * 9.81 / (nodes * nodes));
    BOOST_TEST(e.iterations < 300);
  }
}

BOOST_AUTO_TEST_CASE(random_networks_come_to_rest_however_they_start) {
  std::mt19937 random(3);
  for (const double stretch : {1.3, 0.9, 0.5}) {
    for (const int dimension : {1, 2, 3}) {
      for (const int nodes : {1, 3, 10, 40}) {
        Problem p = random_network(random, dimension, nodes, stretch);
        for (const bool with_massless : {false, true}) {
          for (int i = 0; with_massless && i < nodes; i += 2) p.network.node_mass[i] = 0;
          const auto system = make_mass_spring(p.network);
          const Equilibrium e = find_equilibrium(*system, p.initial.q, nodes + 1.0);
          check_minimum(*system, e, nodes + 1.0);
          BOOST_TEST(system->potential(e.q) <= system->potential(p.initial.q));
        }
      }
    }
  }
}

// Networks that lie in a line or a plane of space, with springs longer and shorter than they are
// drawn: balance in the line or plane is a saddle. Hubs in regular polygons are symmetric, too, and
// have equal curvatures.
BOOST_AUTO_TEST_CASE(random_symmetric_and_prestressed_networks_end_in_minima) {
  std::mt19937 random(15);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto spring = [&](const Vec& a, const Vec& b) {
    return SpringLaw{std::pow(10, uniform(1, 3)), (a - b).norm() * uniform(0.4, 1.6)};
  };
  int count = 0, falls = 0;
  for (const int dimension : {1, 2, 3}) {
    for (int drawn_in = 1; drawn_in <= dimension; ++drawn_in) {
      for (int i = 0; i < 50; ++i, ++count) {
        const bool is_polygon = i % 3 == 0 && drawn_in == 2, is_held = i % 2 == 0;
        const int nodes = 3 + i % 9;
        Network network{.dimension = dimension, .node_mass = Vec(nodes)};
        Eigen::MatrixXd x = Eigen::MatrixXd::Zero(dimension, nodes);
        for (int a = 0; a < nodes; ++a) {
          network.node_mass[a] = std::pow(10, uniform(-1.5, 0.5));
          for (int d = 0; d < drawn_in; ++d) x(d, a) = uniform(-3, 3);
          const double angle = 2 * M_PI * a / (nodes - 1);
          if (is_polygon && a > 0) x.col(a).head(2) << std::cos(angle), std::sin(angle);
        }
        if (is_polygon) x.col(0).setZero();
        const SpringLaw spoke{100, uniform(0.3, 1.8)}, side{100, uniform(0.3, 1.8)};
        for (int a = 0; a < nodes; ++a) {
          for (int b = a + 1; b < nodes; ++b) {
            if (is_polygon && (a == 0 || b == a + 1 || (a == 1 && b == nodes - 1))) {
              network.links.push_back({a, b, a == 0 ? spoke : side});
            } else if (!is_polygon && (b == a + 1 || uniform(0, 1) < 0.6)) {
              network.links.push_back({a, b, spring(x.col(a), x.col(b))});
            }
          }
        }
        for (int a = 0; is_held && !is_polygon && a < nodes; a += 3) {
          Vec pin = Vec::Zero(dimension);
          for (int d = 0; d < drawn_in; ++d) pin[d] = uniform(-3, 3);
          network.anchors.push_back({a, in_space(pin), spring(x.col(a), pin)});
        }
        const auto system = make_mass_spring(network);
        const Vec start = x.reshaped();
        const Equilibrium e = find_equilibrium(*system, start, 6);
        BOOST_TEST_CONTEXT(dimension << "D, drawn in " << drawn_in << ", number " << i) {
          BOOST_TEST((e.outcome == Outcome::reached), e.message);
          const Eigen::MatrixXd k = dense(stiffness_at(*system, e.q));
          // A force of 8 eps of the row sum times 6 m, the rounding of q, on springs of 1 cm and
          // more is a curvature of 1e-12 of the row sum.
          BOOST_TEST(smallest_eigenvalue(-k) >= -1e-11 * k.cwiseAbs().rowwise().sum().maxCoeff());
          BOOST_TEST(system->potential(e.q) <= system->potential(start));
          const Eigen::MatrixXd moved = (e.q - start).reshaped(dimension, nodes);
          falls += moved.bottomRows(dimension - drawn_in).norm() > 1e-3;
        }
      }
    }
  }
  BOOST_TEST(count == 300);
  BOOST_TEST(falls > 50);  // out of the line or plane: their saddles were left
}

// A block pushed to 0.4 of its size falls into one of many minima. Steps are bounded in length, and
// the bound has to turn with the block, or some blocks fall into another minimum.
BOOST_AUTO_TEST_CASE(rest_does_not_depend_on_directions_and_numbers) {
  const auto moved = [](const Scene& s) {
    return renumbered(turned(s, some_rotation(), {1, 2, 3}),
                      {7, 2, 0, 11, 5, 9, 3, 1, 10, 4, 8, 6});
  };
  const auto at_rest = [](Scene s) {
    const Model reduced(s, Reductions::all_directions());
    const Equilibrium e = find_equilibrium(reduced.system(), reduced.initial().q, 1);
    check_minimum(reduced.system(), e, 1);
    BOOST_TEST(position_tolerance(e) < 1e-10);
    s.nodes = reduced.expand({0, e.q, Vec::Zero(e.q.size())});
    return s;
  };
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Scene scene = stretched(draw("lattice", {{"nodes_x", 3}, {"nodes_y", 2}, {"nodes_z", 2}}), 0.4);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    for (Node& node : scene.nodes) {
      for (double& x : node.position) x += uniform(random);
    }
    BOOST_TEST(farthest(at_rest(moved(scene)).nodes, moved(at_rest(scene)).nodes) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(loose_ends_are_no_obstacle_and_are_told) {
  // A free pair ends at its rest length somewhere, in some direction.
  const auto pair = drawn("pair", {{"stretch", 1.4}, {"rest_length", 0.8}});
  const Equilibrium e = find_equilibrium(pair.system(), pair.initial().q, 1);
  check_minimum(pair.system(), e, 1);
  BOOST_TEST(std::abs((e.q.tail<3>() - e.q.head<3>()).norm() - 0.8) < 8 * eps);
  BOOST_TEST(!e.isolated);
  // Masses that nothing pulls stay where they are.
  const auto nothing = make_mass_spring({.dimension = 2, .node_mass = Vec::Ones(2)});
  const Vec anywhere{{1, 2, 3, 4}};
  const Equilibrium still = find_equilibrium(*nothing, anywhere, 1);
  BOOST_TEST((still.outcome == Outcome::reached));
  BOOST_TEST((still.q == anywhere));
  BOOST_TEST(still.iterations == 0);
  BOOST_TEST(!still.isolated);
}

BOOST_AUTO_TEST_CASE(rest_is_found_again_at_once) {
  const auto scene = drawn("cloth", {{"nodes", 12}});
  const Equilibrium e = find_equilibrium(scene.system(), scene.initial().q, 1.5);
  const Equilibrium again = find_equilibrium(scene.system(), e.q, 1.5);
  BOOST_TEST(again.iterations == 0);
  BOOST_TEST(distance(again.q, e.q) < position_tolerance(e));
}

BOOST_AUTO_TEST_CASE(forces_that_overflow_end_the_search) {
  const auto system = make_mass_spring(
      {.dimension = 1, .node_mass = Vec::Ones(1), .anchors = {{0, {0, 0, 0}, {.quartic = 1e300}}}});
  const Equilibrium e = find_equilibrium(*system, Vec::Constant(1, 1e10), 1e10);
  BOOST_TEST((e.outcome == Outcome::not_converged));
  BOOST_TEST(e.message.find("overflow") != e.message.npos);
}

BOOST_AUTO_TEST_CASE(no_unknowns_rest) {
  const Equilibrium e = find_equilibrium(*make_mass_spring({.dimension = 3}), Vec(), 1);
  BOOST_TEST((e.outcome == Outcome::reached));
  BOOST_TEST(e.q.size() == 0);
  BOOST_TEST(e.residual == 0);
}

BOOST_AUTO_TEST_SUITE_END()
