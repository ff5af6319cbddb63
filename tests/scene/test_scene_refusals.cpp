
#include <boost/test/unit_test.hpp>
#include <fmt/format.h>

#include "qddot/scene/generators.hpp"
#include "tests/scene/scene_texts.hpp"

BOOST_AUTO_TEST_SUITE(scene_refusals)

using namespace qddot;

namespace {

// Each text spoils one line of `good`; the message names that line, the field, what was written
// and what is allowed.
struct Spoiled {
  std::string old_part, new_part;
  std::vector<std::string> fragments;
};

void check_refusals(const std::string& good, const std::vector<Spoiled>& cases) {
  BOOST_REQUIRE_EQUAL(refusal(good), "");
  for (const auto& [old_part, new_part, fragments] : cases) {
    const std::string message = refusal(with(good, old_part, new_part));
    BOOST_CHECK_MESSAGE(names_all(message, fragments) && names_all(message, {"a.toml", "allowed"}),
                        new_part << " gives: " << message);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(malformed_values_are_named) {
  check_refusals(
      two_links,
      {{"name = 'two links'", "name = 3", {":1:", "name", "3", "text"}},
       {"dimension = 2", "", {"dimension", "missing", "from 1 to 3"}},
       {"dimension = 2", "dimension = 4", {":2:", "dimension", "4", "from 1 to 3"}},
       {"dimension = 2", "dimension = 2.0", {":2:", "dimension", "2.0", "integers"}},
       {"dimension = 2", "dimension = 3", {":6:", "nodes[0].position", "[0.1, 0.0]", "3 finite"}},
       {"[0.0, -9.81]", "[0.0, -inf]", {":3:", "gravity", "-inf", "finite"}},
       {"[0.0, -9.81]", "[-9.81]", {":3:", "gravity", "-9.81", "2 finite numbers"}},
       {"[0.0, -9.81]", "-9.81", {":3:", "gravity", "-9.81", "2 finite numbers"}},
       {"until = 0.5", "until = 0", {":4:", "until", "0", "above 0"}},
       {"until = 0.5", "until = inf", {":4:", "until", "inf", "above 0"}},
       {"until = 0.5", "stiff_abov = 1", {":4:", "stiff_abov", "unknown", "stiff_above"}},
       {"until = 0.5", "untill = 0.5", {":4:", "untill", "unknown", "until"}},
       {"[0.1, 0.0]", "[nan, 0.0]", {":6:", "nodes[0].position", "nan", "finite"}},
       {"[0.1, 0.0]", "[0.1, 0.0, 0.0]", {":6:", "nodes[0].position", "2 finite numbers"}},
       {"[0.1, 0.0]", "[0.1, 'x']", {":6:", "nodes[0].position", "x", "2 finite numbers"}},
       {"position = [3.1, 4]\n", "", {":9:", "nodes[1].position", "missing", "2 finite"}},
       {"pinned = true", "pinned = 1", {":8:", "nodes[0].pinned", "1", "true and false"}},
       {"[0.0, -1e-3]", "[0.0, inf]", {":11:", "nodes[1].velocity", "inf", "finite"}},
       {"mass = 2", "mass = -2.5", {":12:", "nodes[1].mass", "-2.5", "from 0"}},
       {"mass = 2", "mass = nan", {":12:", "nodes[1].mass", "nan", "finite"}},
       {"mass = 2", "mass = '2'", {":12:", "nodes[1].mass", "'2'", "finite"}},
       {"mass = 2", "mass = {kg = 2}", {":12:", "nodes[1].mass", "a table", "finite"}},
       {"mass = 2\n", "", {":9:", "nodes[1].mass", "missing", "from 0"}},
       {"mass = 2", "masss = 2", {":12:", "nodes[1].masss", "unknown", "mass, pinned"}},
       {"mass = 0.1", "mass = -1", {":7:", "nodes[0].mass", "-1", "from 0"}},
       {"[0, 1]", "[0, 2]", {":14:", "springs[0].nodes", "2 is not a node", "0 to 1"}},
       {"[0, 1]", "[-1, 1]", {":14:", "springs[0].nodes", "-1 is not a node", "0 to 1"}},
       {"[0, 1]", "[1, 1]", {"springs[0].nodes", "[1, 1]", "two different nodes"}},
       {"[0, 1]", "[0]", {":14:", "springs[0].nodes", "0", "pairs"}},
       {"[0, 1]", "[0, 1.0]", {":14:", "springs[0].nodes", "1.0", "pairs"}},
       {"[0, 1]", "'01'", {":14:", "springs[0].nodes", "01", "pairs"}},
       {"nodes = [0, 1]\n", "", {":13:", "springs[0].nodes", "missing", "pairs"}},
       {"1000.0", "-1000.0", {":15:", "springs[0].stiffness", "-1000", "from 0"}},
       {"stiffness = 1000.0\n", "", {":13:", "springs[0].stiffness", "missing", "from 0"}},
       {"rest_length = 0.5", "rest_length = -0.5", {":16:", "rest_length", "-0.5", "from 0"}},
       {"quartic = 7.0", "quartic = -inf", {":17:", "springs[0].quartic", "-inf", "from 0"}},
       {"quartic", "quintic", {":17:", "springs[0].quintic", "unknown", "quartic"}},
       {"quartic = 7.0", "cubic = nan", {":17:", "springs[0].cubic", "nan", "finite"}},
       {"quartic = 7.0", "breaks_at = 0.0", {":17:", "springs[0].breaks_at", "0.0", "above 0"}},
       {"quartic = 7.0",
        "pulls_only = 1",
        {":17:", "springs[0].pulls_only", "1", "true and false"}},
       {"[3.1, 4]", "[0.1, 0]", {"springs[0].rest_length", "0.5", "coincide", "is 0"}}});
}

BOOST_AUTO_TEST_CASE(malformed_meshes_are_named) {
  check_refusals(
      mesh_scene,
      {{"'m.obj'", "3", {":2:", "mesh.file", "3", "text"}},
       {"'m.obj'", "'no.obj'", {":2:", "mesh.file", "no.obj", "No such file"}},
       {"'m.obj'", "'bad.obj'", {":2:", "mesh.file", "bad.obj:1:", "finite"}},
       {"'m.obj'", "'m.off'", {":2:", "mesh.file", ".off", ".obj, .mesh, .msh, .ply and .stl"}},
       {"file = 'm.obj'\n", "", {":1:", "mesh.file", "missing", "text"}},
       {"scale = 2", "scale = 0", {":3:", "mesh.scale", "0", "above 0"}},
       {"stiffness = 10", "stiffness = -1", {":4:", "mesh.stiffness", "-1", "from 0"}},
       {"stiffness = 10\n", "", {":1:", "mesh.stiffness", "missing", "from 0"}},
       {"scale = 2", "bending_stiffness = nan", {"mesh.bending_stiffness", "nan"}},
       {"'m.obj'\n",
        "'q.obj'\nbending_stiffness = 1.5\n",
        {":3:", "mesh.bending_stiffness", "1.5", "q.obj", "two triangles", "is 0"}},
       {"'m.obj'", "\"m\\n.obj\"", {":2:", "mesh.file", "m .obj", "control"}},
       {"'m.obj'", "'" + std::string(2000, 'm') + ".obj'", {":2:", "mesh.file", "mmm...", "1000"}},
       {"total_mass = 8\n", "", {":1:", "mesh.node_mass", "exactly one", "total_mass"}},
       {"scale = 2", "node_mass = 1", {":3:", "mesh.node_mass", "exactly one", "total_mass"}},
       {"total_mass = 8", "total_mass = -8", {":5:", "total_mass", "-8", "from 0"}},
       {"scale = 2", "colour = 2", {":3:", "mesh.colour", "unknown", "scale"}},
       {"min = [-1, -1, 0.3]", "min = [-1, 2]", {":7:", "mesh.pin[0].min", "3 finite"}},
       {"max = [1, 1, 3]", "max = [1, 1, 0]", {":8:", "mesh.pin[0].max", "below min"}},
       {"max = [1, 1, 3]", "", {":6:", "mesh.pin[0].max", "missing", "3 finite"}},
       {"min = [-1, -1, 0.3]",
        "min = [-1, -1, 2.5]",
        {":7:", "mesh.pin[0].min", "holds no node", "[-1, -1, 2.5] to [1, 1, 3]",
         "[0, 0, 0] to [2, 2, 2]", "allowed"}},
       {"scale = 2", "scale = 3.5", {":7:", "mesh.pin[0].min", "[3.5, 3.5, 3.5]"}},
       {"max", "top", {":8:", "mesh.pin[0].top", "unknown", "min, max"}},
       {"[mesh]", "dimension = 2\n[mesh]", {":1:", "dimension", "2", "3"}},
       {"[mesh]", "nodes = []\n[mesh]", {"exactly one", "[mesh]"}},
       {"[mesh]", "springs = []\n[mesh]", {":1:", "springs", "unknown", "gravity"}}});
}

BOOST_AUTO_TEST_CASE(malformed_files_are_named) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {"", {"needs nodes", "exactly one"}},
      {"nodes = []\n[generator]\nkind = \"cloth\"",
       {"[[nodes]] and [generator]", "each make a scene", "exactly one"}},
      {"dimension = 1\n[[nodes]]\nposition = [0]\nmass = 1\n[[nodes]]\nposition = [1e200]\n"
       "mass = 1\n[[springs]]\nnodes = [0, 1]\nstiffness = 1\n",
       {"springs[0].rest_length", "inf", "finite numbers from 0"}},
      {"dimension = 1\nnodes = []\n", {"nodes", "at least one"}},
      {"dimension = 1\nnodes = [1]\n", {":2:", "nodes", "1", "[[nodes]]"}},
      {"dimension = 1\n[nodes]\n", {":2:", "nodes", "a table", "[[nodes]]"}},
      {"mesh = 1\n", {":1:", "mesh", "1", "[mesh]"}},
      {"generator = 'cloth'\n", {":1:", "generator", "cloth", "[generator]"}},
      {"[generator]\n", {":1:", "generator.kind", "missing"}},
      {"[generator]\nkind = 'no such'\n",
       {":2:", "generator.kind", "no such", generators()[0].name}},
      {"gravity = [0]\n[generator]\nkind = 'x'\n", {":1:", "gravity", "unknown", "until"}},
      {"[generator]\nkind = '" + generators()[0].name + "'\nsize = nan\n",
       {":3:", "nan", "finite"}},
      {"[generator]\nkind = '" + generators()[0].name + "'\nno_such = 1\n", {"no_such"}},
      {"nodes = [\n", {":1:", "not TOML"}},
      {"'a\\nb' = 1\n" + two_links, {":1:", "unknown"}},
      {std::string(10'000'000, '1'), {"not TOML"}},
      {"name = " + std::string(10'000'000, '1'), {":1:", "not TOML"}},
      {std::string(10'000'000, '['), {":1:"}},
      {"a" + std::string(5'000'000, 'a') + " = 1\n" + two_links, {":1:", "unknown"}},
      {std::string("\0\x01\xff\xfe\x80 = \n\x00", 10), {"not TOML"}}};
  for (const auto& [text, fragments] : cases) {
    const std::string message = refusal(text);
    BOOST_CHECK_MESSAGE(names_all(message, fragments) && names_all(message, {"a.toml"}),
                        text.substr(0, 80) << " gives: " << message);
    BOOST_TEST(message.size() < 500);
  }
}

BOOST_AUTO_TEST_CASE(every_way_to_part_a_deep_key_is_refused) {
  for (const std::string part : {".a", ".0", ". 0", " .0", " . 0", ".\"0\"", ".'='", ".0.\"a\"",
                                 ".0a.a0", ".\"0,\"", ".-0", "\t.0"}) {
    std::string key = "0";
    for (int i = 0; i < 500'000; ++i) key += part;
    BOOST_TEST(names_all(refusal(key + " = 1\n"), {"a.toml:1", "dots", "allowed"}), part);
  }
}

BOOST_AUTO_TEST_CASE(long_lines_and_rows_of_dots_are_not_deep_keys) {
  std::string text = "# " + std::string(200, '.') + "\ndimension = 1\nnodes = [";
  for (int i = 0; i < 1000; ++i) text += fmt::format("{{position = [{}.5], mass = 0.25}},", i);
  text.back() = ']';
  BOOST_TEST(parsed(text).nodes.size() == 1000);
}

BOOST_AUTO_TEST_SUITE_END()
