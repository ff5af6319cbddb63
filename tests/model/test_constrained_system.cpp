#include <limits>
#include <random>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/model/constrained_system.hpp"
#include "qddot/model/mass_spring.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(constrained_system)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

std::vector<bool> random_choice(std::mt19937& random, Index n) {
  std::vector<bool> is_held(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < is_held.size(); ++i) is_held[i] = random() % 3 == 0;
  return is_held;
}

template <class Check>
void for_random_networks(const Check& check) {
  std::mt19937 random(21);
  for (const int dimension : {1, 2, 3}) {
    for (int sample = 0; sample < 4; ++sample) {
      const Problem p = random_network(random, dimension, 6, 1.2);
      check(p, random_choice(random, p.initial.q.size()));
    }
  }
}

// A diagonal of ones and, where held, zeros.
Eigen::MatrixXd selection(const std::vector<bool>& is_held) {
  Vec free(std::ssize(is_held));
  for (std::size_t i = 0; i < is_held.size(); ++i) free[static_cast<Index>(i)] = !is_held[i];
  return free.asDiagonal();
}

}  // namespace

BOOST_AUTO_TEST_CASE(force_and_stiffness_are_those_of_the_system_with_zeros_where_it_is_held) {
  for_random_networks([](const Problem& p, const std::vector<bool>& is_held) {
    const auto free = make_mass_spring(p.network);
    const ConstrainedSystem held(make_mass_spring(p.network), is_held);
    const Eigen::MatrixXd s = selection(is_held);
    const Vec& q = p.initial.q;
    const Eigen::MatrixXd k = dense(stiffness_at(*free, q));
    BOOST_TEST((held.mass() == free->mass()));
    BOOST_TEST(held.potential(q) == free->potential(q));
    BOOST_TEST((force_at(held, q) == s * force_at(*free, q)));
    BOOST_TEST((dense(stiffness_at(held, q)) == s * k * s));
    SymmetricMatrix used = stiffness_at(*free, 1.5 * q);
    held.stiffness(q, used);
    BOOST_TEST((dense(used) == s * k * s));
  });
}

BOOST_AUTO_TEST_CASE(the_pattern_stays_with_its_diagonal) {
  for_random_networks([](const Problem& p, const std::vector<bool>& is_held) {
    const auto free = make_mass_spring(p.network);
    const ConstrainedSystem held(make_mass_spring(p.network), is_held);
    const SymmetricMatrix &a = held.stiffness_pattern(), &b = free->stiffness_pattern();
    BOOST_TEST_REQUIRE(a.nonZeros() == b.nonZeros());
    BOOST_TEST(std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr()));
  });
}

BOOST_AUTO_TEST_CASE(with_nothing_held_it_is_the_system_and_with_all_of_it_nothing_moves) {
  for_random_networks([](const Problem& p, const std::vector<bool>& is_held) {
    const auto free = make_mass_spring(p.network);
    const ConstrainedSystem none(make_mass_spring(p.network),
                                 std::vector<bool>(is_held.size(), false));
    const ConstrainedSystem all(make_mass_spring(p.network),
                                std::vector<bool>(is_held.size(), true));
    const Vec& q = p.initial.q;
    BOOST_TEST((force_at(none, q) == force_at(*free, q)));
    BOOST_TEST((dense(stiffness_at(none, q)) == dense(stiffness_at(*free, q))));
    BOOST_TEST(force_at(all, q).cwiseAbs().maxCoeff() == 0);
    BOOST_TEST(dense(stiffness_at(all, q)).cwiseAbs().maxCoeff() == 0);
  });
}

BOOST_AUTO_TEST_CASE(what_is_free_feels_held_nodes_as_points) {
  for_random_networks([](const Problem& p, const std::vector<bool>&) {
    // The first node held: in its place, anchors for the links to it.
    const int dimension = p.network.dimension;
    const auto point = in_space(p.initial.q.head(dimension));
    Network rest = p.network;
    rest.node_mass = p.network.node_mass.tail(5);
    rest.links.clear();
    rest.anchors.clear();
    for (const auto& [i, j, law, holds, stiff, offset] : p.network.links) {
      if (std::min(i, j) > 0) {
        rest.links.push_back({i - 1, j - 1, law, holds});
      } else {
        rest.anchors.push_back({std::max(i, j) - 1, point, law, holds});
      }
    }
    for (const auto& [i, place, law, holds, stiff, offset] : p.network.anchors) {
      if (i > 0) rest.anchors.push_back({i - 1, place, law, holds});
    }
    std::vector<bool> is_held(p.initial.q.size(), false);
    std::fill_n(is_held.begin(), dimension, true);
    const ConstrainedSystem held(make_mass_spring(p.network), is_held);
    const auto pinned = make_mass_spring(rest);
    const Index n = 5 * dimension;
    const Vec &q = p.initial.q, few = q.tail(n);
    // Some 20 springs of 1e3 N and N/m, summed in another order.
    BOOST_TEST(distance(force_at(held, q).tail(n), force_at(*pinned, few)) < 20 * eps * 1e3);
    BOOST_TEST(distance(dense(stiffness_at(held, q)).bottomRightCorner(n, n),
                        dense(stiffness_at(*pinned, few))) < 20 * eps * 1e3);
    rest.anchors.front().point[0] += 1e-9;  // noticed
    BOOST_TEST(distance(force_at(held, q).tail(n), force_at(*make_mass_spring(rest), few)) >
               20 * eps * 1e3);
  });
}

BOOST_AUTO_TEST_CASE(whether_stiffness_is_constant_and_the_system_holds_is_up_to_the_system) {
  const auto held = [](const SpringLaw& law, Holds holds = Holds::always) {
    Network network{.dimension = 1, .node_mass = Vec::Ones(2), .links = {{0, 1, law, holds}}};
    return ConstrainedSystem(make_mass_spring(network), {true, false});
  };
  BOOST_TEST(held({.stiffness = 1}).stiffness_is_constant());
  BOOST_TEST(!held({1, 1}).stiffness_is_constant());
  const ConstrainedSystem string = held({1, 1}, Holds::in_tension);
  BOOST_TEST(is_valid_at(string, Vec{{0, 1.5}}));
  BOOST_TEST(!is_valid_at(string, Vec{{0, 0.5}}));
}

BOOST_AUTO_TEST_SUITE_END()
