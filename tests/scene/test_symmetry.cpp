// A scene has a plane to lie in or a mirror, unless it deviates from it by more than rounding.
#include <numeric>

#include <boost/test/unit_test.hpp>

#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(symmetry)

using namespace qddot;

namespace {

bool is_mirrored(const Scene& scene) { return has(Model(scene), Reduction::mirror); }
bool is_flat(const Scene& scene) { return has(Model(scene), Reduction::dimension); }

Scene cloth() { return draw("cloth", {{"nodes", 6}}); }
Scene chain() { return draw("chain", {{"nodes", 6}}); }

// The scene with one thing changed.
template <class Change>
Scene with(Scene scene, const Change& change) {
  change(scene);
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_deviation_of_1e_9_in_anything_breaks_a_mirror) {
  BOOST_TEST(is_mirrored(cloth()));
  constexpr double more = 1 + 1e-9;
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.nodes[8].position.x() += 1e-9; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.nodes[8].position.z() += 1e-9; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.nodes[8].velocity.z() += 1e-9; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.nodes[8].mass *= more; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.nodes[8].pinned = true; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.gravity.x() = 1e-9; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.springs[7].law.stiffness *= more; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.springs[7].law.rest_length *= more; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.springs[7].law.quartic = 1e-9; })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) { s.springs.pop_back(); })));
}

BOOST_AUTO_TEST_CASE(a_change_on_both_sides_keeps_the_mirror) {
  // Nodes i and 30 + j - 6 i of a row are images of each other: 8 and 26.
  BOOST_TEST(is_mirrored(with(cloth(), [](Scene& s) {
    for (const std::size_t i : {8u, 26u}) s.nodes[i].mass *= 1.5;
  })));
  BOOST_TEST(is_mirrored(with(cloth(), [](Scene& s) {
    s.nodes[8].velocity = {0.1, 0.2, 0.3};
    s.nodes[26].velocity = {-0.1, 0.2, 0.3};
  })));
  BOOST_TEST(!is_mirrored(with(cloth(), [](Scene& s) {
    for (const std::size_t i : {8u, 26u}) s.nodes[i].velocity = {0.1, 0.2, 0.3};
  })));
}

BOOST_AUTO_TEST_CASE(a_mirror_is_found_wherever_it_lies_and_however_nodes_are_numbered) {
  std::mt19937 random(4);
  for (int draw = 0; draw < 20; ++draw) {
    const Eigen::Matrix3d rotation = Eigen::Quaterniond(Eigen::Vector4d::NullaryExpr([&] {
                                       return std::normal_distribution<double>()(random);
                                     }))
                                         .normalized()
                                         .toRotationMatrix();
    Scene scene = turned(cloth(), rotation, {1, -2, 3});
    std::vector<std::size_t> order(scene.nodes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, random);
    scene = renumbered(scene, order);
    // There are 36 nodes; 2 are pinned, none is on the mirror.
    BOOST_TEST(Model(scene).system().size() == 3 * 17);
  }
}

BOOST_AUTO_TEST_CASE(mirrors_of_the_coordinates_order_are_found) {
  // x and y swapped: a mirror along the diagonal.
  Scene scene{.dimension = 2, .gravity = {-1, -1, 0}};
  scene.nodes = {{.position = {0, 0, 0}, .pinned = true},
                 {.position = {1.1, 0.2, 0}, .mass = 1},
                 {.position = {0.2, 1.1, 0}, .mass = 1},
                 {.position = {1.5, 1.5, 0}, .mass = 2}};
  for (const auto& [i, j] : {std::pair(0u, 1u), {0u, 2u}, {1u, 3u}, {2u, 3u}, {1u, 2u}}) {
    scene.springs.push_back({{i, j}, {20, 1}});
  }
  // One of the two beside it, and the one on it along the diagonal.
  BOOST_TEST(Model(scene).system().size() == 3);
}

