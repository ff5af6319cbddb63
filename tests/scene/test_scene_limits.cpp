#include <algorithm>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/generators.hpp"
#include "tests/scene/scene_texts.hpp"

BOOST_AUTO_TEST_SUITE(scene_limits)

using namespace qddot;

namespace {

std::string refusal_within(const SceneLimits& limits, const std::string& text) {
  return refusal_of([&] { parsed(text, limits); });
}

// A text is taken at exactly its size, and refused with one node or spring fewer allowed.
void check_limits(const std::string& text, std::size_t nodes, std::size_t springs,
                  const std::string& place) {
  const auto many = [](std::size_t count, const char* what) {
    return std::to_string(count) + " " + what + " are too many";
  };
  const auto most = [](std::size_t count) {
    return "allowed are up to " + std::to_string(count - 1);
  };
  BOOST_TEST(refusal_within({nodes, springs}, text) == "");
  const std::string too_many_nodes = refusal_within({nodes - 1, springs}, text);
  BOOST_TEST(names_all(too_many_nodes, {place, many(nodes, "nodes"), most(nodes)}), too_many_nodes);
  const std::string too_many_springs = refusal_within({nodes, springs - 1}, text);
  BOOST_TEST(names_all(too_many_springs, {place, many(springs, "springs"), most(springs)}),
             too_many_springs);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_that_does_not_fit_into_memory_is_refused_before_it_is_drawn) {
  const std::string million = "[generator]\nkind = \"cloth\"\nnodes = 1000\n";
  const std::string refusal = refusal_within({.bytes = 1e9}, million);
  BOOST_TEST(names_all(refusal, {"1000000 nodes", "GB of memory", "1 GB are free"}), refusal);
  BOOST_TEST(refusal_within({.bytes = 1e9}, "[generator]\nkind = \"cloth\"\n") == "");
}

BOOST_AUTO_TEST_CASE(every_generator_knows_its_size_before_it_draws) {
  for (const Generator& generator : generators()) {
    GeneratorValues values;
    for (const GeneratorParameter& p : generator.parameters) values[p.name] = p.standard;
    const auto check = [&](const GeneratorValues& drawn_from) {
      const Scene scene = generate(generator, drawn_from, "test");
      const SceneSize size = generator.size(drawn_from);
      BOOST_TEST(size.nodes == scene.nodes.size());
      BOOST_TEST(size.springs == scene.springs.size());
    };
    BOOST_TEST_CONTEXT(generator.name) {
      check(values);
      // Each number of nodes at its least, and at one that no other has.
      double next = 5;
      for (const GeneratorParameter& p : generator.parameters) {
        if (!p.whole) continue;
        GeneratorValues least = values;
        least[p.name] = p.low;
        check(least);
        values[p.name] = std::min(next++, p.high);
      }
      check(values);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_largest_scene_of_a_generator_is_refused_before_it_is_drawn) {
  for (const Generator& generator : generators()) {
    std::string text = "[generator]\nkind = '" + generator.name + "'\n";
    for (const GeneratorParameter& p : generator.parameters) {
      if (p.whole) text += p.name + " = " + std::to_string(static_cast<int>(p.high)) + "\n";
    }
    const std::string message = refusal_within({.nodes = 1, .springs = 1}, text);
    BOOST_TEST(names_all(message, {"a.toml:1: generator: ", "nodes are too many"}), message);
  }
  const std::string cloth = "[generator]\nkind = 'cloth'\nnodes = 4000\n";
  BOOST_TEST(names_all(refusal(cloth), {"16000000 nodes", "allowed are up to 10000000"}));
}

BOOST_AUTO_TEST_CASE(every_kind_of_scene_is_bounded) {
  check_limits(two_links, 2, 1, "a.toml: ");
  check_limits(mesh_scene, 4, 6, "a.toml:1: mesh: ");
  check_limits(with(mesh_scene, "scale = 2", "bending_stiffness = 2"), 4, 12, "a.toml:1: mesh: ");
  check_limits("[generator]\nkind = 'chain'\nnodes = 20\n", 20, 19, "a.toml:1: generator: ");
}

BOOST_AUTO_TEST_SUITE_END()
