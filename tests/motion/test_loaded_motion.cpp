// Motions under constant loads: as drawn, reduced, and in closed form.
#include <boost/test/unit_test.hpp>

#include "tests/integrators/scenes.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(loaded_motion)

using namespace qddot;
using Eigen::Vector3d;

namespace {

std::vector<Node> after(const Scene& scene, const Reductions& reductions, double until) {
  return nodes_after(scene, reductions, method_named("kahan_li8"), 1e-3, until);
}

// Two masses on a spring at rest, which loads pull along their line.
constexpr double m = 1, n = 3, k = 40, l0 = 1.2, pull_of_m = -2, pull_of_n = 5;
Scene pulled_pair() {
  Scene scene{.dimension = 3, .gravity = {0.5, 0, -2}};
  const Vector3d thrown(1, 2, 0);
  scene.nodes = {
      {.position = {0, 0, 0}, .velocity = thrown, .mass = m, .load = {pull_of_m, 0, 0}},
      {.position = {l0, 0, 0}, .velocity = thrown, .mass = n, .load = {pull_of_n, 0, 0}}};
  scene.springs = {{{0, 1}, {k, l0}}};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_pair_vibrates_about_its_stretched_length_and_falls_with_all_loads) {
  const Scene scene = pulled_pair();
  // l'' = pull_of_n/n - pull_of_m/m - k (l - l0)(1/m + 1/n), from rest at l0.
  const double w2 = k * (1 / m + 1 / n), stretch = (pull_of_n / n - pull_of_m / m) / w2;
  const double t = 1.3, s = stretch * (1 - std::cos(std::sqrt(w2) * t));
  const Vector3d a = scene.gravity + Vector3d(pull_of_m + pull_of_n, 0, 0) / (m + n);
  const Vector3d centre =
      Vector3d(n * l0 / (m + n), 0, 0) + t * scene.nodes[0].velocity + t * t / 2 * a;
  const Vector3d x = centre - Vector3d(n / (m + n) * (l0 + s), 0, 0);
  const Vector3d y = centre + Vector3d(m / (m + n) * (l0 + s), 0, 0);
  for (const Reductions& reductions :
       {Reductions(), Reductions().without(Reduction::falling), Reductions::only({})}) {
    const auto nodes = after(scene, reductions, t);
    // A thousand steps of order 8 with h w = 0.007: rounding.
    BOOST_TEST((nodes[0].position - x).norm() < 1e-12);
    BOOST_TEST((nodes[1].position - y).norm() < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(the_drawn_and_the_reduced_motion_are_one) {
  Scene mirrored = draw("cloth", {{"nodes", 6}});
  mirrored.nodes[8].load = {0.1, 0.2, 0.3};
  mirrored.nodes[26].load = {-0.1, 0.2, 0.3};
  Scene on_one_half = mirrored;
  on_one_half.nodes[26].load.setZero();
  Scene flat = draw("chain", {{"nodes", 6}});
  flat.nodes[3].load = {0.5, 0, 1};
  Scene free = square();
  free.nodes[0].load = {1, 0, 0};
  free.nodes[2].load = {0, -2, 0};
  for (const Scene& scene :
       {mirrored, on_one_half, flat, turned(flat, some_rotation(), {1, 2, 3}), free}) {
    BOOST_TEST_CONTEXT(scene.name) {
      const auto reduced = after(scene, {}, 0.2), drawn = after(scene, Reductions::only({}), 0.2);
      // Hundreds of steps' rounding of a few metres, at up to 300 rad/s.
      BOOST_TEST(farthest(reduced, drawn) < 1e-9);
      // The load is no small matter in that time.
      Scene without = scene;
      for (Node& node : without.nodes) node.load.setZero();
      BOOST_TEST(farthest(reduced, after(without, {}, 0.2)) > 1e-3);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
