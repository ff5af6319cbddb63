#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(tension_only)

using namespace qddot;

namespace {

constexpr double rest_length = 0.7;

enum class Kind { link, image, own_image, anchor };
constexpr Kind kinds[] = {Kind::link, Kind::image, Kind::own_image, Kind::anchor};

// A spring for tension only, of `length` along a random direction, among compressed springs that
// hold always.
struct Sample {
  Network network;
  Vec q;

  bool holds() const { return is_valid_at(*make_mass_spring(network), q); }
};

Sample sample(Kind kind, int dimension, double length, bool needs_tension = true) {
  const SpringLaw law{.stiffness = 40, .rest_length = rest_length};
  const Holds holds = needs_tension ? Holds::in_tension : Holds::always;
  const SpringLaw compressed{.stiffness = 10, .rest_length = 50};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(0.5, 1);
  Vec along(dimension), x(dimension);
  for (double& a : along) a = coordinate(random);
  for (double& a : x) a = coordinate(random);
  along *= length / along.norm();
  const Vec turned{{-1, 1, -1}};
  Sample s{{.dimension = dimension, .node_mass = Vec::Ones(2)}, Vec(2 * dimension)};
  Vec other = 3 * x;
  s.network.links = {{0, 1, compressed}};
  s.network.anchors = {{1, {9, 0, 0}, compressed}};
  s.network.image_links = {{1, 0, turned, compressed}};
  switch (kind) {
    case Kind::link:
      s.network.links.push_back({1, 0, law, holds});
      other = x + along;
      break;
    case Kind::image:
      s.network.image_links.push_back({0, 1, turned, law, holds});
      other = turned.head(dimension).cwiseProduct(x + along);
      break;
    case Kind::own_image:  // as long as twice the way to the plane
      s.network.image_links.push_back({0, 0, {-1, 1, 1}, law, holds});
      x[0] = length / 2;
      break;
    case Kind::anchor:
      s.network.anchors.push_back({0, in_space(x + along), law, holds});
  }
  s.q << x, other;
  return s;
}

template <class Check>
void for_all(const Check& check) {
  for (const int dimension : {1, 2, 3}) {
    for (const Kind kind : kinds) {
      BOOST_TEST_CONTEXT("dimension " << dimension << ", kind " << static_cast<int>(kind)) {
        check(kind, dimension);
      }
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_system_holds_until_such_a_spring_is_shorter_than_its_rest_length) {
  for_all([](Kind kind, int dimension) {
    // Rounding, of 1e-15, is forgiven up to 1e-12.
    for (const double longer : {1.0, 1e-3, 2e-12, 1e-14, 0.0, -1e-14, -0.5e-12}) {
      BOOST_TEST(sample(kind, dimension, rest_length * (1 + longer)).holds());
    }
    for (const double shorter : {2e-12, 1e-3, 0.9}) {
      BOOST_TEST(!sample(kind, dimension, rest_length * (1 - shorter)).holds());
    }
  });
}

BOOST_AUTO_TEST_CASE(without_such_springs_a_system_holds_everywhere) {
  for_all([](Kind kind, int dimension) {
    BOOST_TEST(sample(kind, dimension, 0.1 * rest_length, false).holds());
  });
}

BOOST_AUTO_TEST_CASE(it_takes_all_of_several) {
  for_all([](Kind kind, int dimension) {
    Sample s = sample(kind, dimension, 2 * rest_length);
    s.network.anchors.push_back({1, {30, 0, 0}, {1, 0.1}, Holds::in_tension});
    BOOST_TEST(s.holds());
    s.network.anchors.back().law.rest_length = 100;
    BOOST_TEST(!s.holds());
  });
}

BOOST_AUTO_TEST_CASE(what_a_spring_needs_changes_none_of_its_forces) {
  for_all([](Kind kind, int dimension) {
    const Sample s = sample(kind, dimension, 0.5), free = sample(kind, dimension, 0.5, false);
    const auto a = make_mass_spring(s.network), b = make_mass_spring(free.network);
    BOOST_TEST(a->potential(s.q) == b->potential(s.q));
    BOOST_TEST((force_at(*a, s.q) == force_at(*b, s.q)));
    BOOST_TEST((dense(stiffness_at(*a, s.q)) == dense(stiffness_at(*b, s.q))));
  });
}

BOOST_AUTO_TEST_SUITE_END()
