// Rods in scenes: how they are drawn, what is refused by name, what reductions leave of them, and
// the tensions of all of them.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/rods.hpp"
#include "qddot/scene/scene_arrays.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(scene_rods)

using namespace qddot;

namespace {

Scene parsed(const std::string& text) { return parse_scene(text, "the text", "."); }

// A pin at zero and masses at the other places, in the plane.
std::string nodes_at(const std::string& places, const std::string& more = "") {
  std::string text = "dimension = 2\n[[nodes]]\nposition = [0, 0]\npinned = true\n";
  std::string::size_type from = 0;
  while (from < places.size()) {
    const auto to = places.find(';', from);
    text += "[[nodes]]\nposition = [" + places.substr(from, to - from) + "]\nmass = 1\n" + more;
    from = to + 1;
  }
  return text;
}
std::string rod(int i, int j, const std::string& more = "") {
  return "[[rods]]\nnodes = [" + std::to_string(i) + ", " + std::to_string(j) + "]\n" + more;
}

std::string words_on(const std::string& text) {
  return refusal_of([&] { parsed(text); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_rod_is_as_long_as_drawn_or_as_given) {
  const Scene scene = parsed(nodes_at("3, 4;3, 5;") + rod(0, 1) + rod(1, 2, "length = 1.0\n"));
  BOOST_TEST_REQUIRE(scene.springs.size() == 2u);
  BOOST_TEST(scene.springs[0].law.rigid);
  BOOST_TEST(scene.springs[0].law.rest_length == 5);
  BOOST_TEST(scene.springs[1].law.rest_length == 1);
  const Scene again = parsed(to_toml(scene));
  BOOST_TEST(content_hash(again) == content_hash(scene));
  Scene without = scene;
  without.springs[0].law.rigid = false;
  BOOST_TEST(content_hash(without) != content_hash(scene));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_a_rod_is_refused_by_its_nodes) {
  const std::string two = nodes_at("1, 0;2, 0;");
  BOOST_TEST(words_on(two + rod(0, 1) + rod(1, 2, "length = 1.1\n"))
                 .find("the rod between nodes 1 and 2 is 1.1") != std::string::npos);
  BOOST_TEST(words_on(nodes_at("1, 0;", "velocity = [0.5, 1]\n") + rod(0, 1))
                 .find("would change its length by 0.5 m/s") != std::string::npos);
  BOOST_TEST(words_on(two + "[[nodes]]\nposition = [3, 0]\nmass = 0\n" + rod(2, 3))
                 .find("has node 3 without mass") != std::string::npos);
  BOOST_TEST(words_on(two + "[[nodes]]\nposition = [3, 0]\npinned = true\n" + rod(0, 3))
                 .find("joins two pinned nodes") != std::string::npos);
  BOOST_TEST(words_on("start = \"equilibrium\"\n" + two + rod(0, 1)).find("scenes with rods") !=
             std::string::npos);
  BOOST_TEST(words_on(two + rod(0, 1, "lenght = 1\n")).find("lenght") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(rods_that_are_too_many_are_found) {
  const auto is_too_many = [](const std::string& text) {
    return words_on(text).find("is one too many") != std::string::npos;
  };
  // A square of rods may have one diagonal, and a second one only in space.
  const std::string square =
      nodes_at("1, 0;1, 1;0, 1;") + rod(0, 1) + rod(1, 2) + rod(2, 3) + rod(3, 0);
  BOOST_TEST(!parsed(square).springs.empty());
  BOOST_TEST(!parsed(square + rod(0, 2)).springs.empty());
  BOOST_TEST(is_too_many(square + rod(0, 2) + rod(1, 3)));
  // Two rods between the same nodes; a row taut between two pins, and the same row bent.
  BOOST_TEST(is_too_many(nodes_at("1, 0;") + rod(0, 1) + rod(0, 1)));
  const std::string pin = "[[nodes]]\nposition = [3, 0]\npinned = true\n";
  const std::string row = rod(0, 1) + rod(1, 2) + rod(2, 3);
  BOOST_TEST(is_too_many(nodes_at("1, 0;2, 0;") + pin + row));
  BOOST_TEST(!is_too_many(nodes_at("1, 0.1;2, 0;") + pin + row));
  // A long chain has as many rods as nodes, and none is redundant.
  std::string places, rods;
  for (int i = 1; i <= 300; ++i) {
    places += std::to_string(i) + ", 0;";
    rods += rod(i - 1, i);
  }
  BOOST_TEST(parsed(nodes_at(places) + rods).springs.size() == 300u);
}

BOOST_AUTO_TEST_CASE(springs_above_a_stiffness_become_rods) {
  const Scene hem = parsed("rods_above = 1e6\n[generator]\nkind = \"hemmed_cloth\"\nnodes = 14\n");
  BOOST_TEST(std::ranges::count_if(hem.springs, [](const Spring& s) { return s.law.rigid; }) == 39);
  // The frame's side between two pins is taut.
  BOOST_TEST(words_on("rods_above = 1e6\n[generator]\nkind = \"framed_cloth\"\nnodes = 8\n")
                 .find("is one too many") != std::string::npos);
  // Springs out of their rest length hold energy, which a rod would forget.
  BOOST_TEST(words_on("rods_above = 100\n" + nodes_at("1, 0;") +
                      "[[springs]]\nnodes = [0, 1]\nstiffness = 200\nrest_length = 0.9\n")
                 .find("is 0.9") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(arrays_have_rods) {
  SceneArrays arrays{.positions = Eigen::MatrixXd{{0, 0}, {1, 0}, {2, 0}},
                     .springs = {{0, 1}, {1, 2}},
                     .mass = Eigen::VectorXd::Ones(1),
                     .stiffness = Eigen::VectorXd::Constant(1, 50),
                     .pinned = {0}};
  arrays.rigid = Eigen::Vector2d(0, 1);
  const Scene scene = scene_of(arrays);
  BOOST_TEST(!scene.springs[0].law.rigid);
  BOOST_TEST(scene.springs[1].law.rigid);
  BOOST_TEST(scene.springs[1].law.stiffness == 0);
}

// Two pendulums, one on a slope of space, beside a free mass: parts, the plane of one, and the
// tensions of both, in the order of Model::rods().
BOOST_AUTO_TEST_CASE(reductions_keep_rods_and_their_tensions) {
  Scene scene{.dimension = 3, .gravity = {0, 0, -9.81}};
  const Eigen::Vector3d slope = Eigen::Vector3d(1, 2, 2) / 3;
  scene.nodes = {{.position = {5, 5, 5}, .mass = 1},
                 {.position = {0, 0, 0}, .pinned = true},
                 {.position = 0.5 * slope, .mass = 2},
                 {.position = {0, 0, -1}, .velocity = {3, 0, 0}, .mass = 4}};
  const SpringLaw half{.rest_length = (0.5 * slope).norm(), .rigid = true};
  scene.springs = {{{1, 2}, half}, {{3, 1}, {.rest_length = 1, .rigid = true}}};
  const Model model(scene);
  BOOST_TEST(model.system().size() == 4);  // each in its plane
  BOOST_TEST(is_constrained(model.system()));
  BOOST_TEST_REQUIRE(model.rods().size() == 2u);
  const Vec tensions = model.tensions(model.initial());
  for (Index k = 0; k < 2; ++k) {
    const bool is_sloped = model.rods()[static_cast<std::size_t>(k)] == 0;
    // m g cos + m v^2/L, with the angle from below.
    const double expected = is_sloped ? -2 * 9.81 * 2 / 3. : 4 * 9.81 + 4 * 9;
    BOOST_TEST(std::abs(tensions[k] - expected) < 1e-12 * 100);
  }
  // Pins are left out in any case.
  const Model kept(scene, Reductions().without(Reduction::pins).without(Reduction::dimension));
  BOOST_TEST(kept.system().size() == 6);
}

// All kinds of reductions: a mirrored cloth, a planar chain, a free body that falls and turns.
BOOST_AUTO_TEST_CASE(nodes_lead_back_to_their_state) {
  Scene body{.dimension = 3, .gravity = {0, 0, -9.81}};
  body.nodes = {{.position = {0, 0, 0}, .velocity = {1, 2, 0}, .mass = 1},
                {.position = {1, 0, 0}, .velocity = {1, 3, 0.5}, .mass = 2}};
  body.springs = {{{0, 1}, {50, 1}}};
  for (const Scene& scene : {load_scene("cloth"), load_scene("chain"), body}) {
    const Model model(scene);
    State state = model.initial();
    state.t = 0.3;
    for (Index i = 0; i < state.q.size(); ++i) {
      state.q[i] += 0.01 * std::sin(3. * static_cast<double>(i));
      state.v[i] += 0.1 * std::cos(2. * static_cast<double>(i));
    }
    const State again = model.collect(model.expand(state), state.t);
    // Rotations and falls round a few times.
    BOOST_TEST((again.q - state.q).lpNorm<Eigen::Infinity>() < 1e-14);
    BOOST_TEST((again.v - state.v).lpNorm<Eigen::Infinity>() < 1e-14);
  }
}

BOOST_AUTO_TEST_SUITE_END()
