#include <boost/test/unit_test.hpp>

#include "qddot/model/in_tension.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(in_tension)

using namespace qddot;

namespace {

// A spring of rest length 1 m and k = 1 N/m between a pin and a mass of 1 kg in 2D.
Network tether(double stiffness = 1) {
  Network network{.dimension = 2, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {0, 0, 0}, {stiffness, 1}, Holds::in_tension}};
  return network;
}

std::optional<double> end_of_validity(const System& system, const State& from, const State& to) {
  return offered(system.validity()).end_of_validity(from, to);
}

State state(double t, double x, double y, double vx, double vy) {
  return {t, Vec{{x, y}}, Vec{{vx, vy}}};
}

constexpr double rest_length = 0.7;

enum class Kind { link, image, own_image, anchor };

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
    for (const Kind kind : {Kind::link, Kind::image, Kind::own_image, Kind::anchor}) {
      BOOST_TEST_CONTEXT("dimension " << dimension << ", kind " << static_cast<int>(kind)) {
        check(kind, dimension);
      }
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_first_place_below_a_bound_is_that_of_many_samples) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1, 1);
  constexpr double binomials[] = {1, 6, 15, 20, 15, 6, 1};
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    SquaredLength c;
    for (double& x : c) x = number(random);
    c.front() = 0.5;
    const double bound = 0.3 * number(random);
    std::optional<double> sampled;
    for (int j = 0; j <= 1000 && !sampled; ++j) {
      const double s = j / 1000.;
      double sum = 0;
      for (int k = 0; k < 7; ++k) {
        sum += binomials[k] * c[k] * std::pow(s, k) * std::pow(1 - s, 6 - k);
      }
      if (sum < bound) sampled = s;
    }
    const auto first = first_below(c, bound);
    // Samples miss a dip between two of them; what they see is there.
    if (sampled) BOOST_TEST((first && *first <= *sampled + 1e-6));
    if (sampled && first && *sampled - *first < 2e-3) ++found;
    if (!first) BOOST_TEST(!sampled);
  }
  BOOST_TEST(found > 100);
}

BOOST_AUTO_TEST_CASE(a_spring_in_tension_at_both_ends_of_a_step_may_not_be_so_between) {
  // x = 1.1 - s + s^2 with s = t - 3, down to 0.85 and up again, is its own cubic.
  const State from = state(3, 1.1, 0, -1, 0), to = state(4, 1.1, 0, 1, 0);
  const auto system = make_mass_spring(tether());
  BOOST_TEST(is_valid_at(*system, from.q));
  BOOST_TEST(is_valid_at(*system, to.q));
  // 1.1 - s + s^2 = 1.
  const double s = 0.5 - std::sqrt(0.15);
  BOOST_TEST(std::abs(end_of_validity(*system, from, to).value() - (3 + s)) < 1e-5);
  // x = 1.3 - s + s^2 stays above 1.
  BOOST_TEST(!end_of_validity(*system, state(3, 1.3, 0, -1, 0), state(4, 1.3, 0, 1, 0)));
}

BOOST_AUTO_TEST_CASE(a_turning_spring_is_as_long_as_it_is) {
  // A quarter of a circle of radius 1.05 in one step: the cubic with h v = r pi/2 at both ends has
  // an error of 1 % of the radius.
  const double r = 1.05, v = r * M_PI / 2;
  const auto system = make_mass_spring(tether());
  BOOST_TEST(!end_of_validity(*system, state(0, r, 0, 0, v), state(1, 0, r, -v, 0)));
  // The straight way between the two ends is shorter.
  BOOST_TEST(end_of_validity(*system, state(0, r, 0, -r, r), state(1, 0, r, -r, r)).has_value());
}