BOOST_AUTO_TEST_CASE(the_slightest_deviation_from_a_plane_of_the_coordinates_counts) {
  BOOST_TEST(is_flat(chain()));
  // Far below rounding of the chain's metre: it may be there to start a buckling.
  BOOST_TEST(!is_flat(with(chain(), [](Scene& s) { s.nodes[3].position.y() = 1e-17; })));
  BOOST_TEST(!is_flat(with(chain(), [](Scene& s) { s.nodes[3].velocity.y() = 1e-300; })));
  BOOST_TEST(!is_flat(with(chain(), [](Scene& s) { s.gravity.y() = 1e-300; })));
  // A velocity that nobody has does not.
  BOOST_TEST(is_flat(with(chain(), [](Scene& s) { s.nodes[0].velocity.y() = 1; })));
}

BOOST_AUTO_TEST_CASE(a_tilted_plane_is_left_by_little_more_than_rounding) {
  // Bent, or it would be in a plane with any gravity.
  const Scene bent = with(chain(), [](Scene& s) { s.nodes[2].position.z() = -0.1; });
  const Scene tilted = turned(bent, some_rotation(), {1, 2, 3});
  BOOST_TEST(is_flat(tilted));
  const Eigen::Vector3d normal = some_rotation() * Eigen::Vector3d::UnitY();
  BOOST_TEST(!is_flat(with(tilted, [&](Scene& s) { s.nodes[3].position += 1e-12 * normal; })));
  BOOST_TEST(!is_flat(with(tilted, [&](Scene& s) { s.nodes[3].velocity += 1e-12 * normal; })));
  BOOST_TEST(!is_flat(with(tilted, [&](Scene& s) { s.gravity += 1e-10 * normal; })));
}

BOOST_AUTO_TEST_CASE(a_pin_out_of_the_plane_counts_where_a_spring_holds_to_it) {
  const auto add_pin = [](Scene& s) {
    s.nodes.push_back({.position = {0.5, 1, 0}, .pinned = true});
  };
  BOOST_TEST(is_flat(with(chain(), add_pin)));
  BOOST_TEST(!is_flat(with(with(chain(), add_pin), [](Scene& s) {
    s.springs.push_back({{3, s.nodes.size() - 1}, {10, 0.5}});
  })));
}

BOOST_AUTO_TEST_CASE(a_node_without_mass_is_not_pulled_out_of_a_line) {
  Scene scene{.dimension = 3, .gravity = {0, 0, -9.81}};
  scene.nodes = {
      {.pinned = true}, {.position = {1, 0, 0}}, {.position = {2, 0, 0}, .pinned = true}};
  scene.springs = {{{0, 1}, {10, 0.5, 1}}, {{1, 2}, {10, 0.5, 1}}};
  const Model reduced(scene);
  BOOST_TEST(reduced.system().size() == 1);
  BOOST_TEST(Model(with(scene, [](Scene& s) { s.nodes[1].mass = 1; })).system().size() > 1);
}

BOOST_AUTO_TEST_CASE(coordinates_whose_lengths_overflow_are_left_as_they_are) {
  const Scene far = with(turned(chain(), some_rotation(), {0, 0, 0}), [](Scene& s) {
    for (Node& node : s.nodes) node.position *= 1e200;
  });
  const Model reduced(far);
  BOOST_TEST(!is_flat(far));
  BOOST_TEST(reduced.initial().q.allFinite());
  BOOST_TEST(reduced.system().size() == 15);
}

BOOST_AUTO_TEST_CASE(what_lies_in_a_mirror_is_a_plane_and_no_mirror) {
  const Model reduced(chain(), Reductions().without(Reduction::dimension));
  BOOST_TEST(!has(reduced, Reduction::mirror));
  BOOST_TEST(reduced.system().size() == 15);
}

BOOST_AUTO_TEST_CASE(large_symmetric_scenes_take_n_log_n) {
  // 10^5 springs on a grid; with n^2 pairs this test would not end.
  const Model reduced(draw("cloth", {{"nodes", 130}}));
  BOOST_TEST(has(reduced, Reduction::mirror));
}

BOOST_AUTO_TEST_SUITE_END()
