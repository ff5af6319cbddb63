// Numbers grouped by counting, and springs merged by it, against plain maps.
#include <map>
#include <random>
#include <set>

#include <boost/test/unit_test.hpp>

#include "qddot/model/grouped.hpp"
#include "qddot/scene/reduce/springs.hpp"

BOOST_AUTO_TEST_SUITE(grouped)

using namespace qddot;
using namespace qddot::reduce;

namespace {

// Springs between few nodes with few laws, so that many of them may be merged.
std::vector<Spring> few_kinds(std::size_t count, std::size_t nodes, std::mt19937& random) {
  std::vector<Spring> springs;
  while (springs.size() < count) {
    const std::size_t a = random() % nodes, b = random() % nodes;
    if (a == b) continue;
    const double k = random() % 4, l0 = 1 + random() % 2, c = random() % 5 == 0 ? 2 : 0;
    springs.push_back({{a, b},
                       {k, l0, c},
                       random() % 3 == 0 ? Holds::in_tension : Holds::always,
                       random() % 4 == 0});
  }
  return springs;
}

// As merged_springs says, by a map from each key to the place of its sum.
std::vector<Spring> merged_by_map(const std::vector<Spring>& springs) {
  std::map<std::tuple<std::size_t, std::size_t, double, Holds>, std::size_t> places;
  std::vector<Spring> sums;
  for (const Spring& spring : springs) {
    const auto [low, high] = std::minmax(spring.nodes[0], spring.nodes[1]);
    const auto [place, is_new] =
        places.try_emplace({low, high, spring.law.rest_length, spring.holds}, sums.size());
    if (is_new) {
      sums.push_back(spring);
      continue;
    }
    Spring& sum = sums[place->second];
    sum.law.stiffness += spring.law.stiffness;
    sum.law.quartic += spring.law.quartic;
    sum.stiff = sum.stiff || spring.stiff;
  }
  std::erase_if(sums, [](const Spring& s) { return s.law.stiffness == 0 && s.law.quartic == 0; });
  return sums;
}

}  // namespace

BOOST_AUTO_TEST_CASE(groups_are_those_of_a_map_in_the_same_order) {
  std::mt19937 random(3);
  for (const int groups : {0, 1, 2, 7, 100}) {
    for (const int count : {0, 1, 10, 500}) {
      std::vector<int> group_of;
      std::map<int, std::vector<int>> expected;
      for (int k = 0; k < count; ++k) {
        group_of.push_back(static_cast<int>(random() % static_cast<unsigned>(groups + 1)) - 1);
        expected[group_of.back()].push_back(k);
      }
      const Grouped found(groups, count,
                          [&](int k) { return group_of[static_cast<std::size_t>(k)]; });
      BOOST_TEST(found.groups() == groups);
      for (int group = 0; group < groups; ++group) {
        const auto own = found[group];
        BOOST_TEST(std::vector(own.begin(), own.end()) == expected[group],
                   boost::test_tools::per_element());
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(springs_that_share_both_ends_are_found) {
  std::mt19937 random(4);
  int shared = 0;
  for (int draw = 0; draw < 300; ++draw) {
    const std::vector<Spring> springs = few_kinds(1 + random() % 12, 9, random);
    std::set<std::pair<std::size_t, std::size_t>> ends;
    for (const Spring& spring : springs) ends.insert(std::minmax(spring.nodes[0], spring.nodes[1]));
    const auto end = [&](int e, bool is_high) {
      const auto [low, high] = std::minmax(springs[static_cast<std::size_t>(e)].nodes[0],
                                           springs[static_cast<std::size_t>(e)].nodes[1]);
      return static_cast<int>(is_high ? high : low);
    };
    const Grouped by_low(9, static_cast<int>(springs.size()), [&](int e) { return end(e, false); });
    const bool found = any_share_both_ends(by_low, [&](int e) { return end(e, true); });
    BOOST_TEST(found == (ends.size() < springs.size()));
    shared += found;
  }
  BOOST_TEST((shared > 50 && shared < 250), shared);
}

BOOST_AUTO_TEST_CASE(springs_are_merged_as_by_a_map) {
  std::mt19937 random(5);
  int unchanged = 0;
  for (int draw = 0; draw < 300; ++draw) {
    const std::size_t nodes = draw % 2 ? 4 : 40;
    const std::vector<Spring> springs = few_kinds(1 + random() % 30, nodes, random),
                              expected = merged_by_map(springs);
    const auto merged = merged_springs(springs, nodes);
    unchanged += !merged;
    BOOST_TEST(merged.has_value() == (expected.size() < springs.size()));
    const std::vector<Spring>& found = merged ? *merged : springs;
    BOOST_TEST_REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      BOOST_TEST((found[i].nodes == expected[i].nodes));
      BOOST_TEST(found[i].law.stiffness == expected[i].law.stiffness);
      BOOST_TEST(found[i].law.rest_length == expected[i].law.rest_length);
      BOOST_TEST(found[i].law.quartic == expected[i].law.quartic);
      BOOST_TEST((found[i].holds == expected[i].holds && found[i].stiff == expected[i].stiff));
    }
  }
  BOOST_TEST(unchanged > 5, unchanged);
}

BOOST_AUTO_TEST_SUITE_END()
