// Which methods a scene takes, and what is said where it does not take one.
#include <algorithm>

#include <boost/test/unit_test.hpp>

#include "experiments/kit/scene_choice.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(scene_choice)

using namespace qddot;

namespace {

// The refusal of a method on a scene; empty if it fits.
std::string said(const Method& method, const Scene& scene) {
  return refusal_of([&] { require_fit(method, ReducedScene(scene), scene.name); });
}

// A scene in two parts, one of them with stiff springs if asked for.
Scene pairs(std::optional<double> stiff_above) {
  Scene scene{.name = "two pairs", .dimension = 2, .stiff_above = stiff_above};
  for (const double x : {0., 3.}) {
    const std::size_t first = scene.nodes.size();
    scene.nodes.push_back({.position = {x, 0, 0}, .velocity = {0, 1, 0}, .mass = 1});
    scene.nodes.push_back({.position = {x + 1, 0, 0}, .mass = 2});
    scene.springs.push_back({{first, first + 1}, {10 + x, 0.9}});
  }
  return scene;
}

const Method split = {
    .name = "divider", .summary = "none", .source = "none", .needs = {Need::split_forces}};

}  // namespace

BOOST_AUTO_TEST_CASE(a_method_that_needs_stiff_springs_named_says_what_to_do) {
  for (const double above : {1., 12., 1e9}) BOOST_TEST(said(split, pairs(above)) == "", above);
  const std::string message = said(split, pairs({}));
  BOOST_TEST(names_all(message, {"two pairs: stiff_above: ", "divider", "allowed", "above 0",
                                 "verlet", "implicit_euler"}),
             message);
}

BOOST_AUTO_TEST_CASE(a_method_for_constant_stiffness_says_so_and_names_others) {
  const Method* exact = find_method("exact");
  BOOST_TEST(said(*exact, load_scene("oscillator")) == "");
  for (const auto& above : {std::optional<double>(), std::optional(12.)}) {
    const std::string message = said(*exact, pairs(above));
    BOOST_TEST(names_all(message, {"two pairs: exact", "same everywhere", "verlet"}), message);
  }
}

BOOST_AUTO_TEST_CASE(all_methods_that_apply_are_selected_and_no_other) {
  for (const Scene& scene : {pairs({}), pairs(12), load_scene("oscillator")}) {
    const ReducedScene reduced(scene);
    const auto selected = select_methods({}, reduced, "scene");
    for (const Method& method : methods()) {
      BOOST_TEST(std::ranges::count(selected, &method) == applies_to(method, reduced.system()),
                 method.name);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
