// The methods that a scene takes.
#include <algorithm>

#include <boost/test/unit_test.hpp>

#include "experiments/kit/scene_choice.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/scene_file.hpp"

BOOST_AUTO_TEST_SUITE(scene_choice)

using namespace qddot;

namespace {

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

}  // namespace

BOOST_AUTO_TEST_CASE(all_methods_that_apply_are_selected_and_no_other) {
  for (const Scene& scene : {pairs({}), pairs(12), load_scene("oscillator")}) {
    const Model reduced(scene);
    const auto selected = select_methods({}, reduced, "scene");
    for (const Method& method : methods()) {
      BOOST_TEST(std::ranges::count(selected, &method) == applies_to(method, reduced.system()),
                 method.name);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
