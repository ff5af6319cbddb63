#include <algorithm>

#include <boost/test/unit_test.hpp>

#include "qddot/model/constrained_system.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(split)

using namespace qddot;

namespace {

// Networks of all kinds of springs, some of them stiff, with loads, and a point of each.
template <class Check>
void for_split_networks(const Check& check) {
  std::mt19937 random(5);
  const auto offer = [&](Network network, const Vec& q) {
    network.offers_split = true;
    for (const unsigned odds : {3u, 1u, 1000u}) {  // a third, all, hardly any
      for_springs(network, [&](auto& spring) { spring.stiff = random() % odds == 0; });
      check(network, q);
    }
  };
  for_networks({1.4, 0.7}, offer);
}

// The springs of one kind as a system of their own, which has no split.
std::unique_ptr<System> alone(Network network, bool stiff) {
  network.offers_split = false;
  if (stiff) {
    network.gravity.setZero();
    network.load.setZero();
    network.constant_energy = 0;
  }
  const auto is_other = [&](const auto& spring) { return spring.stiff != stiff; };
  std::erase_if(network.links, is_other);
  std::erase_if(network.image_links, is_other);
  std::erase_if(network.anchors, is_other);
  return make_mass_spring(network);
}

bool same_pattern(const System& a, const System& b) {
  return tests::same_pattern(a.stiffness_pattern(), b.stiffness_pattern());
}

// Whether f, K and V of the two add up to those of the whole. The tolerance is the rounding of some
// 60 springs of up to 1e5 J, N and N/m, summed in another order.
bool adds_up(const System& whole, const System& stiff, const System& soft, const Vec& q) {
  constexpr double rounding = 60 * eps * 1e5;
  const Eigen::MatrixXd k = dense(stiffness_at(stiff, q)) + dense(stiffness_at(soft, q));
  return stiff.mass() == whole.mass() && soft.mass() == whole.mass() &&
         std::abs(stiff.potential(q) + soft.potential(q) - whole.potential(q)) < rounding &&
         distance(force_at(stiff, q) + force_at(soft, q), force_at(whole, q)) < rounding &&
         distance(k, dense(stiffness_at(whole, q))) < rounding;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_is_the_network_of_its_springs_alone_with_the_pattern_of_these) {
  int fewer = 0, all = 0;
  for_split_networks([&](const Network& network, const Vec& q) {
    const auto whole = make_mass_spring(network);
    for (const bool stiff : {true, false}) {
      const System& half = stiff ? *whole->split()->stiff : *whole->split()->soft;
      const auto expected = alone(network, stiff);
      BOOST_TEST(same_pattern(half, *expected));
      BOOST_TEST(half.potential(q) == expected->potential(q));
      BOOST_TEST((force_at(half, q) == force_at(*expected, q)));
      BOOST_TEST((dense(stiffness_at(half, q)) == dense(stiffness_at(*expected, q))));
      BOOST_TEST(half.stiffness_is_constant() == expected->stiffness_is_constant());
      BOOST_TEST(!half.split());
    }
    fewer += !same_pattern(*whole->split()->stiff, *whole);
    ++all;
    // Nothing else changes.
    Network unsplit = network;
    unsplit.offers_split = false;
    const auto without = make_mass_spring(unsplit);
    BOOST_TEST(!without->split());
    BOOST_TEST(whole->potential(q) == without->potential(q));
    BOOST_TEST((force_at(*whole, q) == force_at(*without, q)));
    BOOST_TEST((dense(stiffness_at(*whole, q)) == dense(stiffness_at(*without, q))));
  });
  // A third of the springs seldom joins all that all of them join.
  BOOST_TEST(fewer > all / 2);
}

BOOST_AUTO_TEST_CASE(the_stiff_block_is_the_stiff_one_over_the_unknowns_that_it_acts_on) {
  int smaller = 0;
  for_split_networks([&](const Network& network, const Vec& q) {
    const auto whole = make_mass_spring(network);
    const auto& [stiff, soft, block, unknowns] = *whole->split();
    BOOST_TEST_REQUIRE(block->size() == std::ssize(unknowns));
    BOOST_TEST(std::ranges::is_sorted(unknowns));
    BOOST_TEST((block->mass() == whole->mass()(unknowns)));
    const Vec own = q(unknowns);
    BOOST_TEST((force_at(*block, own) == force_at(*stiff, q)(unknowns)));
    Vec elsewhere = force_at(*stiff, q);
    elsewhere(unknowns).setZero();
    BOOST_TEST((elsewhere.array() == 0).all());
    // Nor do the others move anything.
    Vec moved = Vec::Constant(q.size(), 5);
    moved(unknowns) = own;
    BOOST_TEST((force_at(*stiff, moved) == force_at(*stiff, q)));
    for (const auto& matrix : {stiffness_at, material_stiffness_at}) {
      const Eigen::MatrixXd k = dense(matrix(*stiff, q));
      BOOST_TEST((dense(matrix(*block, own)) == k(unknowns, unknowns)));
    }
    BOOST_TEST(std::abs(block->potential(own) - stiff->potential(q)) < 60 * eps * 1e5);
    smaller += block->size() < whole->size();
  });
  BOOST_TEST(smaller > 3);
}

BOOST_AUTO_TEST_CASE(each_says_of_its_own_springs_whether_k_is_constant_and_the_system_holds) {
  Network network{.dimension = 1, .node_mass = Vec::Ones(2)};
  network.anchors = {{0, {0, 0, 0}, {10, 1}, Holds::in_tension, true},
                     {1, {0, 0, 0}, {10, 0}, Holds::always, false},
                     {1, {0, 0, 0}, {10, 1}, Holds::in_tension, false}};
  network.offers_split = true;
  const auto whole = make_mass_spring(network);
  const Split& split = *whole->split();
  for (const auto& [q, stiff_holds, soft_holds] : {std::tuple(Vec{{1.5, 1.5}}, true, true),
                                                   {Vec{{0.5, 1.5}}, false, true},
                                                   {Vec{{1.5, 0.5}}, true, false}}) {
    BOOST_TEST(is_valid_at(*split.stiff, q) == stiff_holds);
    BOOST_TEST(is_valid_at(*split.soft, q) == soft_holds);
    BOOST_TEST(is_valid_at(*whole, q) == (stiff_holds && soft_holds));
  }
  network.anchors.pop_back();
  const auto soft_linear = make_mass_spring(network);
  BOOST_TEST(!soft_linear->stiffness_is_constant());
  BOOST_TEST(!soft_linear->split()->stiff->stiffness_is_constant());
  BOOST_TEST(soft_linear->split()->soft->stiffness_is_constant());
  network.uses_constant_stiffness = false;
  BOOST_TEST(!make_mass_spring(network)->split()->soft->stiffness_is_constant());
}

BOOST_AUTO_TEST_CASE(what_is_held_is_held_in_both) {
  std::mt19937 random(9);
  for_split_networks([&](Network network, const Vec& q) {
    std::vector<bool> is_held(static_cast<std::size_t>(q.size()));
    for (std::size_t i = 0; i < is_held.size(); ++i) is_held[i] = random() % 3 == 0;
    const ConstrainedSystem held(make_mass_spring(network), is_held);
    const Split* split = held.split();
    BOOST_TEST_REQUIRE(split);
    BOOST_TEST(adds_up(held, *split->stiff, *split->soft, q));
    const Vec stiff = force_at(*split->stiff, q), soft = force_at(*split->soft, q);
    for (std::size_t i = 0; i < is_held.size(); ++i) {
      if (is_held[i]) BOOST_TEST((stiff[Index(i)] == 0 && soft[Index(i)] == 0));
    }
    BOOST_TEST(same_pattern(*split->stiff, *alone(network, true)));
    const Vec own = q(split->stiff_unknowns);
    BOOST_TEST((force_at(*split->stiff_block, own) == stiff(split->stiff_unknowns)));
    network.offers_split = false;
    BOOST_TEST(!ConstrainedSystem(make_mass_spring(network), is_held).split());
  });
}

BOOST_AUTO_TEST_SUITE_END()
