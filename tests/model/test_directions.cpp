// Springs on a line that are known to keep their direction: f is linear while they do.
#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(directions)

using namespace qddot;

namespace {

// Each kind of spring on `count` nodes; some coordinates stay zero. All lengths deviate by `strain`
// at the state `q`.
struct Line {
  Network network;
  Vec q;
};
Line line(int count, double strain, bool has_mirror) {
  Line line{{.dimension = 1, .node_mass = Vec::Ones(count)}, {}};
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back(1 + i * 0.75);
  if (has_mirror) {
    line.network.zero_coordinates.assign(static_cast<std::size_t>(count), 0);
    line.network.zero_coordinates[0] = 1;
    x[0] = 0;
  }
  const auto k = [](int i) { return 100. + 10 * i; };
  for (int i = 0; i + 1 < count; ++i) {
    const auto law = [&](double length) { return SpringLaw{k(i), length - strain}; };
    line.network.links.push_back({i, i + 1, law(x[i + 1] - x[i]), Holds::always, false, 1});
    line.network.image_links.push_back(
        {i + 1, i, {-1, 1, 1}, law(x[i] + x[i + 1]), Holds::always, false, -1});
    line.network.anchors.push_back({i, {-2, 0, 0}, law(2 + x[i]), Holds::always, false, -1});
  }
  line.q = Vec::Map(x.data() + (has_mirror ? 1 : 0), count - (has_mirror ? 1 : 0));
  return line;
}

}  // namespace

BOOST_AUTO_TEST_CASE(energies_of_small_strains_keep_their_digits) {
  // 20 nodes are summed by vectors, 4 spring by spring.
  for (const int count : {4, 20}) {
    for (const bool has_mirror : {false, true}) {
      const auto [network, q] = line(count, 1e-9, has_mirror);
      const auto system = make_mass_spring(network);
      BOOST_TEST(system->stiffness_is_constant());
      // Differences of positions, and of these and the rest lengths, are without rounding.
      const auto x = [&, &at = q](int i) { return has_mirror ? (i == 0 ? 0 : at[i - 1]) : at[i]; };
      double v = 0;
      const auto add = [&](const auto& spring, double d) {
        v += 0.5 * spring.law.stiffness * std::pow(std::abs(d) - spring.law.rest_length, 2);
      };
      for (const auto& link : network.links) add(link, x(link.j) - x(link.i));
      for (const auto& link : network.image_links) add(link, -x(link.j) - x(link.i));
      for (const auto& anchor : network.anchors) add(anchor, -2 - x(anchor.i));
      BOOST_TEST(system->potential(q) == v, boost::test_tools::tolerance(200 * eps));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_mean_force_does_the_work) {
  for (const int count : {4, 20}) {
    for (const bool has_mirror : {false, true}) {
      const auto [network, q] = line(count, 0.3, has_mirror);
      const auto system = make_mass_spring(network);
      Vec other = q;
      for (Index i = 0; i < q.size(); ++i) other[i] += 0.1 * std::sin(3. * static_cast<double>(i));
      const Vec mean = mean_force_between(*system, q, other);
      BOOST_TEST(std::abs(mean.dot(other - q) - (system->potential(q) - system->potential(other))) <
                 100 * eps * (1 + system->potential(other)) * count);
    }
  }
}

BOOST_AUTO_TEST_CASE(all_is_as_without_directions_wherever_the_nodes_are) {
  for (const int count : {4, 20}) {
    for (const bool has_mirror : {false, true}) {
      auto [network, q] = line(count, 0.3, has_mirror);
      const auto directed = make_mass_spring(network);
      for_springs(network, [](auto& spring) { spring.direction = 0; });
      const auto drawn = make_mass_spring(network);
      BOOST_TEST(!drawn->stiffness_is_constant());
      BOOST_TEST(!is_linear_at(*drawn, q));
      BOOST_TEST(is_linear_at(*directed, q));
      const Eigen::MatrixXd k = dense(stiffness_at(*drawn, q));
      Vec turned = q;
      for (Index i = 0; i < q.size(); ++i) turned[i] *= i % 2 == 0 ? 1 : -3;
      BOOST_TEST(!is_linear_at(*directed, turned));
      for (const Vec& at : {q, turned}) {
        BOOST_TEST((force_at(*directed, at) == force_at(*drawn, at)));
        BOOST_TEST(directed->potential(at) == drawn->potential(at));
        BOOST_TEST((dense(stiffness_at(*directed, at)) == k));  // as on a line it is
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_have_a_direction_is_refused) {
  Network plane{.dimension = 2, .node_mass = Vec::Ones(2)};
  plane.links = {{0, 1, {.stiffness = 1}, Holds::always, false, 1}};
  BOOST_CHECK_THROW(make_mass_spring(plane), std::invalid_argument);
  Network line{.dimension = 1, .node_mass = Vec::Ones(2)};
  line.links = {{0, 1, {.stiffness = 1, .quartic = 1}, Holds::always, false, 1}};
  BOOST_CHECK_THROW(make_mass_spring(line), std::invalid_argument);
  line.links = {{0, 1, {.stiffness = 1, .rest_length = 1}, Holds::always, false, 1},
                {0, 1, {.stiffness = 1, .rest_length = 2}}};
  BOOST_CHECK_THROW(make_mass_spring(line), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
