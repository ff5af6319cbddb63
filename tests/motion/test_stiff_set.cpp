// Springs that a scene names stiff stay so through all that is reduced, and nothing else changes.
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/part.hpp"
#include "tests/integrators/scenes.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(stiff_set)

using namespace qddot;

namespace {

// A system, or each of its parts, with its own unknowns of q.
template <class Action>
void for_each_whole(const System& system, const Vec& q, const Action& action) {
  const auto blocks = system.blocks();
  if (blocks.empty()) return action(system, q);
  Index at = 0;
  for (const auto& block : blocks) {
    action(*block, Vec(q.segment(at, block->size())));
    at += block->size();
  }
}

// V of the stiff springs of all parts.
double stiff_potential(const Model& reduced, const Vec& q) {
  double v = 0;
  for_each_whole(reduced.system(), q, [&](const System& part, const Vec& own) {
    BOOST_TEST_REQUIRE(part.split());
    v += part.split()->stiff->potential(own);
  });
  return v;
}

// V of the drawn springs that are stiff, between all nodes of the scene.
double stiff_potential_by_hand(const Scene& scene, const std::vector<Node>& nodes) {
  double v = 0;
  for (const Spring& spring : scene.springs) {
    const auto [a, b] = spring.nodes;
    if (nodes[a].pinned && nodes[b].pinned) continue;
    if (is_stiff(spring.law, scene.stiff_above))
      v += spring.law.energy((nodes[b].position - nodes[a].position).norm());
  }
  return v;
}

// Whether V, f and K of the stiff and the soft springs add up to those of the whole. Rounding is
// that of some 30 springs at a node.
bool adds_up(const Model& reduced, const Vec& q) {
  bool good = true;
  for_each_whole(reduced.system(), q, [&](const System& part, const Vec& own) {
    BOOST_TEST_REQUIRE(part.split());
    const System &stiff = *part.split()->stiff, &soft = *part.split()->soft;
    const auto close = [&](const auto& one, const auto& two, const auto& all) {
      const double scale = one.cwiseAbs().sum() + two.cwiseAbs().sum() + all.cwiseAbs().sum();
      good = good && distance(one + two, all) <= 100 * eps * scale;
    };
    const Vec v{{stiff.potential(own)}}, w{{soft.potential(own)}}, all{{part.potential(own)}};
    close(v, w, all);
    close(force_at(stiff, own), force_at(soft, own), force_at(part, own));
    close(dense(stiffness_at(stiff, own)), dense(stiffness_at(soft, own)),
          dense(stiffness_at(part, own)));
  });
  return good;
}

// A state beside the start.
State moved(const Model& reduced) {
  State state = reduced.initial();
  for (Index i = 0; i < state.q.size(); ++i) state.q[i] += 0.01 * std::sin(1.7 * double(i));
  return state;
}

Scene named(Scene scene, double stiff_above) {
  scene.stiff_above = stiff_above;
  return scene;
}

// Mirrors, planes, parts, duplicates, pins and a straight line, with a border of stiffness between
// two kinds of springs.
std::vector<Scene> scenes() {
  std::mt19937 random(2);
  std::vector<Scene> all = {draw("framed_cloth", {{"nodes", 6}}),
                            draw("framed_cloth", {{"nodes", 7}, {"frame_stiffness", 3000}}),
                            named(draw("cloth", {{"nodes", 5}}), 300),
                            named(draw("chain", {{"nodes", 6}}), 1),
                            named(draw("chain", {{"nodes", 6}}), 1e9),
                            named(square(), 60),
                            named(square(3), 60),
                            named(turned(square(), some_rotation(), {1, 2, 3}), 60)};
  for (const int dimension : {1, 2, 3}) {
    Scene bodies{.dimension = dimension, .gravity = {1, 0, 0}};
    for (const double x : {0., 20.}) add_random_body(random, 6, {x, 0, 0}, bodies);
    bodies.nodes[2].pinned = bodies.nodes[4].pinned = true;
    bodies.nodes.push_back({.position = {50, 0, 0}, .velocity = {1, 0, 0}, .mass = 1});
    bodies.springs.push_back(bodies.springs[0]);
    bodies.springs.push_back(bodies.springs[1]);
    bodies.springs.back().law.stiffness *= 2;
    all.push_back(named(bodies, 125));
  }
  return all;
}

// A massless node between a pin and a mass: 30 and 60 N/m in series are 20 N/m.
Scene in_series() {
  Scene scene;
  scene.nodes = {{.pinned = true},
                 {.position = {0.6, 0, 0}},
                 {.position = {1.2, 0, 0}, .velocity = {0, 1, 0}, .mass = 2}};
  scene.springs = {{{0, 1}, {30, 0.5}}, {{2, 1}, {60, 0.4}}};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(naming_stiff_springs_changes_no_bit_of_anything_else) {
  for (const Scene& scene : scenes()) {
    Scene unnamed = scene;
    unnamed.stiff_above.reset();
    for (const Reductions& reductions : with_and_without) {
      const Model a(scene, reductions), b(unnamed, reductions);
      const Vec q = moved(a).q;
      BOOST_TEST_REQUIRE(a.system().size() == b.system().size());
      BOOST_TEST((a.initial().q == b.initial().q && a.initial().v == b.initial().v));
      BOOST_TEST((a.system().mass() == b.system().mass()));
      BOOST_TEST(a.system().potential(q) == b.system().potential(q));
      BOOST_TEST((force_at(a.system(), q) == force_at(b.system(), q)));
      BOOST_TEST((dense(stiffness_at(a.system(), q)) == dense(stiffness_at(b.system(), q))));
      BOOST_TEST(a.system().stiffness_is_constant() == b.system().stiffness_is_constant());
      BOOST_TEST(a.findings().size() == b.findings().size());
      for_each_whole(b.system(), q,
                     [](const System& part, const Vec&) { BOOST_TEST(!part.split()); });
    }
  }
}

BOOST_AUTO_TEST_CASE(stiff_and_soft_are_together_the_whole_and_stiff_is_what_was_drawn_stiff) {
  for (const Scene& scene : scenes()) {
    for (const Reductions& reductions :
         {Reductions(), Reductions::only({Reduction::pins}), Reductions::only({}),
          Reductions().without(Reduction::parts), Reductions().without(Reduction::free_flight)}) {
      const Model reduced(scene, reductions);
      for (const State& state : {reduced.initial(), moved(reduced)}) {
        BOOST_TEST(adds_up(reduced, state.q));
        if (!reductions.has(Reduction::pins)) continue;  // moved as well
        // Two springs that become one are both stiff if one is: the sum by hand does not apply.
        if (scene.springs.back().law.rest_length == scene.springs[1].law.rest_length) continue;
        const double v = stiff_potential_by_hand(scene, reduced.expand(state));
        BOOST_TEST(std::abs(stiff_potential(reduced, state.q) - v) <= 400 * eps * (1 + v));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_stiff_pattern_of_a_frame_has_no_more_than_its_border) {
  const Scene scene = draw("framed_cloth", {{"nodes", 6}});
  const auto entries = [&](const Reductions& reductions) {
    const Model reduced(scene, reductions);
    return reduced.system().split()->stiff->stiffness_pattern().nonZeros();
  };
  // Blocks of 6 entries for the diagonal, and of 9 for each border spring between free nodes. A
  // half has 17 nodes; its spring across the mirror is a node's own.
  BOOST_TEST(entries(Reductions().without(Reduction::mirror)) == 34 * 6 + 16 * 9);
  BOOST_TEST(entries({}) == 17 * 6 + 7 * 9);
}

BOOST_AUTO_TEST_CASE(of_springs_that_become_one_the_one_is_stiff_if_any_is) {
  Scene scene{.dimension = 2};
  scene.nodes = {{.pinned = true}, {.position = {1, 0, 0}, .velocity = {0, 1, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {40, 0.9}}, {{1, 0}, {70, 0.9}}, {{0, 1}, {50, 0.8}}};
  const auto stiff = [&](double above) {
    const Model reduced(named(scene, above));
    return stiff_potential(reduced, reduced.initial().q);
  };
  const double one = 55 * 0.1 * 0.1, two = 25 * 0.2 * 0.2;  // 110 N/m of 0.9 m, 50 N/m of 0.8 m
  const auto close = boost::test_tools::tolerance(100 * eps);
  for (const bool is_reversed : {false, true}) {
    if (is_reversed) std::ranges::reverse(scene.springs);
    BOOST_TEST(stiff(30) == one + two, close);
    BOOST_TEST(stiff(45) == one + two, close);
    BOOST_TEST(stiff(60) == one, close);
    BOOST_TEST(stiff(70) == 0);   // no more than
    BOOST_TEST(stiff(100) == 0);  // though their sum is: none was drawn so
  }
}

BOOST_AUTO_TEST_CASE(images_on_both_sides_of_the_border_are_one_stiff_spring) {
  // Edges of 80 N/m stretched by 0.4 m, opposite ones being images of each other; one of the four
  // is stiffer by a rounding.
  for (const std::size_t edge : {0u, 2u, 4u, 6u}) {
    Scene scene = named(square(), 80);
    scene.springs[edge].law.stiffness = std::nextafter(80, 100);
    const Model reduced(scene);
    BOOST_TEST(has(reduced, Reduction::mirror));
    BOOST_TEST(adds_up(reduced, reduced.initial().q));
    BOOST_TEST(stiff_potential(reduced, reduced.initial().q) == 2 * 40 * 0.4 * 0.4,
               boost::test_tools::tolerance(100 * eps));
  }
}

BOOST_AUTO_TEST_CASE(a_series_is_stiff_where_the_spring_that_it_is_would_be) {
  const double v = 10 * 0.3 * 0.3;  // 20 N/m, 0.9 m long, drawn out to 1.2 m
  for (const auto& [above, energy] : {std::pair(19.9, v), {20.1, 0.}, {40., 0.}, {80., 0.}}) {
    const Model reduced(named(in_series(), above));
    BOOST_TEST(has(reduced, Reduction::massless));
    BOOST_TEST(adds_up(reduced, reduced.initial().q));
    BOOST_TEST(stiff_potential(reduced, reduced.initial().q) == energy,
               boost::test_tools::tolerance(100 * eps));
  }
  // Left as drawn, each spring counts for itself.
  const Model drawn(named(in_series(), 40), Reductions().without(Reduction::massless));
  BOOST_TEST(stiff_potential(drawn, drawn.initial().q) == 30 * 0.2 * 0.2,
             boost::test_tools::tolerance(100 * eps));
}

BOOST_AUTO_TEST_CASE(on_a_line_stiff_springs_keep_their_rest_length) {
  // Unlike springs, no mirror; all stretched or compressed by 0.1 m.
  Scene scene{.dimension = 1, .gravity = {2, 0, 0}, .stiff_above = 500};
  for (int i = 0; i < 5; ++i) {
    scene.nodes.push_back(
        {.position = {1.0 * i, 0, 0}, .mass = 1.0 + i, .pinned = i == 0 || i == 4});
  }
  scene.springs = {
      {{0, 1}, {1000, 1.1}}, {{2, 1}, {1e4, 0.9}}, {{2, 3}, {400, 1.1}}, {{3, 4}, {2000, 1.1}}};
  const Model reduced(scene);
  BOOST_TEST(reduced.parts().front().is_straightened());
  const Vec& q = reduced.initial().q;
  const System& stiff = *reduced.system().split()->stiff;
  BOOST_TEST(stiff.stiffness_is_constant());
  BOOST_TEST(adds_up(reduced, q));
  // tau = -100, 1000 and -200 N; each term k l of up to 4e4 is rounded.
  BOOST_TEST(distance(force_at(stiff, q), Vec{{100 + 1000, -1000, -200}}) < 10 * eps * 4e4);
  const Vec weight_and_soft{{2 * 2., 3 * 2. - 40, 4 * 2. + 40}};
  BOOST_TEST(distance(force_at(*reduced.system().split()->soft, q), weight_and_soft) <
             10 * eps * 4e4);
}

BOOST_AUTO_TEST_CASE(every_part_offers_a_split_whatever_springs_it_has) {
  Scene scene{.dimension = 2, .stiff_above = 100};
  for (const double k : {50., 500.}) {
    const std::size_t first = scene.nodes.size();
    for (const double y : {0., 1.}) {
      scene.nodes.push_back({.position = {k, y, 0}, .velocity = {y, 0, 0}, .mass = 1 + y});
    }
    scene.springs.push_back({{first, first + 1}, {k, 0.9}});
  }
  const Model reduced(scene);
  BOOST_TEST_REQUIRE(reduced.system().blocks().size() == 2u);
  for (const auto& block : reduced.system().blocks()) BOOST_TEST_REQUIRE(block->split());
  BOOST_TEST(stiff_potential(reduced, reduced.initial().q) == 250 * 0.1 * 0.1,
             boost::test_tools::tolerance(100 * eps));
  for (Node& node : scene.nodes) node.pinned = true;
  BOOST_TEST(Model(scene).system().split());
  BOOST_TEST(Model(scene, Reductions::only({})).system().split());
}

BOOST_AUTO_TEST_CASE(a_border_that_is_no_positive_number_is_refused) {
  for (const double bad : {0., -0., -1., double(NAN), double(INFINITY)}) {
    const std::string message = refusal_of([&] { validate(named(square(), bad), "a.toml"); });
    BOOST_TEST(names_all(message, {"a.toml: stiff_above: ", "allowed", "above 0"}), message);
  }
  validate(named(square(), 5e-324), "a.toml");
}

BOOST_AUTO_TEST_SUITE_END()
