#include <boost/test/unit_test.hpp>

#include "qddot/scene/explain.hpp"
#include "tests/fragments.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(explanation)

using namespace qddot;

namespace {

Explanation explained(const Scene& scene, const Reductions& reductions = {}) {
  return explain(scene, Model(scene, reductions));
}

// Three nodes on the x axis between two pins, springs shorter or longer than drawn.
Scene strut(double strain) {
  Scene scene;
  for (int i = 0; i < 5; ++i) {
    scene.nodes.push_back({.position = {0.5 * i, 0, 0}, .mass = 1, .pinned = i == 0 || i == 4});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    scene.springs.push_back({{i, i + 1}, {100, 0.5 / (1 + strain)}});
  }
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_counts_unknowns_and_gives_the_stable_step) {
  const Scene scene = draw("oscillator", {{"mass", 4}, {"stiffness", 100}});
  const Explanation e = explained(scene);
  BOOST_TEST(e.drawn_unknowns == 2);
  BOOST_TEST(e.unknowns == 1);
  BOOST_TEST(e.stiffness_is_constant);
  BOOST_TEST(e.omega_max == 5, boost::test_tools::tolerance(1e-4));
  BOOST_TEST(e.omega_bound >= 5 * (1 - 1e-15));
  BOOST_TEST(contains(explanation_in_words(e, scene), {"1 unknowns of 2"}));
  BOOST_TEST(contains(explanation_in_words(e, scene), {"0.4 s"}));
}

BOOST_AUTO_TEST_CASE(a_glance_at_a_large_scene_looks_for_no_eigenvalues) {
  for (const double nodes : {10., 60.}) {
    const Scene scene = draw("cloth", {{"nodes", nodes}});
    const Explanation glance = explain(scene, Model(scene), at_a_glance);
    const bool is_small = 3 * nodes * nodes <= 6000;
    BOOST_TEST(glance.is_examined == is_small);
    BOOST_TEST(std::isfinite(glance.omega_max) == is_small);
    BOOST_TEST(glance.omega_bound > 0);
  }
}

BOOST_AUTO_TEST_CASE(a_strut_that_may_buckle_out_of_its_line_is_told_so) {
  const Explanation e = explained(strut(-0.1));
  BOOST_TEST(e.unknowns == 1);  // on the line, and mirrored: the middle one stays
  // Each of the three may leave the line in two directions; along it nothing is unstable.
  BOOST_TEST(e.unstable == 6);
  BOOST_TEST(e.unstable_left_out == 6);
  BOOST_TEST(e.fastest == 2u);
  // Across, K = -(tau/l) L with the chain's L, whose largest eigenvalue is 4 sin^2(3 pi / 8).
  // growth^2 is |tau| / l times that.
  const double tension = 100 * (0.5 - 0.5 / 0.9);
  const double growth = std::sqrt(-tension / 0.5 * 4 * std::pow(std::sin(3 * M_PI / 8), 2));
  BOOST_TEST(e.growth == growth, boost::test_tools::tolerance(1e-6));
  const std::string words = explanation_in_words(e, strut(-0.1));
  BOOST_TEST(contains(words, {"indefinite"}));
  BOOST_TEST(contains(words, {"--no-reduce dimension,mirror"}));
}

BOOST_AUTO_TEST_CASE(a_string_in_tension_has_nothing_to_tell) {
  const Explanation e = explained(strut(0.1));
  BOOST_TEST(e.unstable == 0);
  BOOST_TEST(e.unstable_left_out == 0);
  BOOST_TEST(e.flat == 0);
  BOOST_TEST(
      contains(explanation_in_words(e, strut(0.1)), {"definite at the start: no direction grows"}));
}

BOOST_AUTO_TEST_CASE(what_rounding_hides_is_told) {
  // Drawn at their rest lengths, springs neither hold nor push across the line.
  const Explanation e = explained(strut(0));
  BOOST_TEST(e.unstable == 0);
  BOOST_TEST(e.flat == 6);
  // Some 100 roundings of 400 N/m, over 1 kg.
  BOOST_TEST(e.flat_rate < 1e-5);
  BOOST_TEST(
      contains(explanation_in_words(e, strut(0)), {"in 6 directions nothing resists at first"}));
}

BOOST_AUTO_TEST_CASE(directions_that_are_kept_are_not_left_out) {
  const Explanation e =
      explained(strut(-0.1), Reductions().without(Reduction::dimension).without(Reduction::mirror));
  BOOST_TEST(e.unknowns == 9);
  BOOST_TEST(e.unstable == 6);
  BOOST_TEST(e.unstable_left_out == 0);
}

BOOST_AUTO_TEST_CASE(scenes_without_unknowns_and_with_massless_nodes_are_explained) {
  Scene pinned = strut(0);
  for (Node& node : pinned.nodes) node.pinned = true;
  BOOST_TEST(contains(explanation_in_words(explained(pinned), pinned), {"nothing is left"}));
  Scene massless = strut(0.1);
  massless.nodes[2].mass = 0;
  massless.springs[1].law.quartic = 1;
  const Explanation e = explained(massless);
  BOOST_TEST(std::isinf(e.omega_bound));
  BOOST_TEST(contains(explanation_in_words(e, massless), {"no explicit method"}));
}

BOOST_AUTO_TEST_CASE(numbers_that_overflow_are_explained_too) {
  Scene extreme = strut(0.1);
  extreme.nodes[1].position.x() = 1e308;
  extreme.nodes[2].position = {-1e308, 1e308, 0};
  for (Spring& spring : extreme.springs) spring.law.stiffness = 1e308;
  const Explanation e = explained(extreme);
  BOOST_TEST(!e.is_examined);
  BOOST_TEST(contains(explanation_in_words(e, extreme), {"not known"}));
}

BOOST_AUTO_TEST_CASE(stiff_springs_are_counted_where_they_are_named) {
  Scene scene = strut(0.1);
  BOOST_TEST(!contains(explanation_in_words(explained(scene), scene), {"  stiff "}));
  scene.springs[1].law.stiffness = 12345;
  scene.stiff_above = 234.56;
  BOOST_TEST(explained(scene).stiff_springs == 1u);
  BOOST_TEST(contains(explanation_in_words(explained(scene), scene),
                      {"  stiff               1 of 4 springs are stiff (above 234.6 N/m)\n"}));
  scene.stiff_above = 12345;
  BOOST_TEST(explained(scene).stiff_springs == 0u);
  BOOST_TEST(contains(explanation_in_words(explained(scene), scene), {"0 of 4 springs are stiff"}));
}

BOOST_AUTO_TEST_CASE(a_stiff_frame_alone_bounds_explicit_steps_some_eighty_times_below_the_cloth) {
  const Explanation cloth = explained(draw("cloth")), framed = explained(draw("framed_cloth"));
  BOOST_TEST(framed.omega_max / cloth.omega_max == 80, boost::test_tools::tolerance(0.05));
  BOOST_TEST(framed.unknowns == cloth.unknowns);
  BOOST_TEST(framed.stiff_springs == 116u);
}

BOOST_AUTO_TEST_CASE(every_generator_is_explained) {
  for (const Generator& generator : generators()) {
    const Scene scene = draw(generator.name);
    const Explanation e = explained(scene);
    BOOST_TEST(e.unknowns < e.drawn_unknowns, generator.name);
    BOOST_TEST(std::isfinite(e.omega_max), generator.name);
    BOOST_TEST((e.unstable > 0) == (generator.name == "strut"), generator.name);
    for (const Finding& finding : e.findings) {
      BOOST_TEST(contains(explanation_in_words(e, scene), {finding.what}));
    }
  }
}

// A mass on springs along both axes: w = 10 and 20 rad/s, each with its dashpot, and air of 0.4/s.
BOOST_AUTO_TEST_CASE(damping_ratios_are_those_of_the_lowest_and_the_highest_mode) {
  Scene scene{.dimension = 2};
  scene.nodes = {{.position = {-1, 0, 0}, .pinned = true},
                 {.position = {0, -1, 0}, .pinned = true},
                 {.position = {0, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 2}, {.stiffness = 100, .rest_length = 1, .damping = 4}},
                   {{1, 2}, {.stiffness = 400, .rest_length = 1, .damping = 20}}};
  scene.air_damping = 0.4;
  const Explanation e = explained(scene);
  BOOST_TEST(e.is_damped);
  BOOST_TEST(std::abs(e.zeta_lowest - (4 + 0.4) / (2 * 10)) < 1e-10);
  const double zeta = (20 + 0.4) / (2 * 20);
  BOOST_TEST(std::abs(e.zeta_highest - zeta) < 1e-10);
  const double step = (std::sqrt(1 + 4 * zeta * zeta) - 2 * zeta) * 2 / 20;
  BOOST_TEST(std::abs(e.verlet_step / step - 1) < 1e-3);
  const std::string words = explanation_in_words(e, scene);
  BOOST_TEST(words.find("damping ratio 0.51 of the highest mode") != std::string::npos);
  BOOST_TEST(words.find("0.22 of the lowest") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
