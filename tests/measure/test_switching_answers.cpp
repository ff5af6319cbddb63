// Scenes with cables and springs that break: how they are read and written, what is left out of
// them, answers with error bars, references, and extreme strains.
#include <cmath>
#include <limits>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/breaks.hpp"
#include "qddot/measure/motion/strains.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/scene/refusal.hpp"

using namespace qddot;

BOOST_AUTO_TEST_SUITE(switching_answers)

namespace {

Scene parsed(const std::string& text) { return parse_scene(text, "cables.toml", "."); }

// Two masses in a row on two cables, of which the lower one may break.
std::string cables(const std::string& of_lower) {
  return R"(
dimension = 2
gravity = [0.0, -9.81]
[[nodes]]
position = [0.0, 0.0]
pinned = true
[[nodes]]
position = [0.5, -0.2]
mass = 1.0
[[nodes]]
position = [1.0, -0.1]
mass = 0.5
[[springs]]
nodes = [0, 1]
stiffness = 2000.0
rest_length = 0.8
pulls_only = true
[[springs]]
nodes = [1, 2]
stiffness = 1500.0
rest_length = 0.6
)" + of_lower;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_file_gives_them_and_writes_them_again) {
  const Scene scene = parsed(cables("pulls_only = true\nbreaks_at = 0.06\ncubic = -3.5\n"));
  const SpringLaw &upper = scene.springs[0].law, &lower = scene.springs[1].law;
  BOOST_TEST(upper.pulls_only);
  BOOST_TEST(!upper.can_break());
  BOOST_TEST(lower.breaks_at == 0.06);
  BOOST_TEST(lower.cubic == -3.5);
  const Scene again = parsed(to_toml(scene));
  BOOST_TEST(again.springs[0].law.pulls_only);
  BOOST_TEST(again.springs[1].law.pulls_only);
  BOOST_TEST(again.springs[1].law.breaks_at == 0.06);
  BOOST_TEST(again.springs[1].law.cubic == -3.5);
  BOOST_TEST(content_hash(again) == content_hash(scene));
  for (const char* other : {"", "pulls_only = true\n", "breaks_at = 0.07\n", "cubic = 1.0\n"})
    BOOST_TEST(content_hash(parsed(cables(other))) != content_hash(scene));
}

BOOST_AUTO_TEST_CASE(a_mesh_and_a_generator_give_them_to_all_springs) {
  const Scene scene =
      parsed("[generator]\nkind = \"chain\"\nnodes = 5\npulls_only = true\nbreaks_at = 0.1\n");
  for (const Spring& spring : scene.springs) {
    BOOST_TEST(spring.law.pulls_only);
    BOOST_TEST(spring.law.breaks_at == 0.1);
  }
}

BOOST_AUTO_TEST_CASE(what_nothing_is_said_of_is_refused) {
  const auto refused = [](const std::string& text, const std::string& words) {
    BOOST_CHECK_EXCEPTION(parsed(text), InvalidInput, [&](const InvalidInput& error) {
      BOOST_TEST(std::string(error.what()).find(words) != std::string::npos, error.what());
      return true;
    });
  };
  refused(cables("breaks_at = 0.0\n"), "breaks_at");
  refused(cables("breaks_at = -1.0\n"), "breaks_at");
  refused(cables("pull_only = true\n"), "pulls_only");
  std::string massless = cables("pulls_only = true\n");
  massless.replace(massless.find("mass = 0.5"), 10, "mass = 0.0");
  refused(massless, "a node without mass is on it");
  std::string pinned = cables("breaks_at = 0.1\n");
  pinned.replace(pinned.find("mass = 1.0"), 10, "pinned = true");
  pinned.replace(pinned.find("mass = 0.5"), 10, "pinned = true");
  refused(pinned, "two pinned nodes");
  std::string no_length = cables("breaks_at = 0.1\n");
  no_length.replace(no_length.find("rest_length = 0.6"), 17, "rest_length = 0.0");
  refused(no_length, "no strain");
}

// Images of one another need not break in one order, so no mirror is taken; without such springs
// it is.
BOOST_AUTO_TEST_CASE(a_part_that_may_break_has_no_mirror) {
  const auto has_mirror = [](const Scene& scene) {
    const Model model(scene);
    return std::ranges::any_of(model.findings(), [](const Finding& finding) {
      return finding.reduction == Reduction::mirror;
    });
  };
  Scene bridge = generate(*find_generator("bridge"), {}, "bridge");
  BOOST_TEST(!has_mirror(bridge));
  for (Spring& spring : bridge.springs)
    spring.law.breaks_at = std::numeric_limits<double>::infinity();
  BOOST_TEST(has_mirror(bridge));
}

