// Rods across and beside a mirror: the motion and the tensions of half of the unknowns are those of
// all.
#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/model.hpp"
#include "tests/mirrored_linkage.hpp"

BOOST_AUTO_TEST_SUITE(mirrored_rods)

using namespace qddot;

namespace {

struct End {
  Outcome outcome;
  std::vector<Node> nodes;
  std::vector<double> tensions;  // of all rods, by their numbers in the scene
};

End end_of(const Model& model, const Scene& scene, const char* method, const Options& options) {
  const auto integrator = make_integrator(*find_method(method), model.system(), options);
  State state = model.initial();
  const Outcome outcome = integrator->advance(state, 0.25 * scene.until.value_or(1)).outcome;
  End end{outcome, model.expand(state), std::vector<double>(scene.springs.size(), 0)};
  const Vec own = model.tensions(state);
  for (std::size_t k = 0; k < model.rods().size(); ++k)
    end.tensions[model.rods()[k]] = own[static_cast<Index>(k)];
  return end;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_half_moves_as_the_whole) {
  int scenes = 0, with_crossing_rod = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto scene = mirrored_linkage(seed);
    if (!scene) continue;
    const Model half(*scene), whole(*scene, Reductions().without(Reduction::mirror));
    if (half.system().size() == whole.system().size()) continue;
    ++scenes;
    with_crossing_rod += seed % 8 < 4;
    BOOST_TEST(half.rods().size() == whole.rods().size());
    Options options;
    options.step_size = 0.25 * scene->until.value_or(1) / 64;
    for (const char* method : {"rattle", "rattle8"}) {
      const End a = end_of(half, *scene, method, options),
                b = end_of(whole, *scene, method, options);
      BOOST_TEST_REQUIRE((a.outcome == b.outcome));
      if (a.outcome != Outcome::reached_end) continue;  // the step is too large for both
      // Constraints are solved to some roundings, which these motions enlarge a little.
      double largest = 1;
      for (std::size_t e = 0; e < a.tensions.size(); ++e)
        largest = std::max(largest, std::abs(b.tensions[e]));
      for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        BOOST_TEST((a.nodes[i].position - b.nodes[i].position).norm() < 1e-10, "seed " << seed);
        BOOST_TEST((a.nodes[i].velocity - b.nodes[i].velocity).norm() < 1e-9, "seed " << seed);
      }
      for (std::size_t e = 0; e < a.tensions.size(); ++e)
        BOOST_TEST(std::abs(a.tensions[e] - b.tensions[e]) < 1e-8 * largest,
                   "seed " << seed << ", rod " << e);
    }
  }
  BOOST_TEST(scenes >= 20);
  BOOST_TEST(with_crossing_rod >= 5);
}

BOOST_AUTO_TEST_SUITE_END()
