// Points found by their place against a search among all of them.
#include <random>
#include <set>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/places.hpp"

BOOST_AUTO_TEST_SUITE(places)

using namespace qddot;
using qddot::reduce::Places;
using Points = std::vector<Eigen::Vector3d>;

namespace {

constexpr double near = 1e-3;

// Points of several kinds: in a box, in a grid, at one place, and in a cluster far from one other.
std::vector<Points> kinds(std::mt19937& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  const auto any = [&] { return Eigen::Vector3d(part(random), part(random), part(random)); };
  Points box, grid, one_place(20, any()), cluster{{1e9, 0, 0}};
  for (int i = 0; i < 200; ++i) box.push_back(any());
  for (int i = 0; i < 50; ++i) box.push_back(box[random() % 200] + 0.4 * near * any());
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) grid.emplace_back(i, j, 0);
  }
  for (int i = 0; i < 100; ++i) cluster.push_back(0.02 * any());
  return {{}, {any()}, box, grid, one_place, cluster};
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_point_within_the_tolerance_is_offered_and_no_other) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> part(-1, 1);
  int found = 0;
  for (const Points& points : kinds(random)) {
    const Places places(points);
    for (int ask = 0; ask < 300; ++ask) {
      Eigen::Vector3d place(part(random), part(random), part(random));
      if (ask % 3 && !points.empty()) place = points[random() % points.size()] + near * place;
      std::set<int> expected, offered;
      for (int i = 0; i < std::ssize(points); ++i) {
        if ((points[static_cast<std::size_t>(i)] - place).norm() <= near) expected.insert(i);
      }
      const auto refuse = [&](int i) {
        offered.insert(i);
        return false;
      };
      BOOST_TEST(places.find(place, near, refuse) == -1);
      BOOST_TEST(offered == expected, boost::test_tools::per_element());
      const int first = places.find(place, near, [](int) { return true; });
      BOOST_TEST((first == -1 ? expected.empty() : expected.contains(first)));
      found += first >= 0;
    }
  }
  BOOST_TEST(found > 100, found);
}

BOOST_AUTO_TEST_CASE(points_in_one_place_are_offered_in_their_order) {
  const Points points(50, {0.1, 0.2, 0.3});
  std::vector<int> offered;
  Places(points).find(points.front(), near, [&](int i) {
    offered.push_back(i);
    return false;
  });
  BOOST_TEST(std::ranges::is_sorted(offered));
  BOOST_TEST(offered.size() == points.size());
}

BOOST_AUTO_TEST_CASE(shared_places_are_those_of_pairs) {
  std::mt19937 random(7);
  int shared = 0, asked = 0;
  for (int draw = 0; draw < 40; ++draw) {
    for (const Points& points : kinds(random)) {
      for (const double tolerance : {0.0, 1e-4, near, 0.05}) {
        bool expected = false;
        for (std::size_t i = 0; i < points.size(); ++i) {
          for (std::size_t j = 0; j < i; ++j)
            expected = expected || (points[i] - points[j]).norm() <= tolerance;
        }
        BOOST_TEST(Places(points).any_shared(tolerance) == expected);
        shared += expected;
        ++asked;
      }
    }
  }
  BOOST_TEST((shared > asked / 10 && shared < asked * 9 / 10), shared << " of " << asked);
}

BOOST_AUTO_TEST_SUITE_END()
