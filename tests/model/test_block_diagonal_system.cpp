#include <limits>
#include <random>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/model/mass_spring.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(block_diagonal_system)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

using Parts = std::vector<std::unique_ptr<System>>;

template <class... Networks>
BlockDiagonalSystem in_parts(const Networks&... networks) {
  Parts parts;
  (parts.push_back(make_mass_spring(networks)), ...);
  return BlockDiagonalSystem(std::move(parts));
}

// The values of all functions of a system at a point.
struct Said {
  Said(const System& system, const Vec& q)
      : v(system.potential(q)), f(force_at(system, q)), k(dense(stiffness_at(system, q))) {}
  double v;
  Vec f;
  Eigen::MatrixXd k;
};

// Three random problems of one dimension, of 5, 1 and 4 nodes, and all of them as one network.
struct Three {
  explicit Three(int dimension) {
    std::mt19937 random(static_cast<unsigned>(dimension));
    int nodes = 0;
    for (const int count : {5, 1, 4}) {
      parts.push_back(random_network(random, dimension, count, 1.2));
      parts.back().network.gravity = {1, -2, 9};
      parts.back().network.constant_energy = count;
      nodes += count;
    }
    whole.network.dimension = dimension;
    whole.network.gravity = {1, -2, 9};
    whole.network.node_mass.resize(nodes);
    whole.initial.q.resize(dimension * nodes);
    int first = 0;
    for (const Problem& part : parts) {
      const auto count = static_cast<int>(part.network.node_mass.size());
      whole.network.node_mass.segment(first, count) = part.network.node_mass;
      whole.initial.q.segment(dimension * first, dimension * count) = part.initial.q;
      for (auto link : part.network.links) {
        whole.network.links.push_back({link.i + first, link.j + first, link.law});
      }
      for (auto anchor : part.network.anchors) {
        anchor.i += first;
        whole.network.anchors.push_back(anchor);
      }
      whole.network.constant_energy += part.network.constant_energy;
      first += count;
    }
  }
  BlockDiagonalSystem as_parts() const {
    return in_parts(parts[0].network, parts[1].network, parts[2].network);
  }

  std::vector<Problem> parts;
  Problem whole;
};

Network loose(int dimension, const SpringLaw& law, Holds holds = Holds::always) {
  Network network{.dimension = dimension, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {0, 0, 0}, law, holds}};
  return network;
}

}  // namespace

BOOST_AUTO_TEST_CASE(parts_are_together_what_they_are_as_one_network) {
  for (const int dimension : {1, 2, 3}) {
    const Three three(dimension);
    const BlockDiagonalSystem system = three.as_parts();
    const auto one = make_mass_spring(three.whole.network);
    const Vec& q = three.whole.initial.q;
    const Said a(system, q), b(*one, q);
    BOOST_TEST((system.mass() == one->mass()));
    // Some 40 terms, summed in another order.
    BOOST_TEST(std::abs(a.v - b.v) < 40 * eps * (std::abs(b.v) + 1000));
    BOOST_TEST((a.f == b.f));
    BOOST_TEST((a.k == b.k));
  }
}

BOOST_AUTO_TEST_CASE(the_pattern_is_that_of_one_network_entry_by_entry) {
  for (const int dimension : {1, 2, 3}) {
    const Three three(dimension);
    const BlockDiagonalSystem system = three.as_parts();
    const auto one = make_mass_spring(three.whole.network);
    const SymmetricMatrix &a = system.stiffness_pattern(), &b = one->stiffness_pattern();
    BOOST_TEST_REQUIRE(a.nonZeros() == b.nonZeros());
    BOOST_TEST(a.isCompressed());
    BOOST_TEST(std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1, b.outerIndexPtr()));
    BOOST_TEST(std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr()));
    BOOST_TEST(a.coeffs().abs().maxCoeff() == 0);
  }
}

BOOST_AUTO_TEST_CASE(parts_of_other_dimensions_follow_one_another_as_blocks) {
  std::mt19937 random(5);
  const Problem line = random_network(random, 1, 4, 1.3), space = random_network(random, 3, 3, 0.8);
  const BlockDiagonalSystem system = in_parts(line.network, space.network);
  const auto a = make_mass_spring(line.network), b = make_mass_spring(space.network);
  Vec q(13);
  q << line.initial.q, space.initial.q;
  const Said both(system, q), first(*a, line.initial.q), second(*b, space.initial.q);
  BOOST_TEST(system.size() == 13);
  BOOST_TEST(system.blocks().size() == 2);
  BOOST_TEST((system.mass().head(4) == a->mass() && system.mass().tail(9) == b->mass()));
  BOOST_TEST(both.v == first.v + second.v);
  BOOST_TEST((both.f.head(4) == first.f && both.f.tail(9) == second.f));
  BOOST_TEST((both.k.topLeftCorner(4, 4) == first.k));
  BOOST_TEST((both.k.bottomRightCorner(9, 9) == second.k));
  BOOST_TEST(both.k.bottomLeftCorner(9, 4).cwiseAbs().maxCoeff() == 0);
}