// The numbers of phases lead to the scene's springs, also behind merged ones and in parts.
BOOST_AUTO_TEST_CASE(phases_know_their_springs) {
  Scene scene = parsed(cables("breaks_at = 0.06\n"));
  const std::size_t first = scene.nodes.size();
  Scene copy = scene;
  for (Node& node : copy.nodes) {
    node.position.x() += 5;
    scene.nodes.push_back(node);
  }
  // Two equal springs, which become one, come before those of the copy.
  scene.springs.push_back({{first, first + 1}, {.stiffness = 10, .rest_length = 0.5}});
  scene.springs.push_back({{first, first + 1}, {.stiffness = 10, .rest_length = 0.5}});
  for (Spring spring : copy.springs) {
    for (std::size_t& node : spring.nodes) node += first;
    scene.springs.push_back(spring);
  }
  const Model model(scene);
  const std::vector<std::size_t> expected = {0, 1, 4, 5};
  BOOST_TEST(model.general_springs() == expected, boost::test_tools::per_element());
}

// An answer's bars hold against a far more accurate run, for places and for the moment.
BOOST_AUTO_TEST_CASE(answers_bound_their_errors_and_moments) {
  const Scene scene = parsed(cables("pulls_only = true\nbreaks_at = 0.06\n"));
  const Model model(scene);
  State truth = model.initial();
  const Summary exact =
      make_integrator(*find_method("dprkn12"), model.system(), {.rtol = 1e-14})->advance(truth, 2);
  BOOST_TEST_REQUIRE(exact.breaks.size() == 1u);
  const std::vector<Node> nodes = model.expand(truth);
  for (const double accuracy : {1e-3, 1e-5, 1e-8}) {
    const Answer answer = measure::solve(scene, 2, accuracy);
    BOOST_TEST_REQUIRE(answer.is_reached);
    BOOST_TEST_REQUIRE(answer.break_errors.size() == 1u);
    double error = 0, displacement = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      error = std::max(error, (answer.nodes[i].position - nodes[i].position).norm());
      displacement = std::max(displacement, (nodes[i].position - scene.nodes[i].position).norm());
    }
    BOOST_TEST(error <= answer.error_estimate * displacement);
    const double moment_error = std::abs(answer.summary.breaks[0].t - exact.breaks[0].t);
    BOOST_TEST(moment_error <= answer.break_errors[0]);
    // The bar is of use: a moment is known about as well as places are.
    BOOST_TEST(answer.break_errors[0] < 100 * accuracy);
  }
}

BOOST_AUTO_TEST_CASE(breaks_that_are_too_near_are_told) {
  const std::vector<Break> breaks = {{0.5, 1, 0.1, 1}, {0.5 + 1e-6, 0, 0.1, 1}};
  BOOST_TEST(unclear_order(breaks, {1e-7, 1e-7}, {3, 8}) == "");
  const std::string said = unclear_order(breaks, {1e-6, 1e-7}, {3, 8});
  BOOST_TEST(said.find("springs 8 and 3 break within 1.0e-06 s at t = 0.500001 s") == 0u, said);
  // Those of symmetry are one moment.
  BOOST_TEST(unclear_order({{0.5, 1, 0.1, 1}, {0.5 + 1e-14, 0, 0.1, 1}}, {1e-6, 1e-6}, {3, 8}) ==
             "");
}

BOOST_AUTO_TEST_CASE(a_reference_is_certified_across_moments) {
  const Scene scene = parsed(cables("pulls_only = true\nbreaks_at = 0.06\n"));
  const Model model(scene);
  const Reference reference = make_reference(model, 1, 10, &scene);
  BOOST_TEST(reference.certified.position < 1e-10);
  State other = model.initial();
  make_integrator(*find_method("dprkn12"), model.system(), {.rtol = 1e-14})->advance(other, 1);
  const Errors error =
      errors_between(model, other, reference.end, reference.energy, reference.scales);
  BOOST_TEST(error.position <= reference.certified.position + 1e-12);
  BOOST_TEST(error.energy <= reference.certified.energy + 1e-12);
}

// A mass that swings through x = 1 + a sin(w t) on one spring: extremes by closed form, also
// between steps.
BOOST_AUTO_TEST_CASE(strains_are_those_of_the_motion_between_steps) {
  Scene scene{.dimension = 1};
  scene.nodes = {{.pinned = true}, {.position = {1, 0, 0}, .velocity = {2, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 100, .rest_length = 1, .damping = 0}}};
  const Model model(scene);
  Strains strains(scene, model);
  State state = model.initial();
  strains.see(state);
  Observer observer;
  observer.step = [&](const State& seen) { strains.see(seen); };
  // Steps of a tenth of the period, which miss the extremes.
  make_integrator(*find_method("kahan_li8"), model.system(), {.step_size = 0.06})
      ->advance(state, 0.6, observer);
  const SpringExtremes& own = strains.extremes().front();
  // The cubic's error is (h w)^4/384 of the amplitude of 0.2, and four looks a step miss the
  // largest by up to (h w/8)^2/2 of it: 6e-4 in all.
  BOOST_TEST(std::abs(own.largest_strain.value - 0.2) < 7e-4);
  BOOST_TEST(std::abs(own.smallest_strain.value + 0.2) < 7e-4);
  BOOST_TEST(std::abs(own.largest_tension.value - 20) < 7e-2);
  BOOST_TEST(std::abs(own.largest_strain.t - M_PI / 20) < 0.02);
}

BOOST_AUTO_TEST_SUITE_END()