BOOST_AUTO_TEST_CASE(a_step_that_does_not_resolve_the_vibration_follows_it_all_the_same) {
  // l = 1 + e + a cos w t + b sin w t, where the load stretches the spring by e.
  std::mt19937 random(8);
  std::uniform_real_distribution<double> number(-1, 1);
  constexpr double w = 1000;
  int slack = 0, taut = 0;
  for (int i = 0; i < 300; ++i) {
    const double h = std::pow(10, 0.4 + 0.7 * (1 + number(random))) / w;  // h w of 2.5 to 63
    const double e = 1e-3 * (1 + number(random)), a = e * number(random), b = 1e-3 * number(random);
    Network network = tether(w * w);
    network.load = Vec{{w * w * e, 0}};
    const auto at = [&](double t) {
      return state(t, 1 + e + a * std::cos(w * t) + b * std::sin(w * t), 0,
                   w * (b * std::cos(w * t) - a * std::sin(w * t)), 0);
    };
    std::optional<double> first;
    for (double t = 0; t < h && !first; t += 1e-4 / w) {
      if (at(t).q[0] < 1) first = t;
    }
    const double amplitude = std::hypot(a, b);
    if (std::abs(amplitude - e) < 2e-3 * amplitude) continue;  // it hardly gets there
    const auto told = end_of_validity(*make_mass_spring(network), at(0), at(h));
    BOOST_TEST(told.has_value() == first.has_value());
    // A sample of 72 in a turn.
    if (told && first) BOOST_TEST(std::abs(*told - *first) < 2 * M_PI / 72 / w + 1e-4 / w);
    ++(first ? slack : taut);
  }
  BOOST_TEST(slack > 50);
  BOOST_TEST(taut > 50);
}

BOOST_AUTO_TEST_CASE(springs_in_series_through_massless_nodes_are_watched_as_one) {
  // 1/k = 1/200 + 1/300 + 1/600 and l0 = 0.2 + 0.3 + 0.5, from a pin and between two masses.
  for (const bool is_pinned : {true, false}) {
    Network network{.dimension = 2, .node_mass = Vec{{1, 0, 0, 1}}};
    network.links = {{0, 1, {300, 0.3}}, {2, 1, {600, 0.5}}};
    if (is_pinned) {
      network.anchors = {{2, {0, 0, 0}, {200, 0.2}}};
    } else {
      network.links.push_back({3, 2, {200, 0.2}});
    }
    const auto system = make_mass_spring(network);
    for (const double length : {1.01, 0.99}) {
      const Vec q{{length, 0, 0.7, 0, 0.2, 0, is_pinned ? 7. : 0., 0}};
      BOOST_TEST(is_valid_at(*system, q) == (length > 1));
    }
    // Not so with a load between, or a third spring.
    Network loaded = network, branched = network;
    loaded.load = Vec::Unit(8, 3);
    branched.anchors.push_back({1, {0, 1, 0}, {1, 0}});
    BOOST_TEST(!make_mass_spring(loaded)->validity());
    BOOST_TEST(!make_mass_spring(branched)->validity());
  }
}

BOOST_AUTO_TEST_CASE(of_several_parts_the_first_counts) {
  const BlockDiagonalSystem both = in_parts(tether(), tether());
  const State from{0, Vec{{1.1, 0, 1.05, 0}}, Vec{{-1, 0, -1, 0}}};
  const State to{1, Vec{{1.1, 0, 1.05, 0}}, Vec{{1, 0, 1, 0}}};
  BOOST_TEST(std::abs(end_of_validity(both, from, to).value() - (0.5 - std::sqrt(0.2))) < 1e-5);
}

BOOST_AUTO_TEST_CASE(a_system_holds_until_such_a_spring_is_shorter_than_its_rest_length) {
  for_all([](Kind kind, int dimension) {
    // Rounding, of 1e-15, is forgiven up to 1e-12.
    for (const double longer : {1.0, 1e-3, 2e-12, 1e-14, 0.0, -1e-14, -0.5e-12}) {
      BOOST_TEST(sample(kind, dimension, rest_length * (1 + longer)).holds());
    }
    for (const double shorter : {2e-12, 1e-3, 0.9}) {
      BOOST_TEST(!sample(kind, dimension, rest_length * (1 - shorter)).holds());
    }
    Sample two = sample(kind, dimension, 2 * rest_length);
    two.network.anchors.push_back({1, {30, 0, 0}, {1, 0.1}, Holds::in_tension});
    BOOST_TEST(two.holds());
    two.network.anchors.back().law.rest_length = 100;
    BOOST_TEST(!two.holds());
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