BOOST_AUTO_TEST_CASE(one_part_does_not_feel_where_another_is) {
  const Three three(2);
  const BlockDiagonalSystem system = three.as_parts();
  Vec q = three.whole.initial.q;
  const Said before(system, q);
  q.segment(10, 2) += Vec{{0.25, 0.5}};  // of the second
  const Said after(system, q);
  BOOST_TEST((after.f.head(10) == before.f.head(10) && after.f.tail(8) == before.f.tail(8)));
  BOOST_TEST(distance(after.f, before.f) > 1);
  Eigen::MatrixXd change = after.k - before.k;
  BOOST_TEST(change.cwiseAbs().maxCoeff() > 1);
  change.block(10, 10, 2, 2).setZero();
  BOOST_TEST(change.cwiseAbs().maxCoeff() == 0);
}

BOOST_AUTO_TEST_CASE(stiffness_does_not_depend_on_what_the_matrix_held) {
  const Three three(3);
  const BlockDiagonalSystem system = three.as_parts();
  const Vec& q = three.whole.initial.q;
  SymmetricMatrix used = stiffness_at(system, 1.5 * q);
  system.stiffness(q, used);
  BOOST_TEST(distance(dense(used), dense(stiffness_at(system, q))) == 0);
}

BOOST_AUTO_TEST_CASE(stiffness_is_constant_where_it_is_in_every_part) {
  const Network constant = loose(2, {.stiffness = 2}), varying = loose(2, {2, 1});
  BOOST_TEST(in_parts(constant, constant).stiffness_is_constant());
  BOOST_TEST(!in_parts(constant, varying).stiffness_is_constant());
  BOOST_TEST(!in_parts(varying, constant).stiffness_is_constant());
  BOOST_TEST(!in_parts(varying, varying).stiffness_is_constant());
}

BOOST_AUTO_TEST_CASE(it_holds_where_every_part_holds) {
  const Network string = loose(1, {1, 1}, Holds::in_tension);
  const BlockDiagonalSystem system = in_parts(string, loose(1, {1, 1}), string);
  BOOST_TEST(is_valid_at(system, Vec{{1.5, 0.1, 1.5}}));
  BOOST_TEST(!is_valid_at(system, Vec{{0.5, 3, 1.5}}));
  BOOST_TEST(!is_valid_at(system, Vec{{1.5, 3, 0.5}}));
}

BOOST_AUTO_TEST_CASE(parts_without_unknowns_and_parts_of_parts_change_nothing) {
  const Three three(2);
  const Network nothing{.dimension = 3, .constant_energy = 64};
  Parts inner, outer;
  inner.push_back(make_mass_spring(three.parts[0].network));
  inner.push_back(make_mass_spring(nothing));
  inner.push_back(make_mass_spring(three.parts[1].network));
  outer.push_back(std::make_unique<BlockDiagonalSystem>(Parts()));
  outer.push_back(std::make_unique<BlockDiagonalSystem>(std::move(inner)));
  outer.push_back(make_mass_spring(three.parts[2].network));
  const BlockDiagonalSystem nested(std::move(outer)), flat = three.as_parts();
  const Vec& q = three.whole.initial.q;
  const Said a(nested, q), b(flat, q);
  BOOST_TEST(nested.blocks().size() == 3);
  BOOST_TEST(std::abs(a.v - b.v - 64) < 40 * eps * (std::abs(b.v) + 1000));
  BOOST_TEST((a.f == b.f));
  BOOST_TEST((a.k == b.k));
}

BOOST_AUTO_TEST_CASE(no_parts_are_a_system_without_unknowns) {
  const BlockDiagonalSystem system{Parts()};
  BOOST_TEST(system.size() == 0);
  BOOST_TEST(system.blocks().empty());
  BOOST_TEST(system.potential(Vec()) == 0);
  BOOST_TEST(force_at(system, Vec()).size() == 0);
  BOOST_TEST(stiffness_at(system, Vec()).size() == 0);
  BOOST_TEST(system.stiffness_is_constant());
  BOOST_TEST(is_valid_at(system, Vec()));
}

BOOST_AUTO_TEST_SUITE_END()
