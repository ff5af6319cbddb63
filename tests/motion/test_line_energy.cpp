// Energies on lines that cannot turn are those of the strains, however small these are.
#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/reduce/part.hpp"
#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(line_energy)

using namespace qddot;

namespace {

long double potential_in_full(const Scene& scene, const std::vector<Node>& nodes) {
  long double v = 0;
  for (const Spring& spring : scene.springs) {
    const long double l = std::abs(static_cast<long double>(nodes[spring.nodes[1]].position.x()) -
                                   nodes[spring.nodes[0]].position.x());
    const long double s = l - spring.law.rest_length;
    v += 0.5L * spring.law.stiffness * s * s;
  }
  for (const Node& node : nodes) {
    if (!node.pinned)
      v -= static_cast<long double>(node.mass) * scene.gravity.x() * node.position.x();
  }
  return v;
}

// A row of masses whose springs are stretched by `strain`, held at none, one or both ends.
Scene row(double strain, int pins, int nodes) {
  Scene scene{.dimension = 1};
  for (int i = 0; i < nodes; ++i) {
    scene.nodes.push_back({.position = {(1 + strain) * i, 0, 0},
                           .mass = 1 + 0.1 * i,
                           .pinned = (i == 0 && pins > 0) || (i == nodes - 1 && pins > 1)});
    if (i > 0) {
      scene.springs.push_back(
          {{static_cast<std::size_t>(i - i % 2), static_cast<std::size_t>(i - 1 + i % 2)},
           {100, 1}});
    }
  }
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_strain_of_1e_8_has_all_digits_of_its_energy) {
  for (const double strain : {1e-4, 1e-8, 1e-12}) {
    for (const int pins : {0, 1, 2}) {
      for (const int nodes : {2, 5, 30}) {
        if (pins == nodes) continue;
        const Scene scene = row(strain, pins, nodes);
        const Model reduced(scene);
        BOOST_TEST(reduced.parts().front().is_straightened());
        const auto v = static_cast<double>(potential_in_full(scene, scene.nodes));
        // Differences of neighbours lose no digit (Sterbenz). Mirrors place one half by the other,
        // with a tolerance of 64 eps of up to 30 m beside the strain.
        const bool is_mirrored = reduced.parts().front().mirrors().count > 0;
        const double relative = is_mirrored ? 1e3 * eps * nodes / strain : 100 * eps;
        BOOST_TEST(std::abs(reduced.potential(reduced.initial()) - v) <= relative * v,
                   strain << " " << pins << " " << nodes);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_energy_of_an_exact_motion_is_kept_to_rounding_of_its_strains) {
  const double strain = 1e-8;
  const Scene scene = row(strain, 1, 5);
  const Model reduced(scene, Reductions().without(Reduction::mirror));
  BOOST_TEST(reduced.parts().front().is_straightened());
  const double start = reduced.energy(reduced.initial());
  State state = reduced.initial();
  const auto exact = make_integrator(*find_method("exact"), reduced.system(), {.step_size = 0.1});
  for (int i = 1; i <= 20; ++i) {
    BOOST_TEST(exact->advance(state, 0.1 * i).message == "");
    // Positions of up to 4 m are rounded some ten times, beside a strain of 1e-8 m.
    BOOST_TEST(std::abs(reduced.energy(state) - start) < 100 * 4 * eps / strain * start);
  }
}

BOOST_AUTO_TEST_CASE(weights_and_mirrors_count_too) {
  Scene scene = row(1e-8, 1, 6);
  scene.gravity.x() = 1e-7;
  const Model reduced(scene);
  State state = reduced.initial();
  for (Index i = 0; i < state.q.size(); ++i)
    state.q[i] += 1e-9 * std::sin(2. * static_cast<double>(i));
  const auto nodes = reduced.expand(state);
  const auto v = static_cast<double>(potential_in_full(scene, nodes));
  BOOST_TEST(std::abs(reduced.potential(state) - v) < 100 * eps * 6 * 6 * 1e-7);
}

BOOST_AUTO_TEST_SUITE_END()
