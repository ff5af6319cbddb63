// Simulations as other programs make them, of scenes and of own systems.
#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/speed/work_precision.hpp"
#include "qddot/measure/trend/drift_run.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/integrators/own_system.hpp"

BOOST_AUTO_TEST_SUITE(simulation)

using namespace qddot;

namespace {

// A chain with Lennard and Jones' bonds, its nodes a little off their places.
struct OwnChain {
  std::shared_ptr<const System> system = std::make_shared<const ChainWithStiffness>();
  State start{0, Vec(8), Vec::Zero(8)};
};
OwnChain own_chain() {
  OwnChain chain;
  for (Index i = 0; i < 4; ++i) {
    chain.start.q[2 * i] = static_cast<double>(i + 1) + 0.02 * std::sin(3. * double(i));
    chain.start.q[2 * i + 1] = 0.05 * std::cos(2. * double(i));
  }
  return chain;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_the_run_of_the_smallest_model_with_the_scales_of_the_scene) {
  for (const char* scene_name : {"cloth", "pendulum", "strut"}) {
    const Scene scene = load_scene(scene_name);
    for (const Method* m : {&method("verlet"), &method("dprkn8"), &method("arkode_dirk4")}) {
      BOOST_TEST_CONTEXT(scene_name << " " << m->name) {
        const Options options{.step_size = 1e-3, .rtol = 1e-6};
        Simulation run(scene, *m, options);
        BOOST_TEST(qddot::name(run.advance(0.02).outcome) == "reached_end");
        const Model model = reduced_for(*m, scene);
        State state = model.initial();
        make_integrator(*m, model.system(), with_tolerance_scales(options, model))
            ->advance(state, 0.02);
        BOOST_TEST((run.state().q.array() == state.q.array()).all());
        BOOST_TEST((run.state().v.array() == state.v.array()).all());
        BOOST_TEST(run.nodes().size() == scene.nodes.size());
        BOOST_TEST(run.energy() == model.energy(state));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(it_goes_on_where_it_ended) {
  Simulation run(load_scene("cloth"), method("verlet"), {.step_size = 1e-3});
  Simulation whole(load_scene("cloth"), method("verlet"), {.step_size = 1e-3});
  run.advance(0.01);
  run.advance(0.02);
  whole.advance(0.02);
  BOOST_TEST(run.state().t == 0.02);
  // The same steps, but for the rounding of the force that a new run begins with: none.
  BOOST_TEST((run.state().q - whole.state().q).lpNorm<Eigen::Infinity>() < 1e-12);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused_in_a_sentence) {
  BOOST_CHECK_THROW(method("vermet"), std::invalid_argument);
  const Scene cloth = load_scene("cloth");
  BOOST_CHECK_THROW(Simulation(cloth, method("exact"), {.step_size = 1}), std::invalid_argument);
  BOOST_CHECK_THROW(Simulation(cloth, method("verlet"), {}), std::invalid_argument);
  const auto chain = own_chain();
  BOOST_CHECK_THROW(Simulation(chain.system, {0, Vec::Zero(1), Vec::Zero(1)}, 2, method("verlet"),
                               {.step_size = 1e-3}),
                    std::invalid_argument);
  BOOST_CHECK_THROW(Simulation(chain.system, chain.start, 7, method("verlet"), {.step_size = 1e-3}),
                    std::invalid_argument);
  const Model model(chain.system, chain.start, 2);
  BOOST_CHECK_THROW(work_precision(model, 1, {&method("exact")}), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(an_own_system_is_charted_against_a_certified_reference) {
  const auto chain = own_chain();
  const Model model(chain.system, chain.start, 2);
  const double until = 0.5;
  const auto chart = work_precision(model, until, {&method("verlet"), &method("arkode_dirk4")},
                                    {.seconds = 0.5, .repeats = 1}, 2);
  BOOST_TEST(chart.reference.certified.position < 1e-9);
  // Another method agrees with the reference to what it was told, a hundred times over.
  Simulation other(chain.system, chain.start, 2, method("dprkn12"), {.rtol = 1e-12});
  other.advance(until);
  BOOST_TEST((other.state().q - chart.reference.end.q).lpNorm<Eigen::Infinity>() < 1e-9);
  int reached = 0;
  for (const Point& point : chart.points) {
    if (point.outcome == Outcome::reached_end && point.errors.position < 1e-3) ++reached;
  }
  BOOST_TEST(reached >= 4);
  BOOST_TEST(chart.front().front().fastest != nullptr);
}

BOOST_AUTO_TEST_CASE(where_energy_goes_is_a_call) {
  const Scene scene = load_scene("oscillator");
  const auto verdict_of = [&](const char* name) {
    const DriftRun run = energy_trend(scene, method(name), {.step_size = 0.02}, 200);
    BOOST_TEST(qddot::name(run.summary.outcome) == "reached_end", name);
    return run.energy.verdict;
  };
  BOOST_TEST((verdict_of("verlet") == Verdict::bounded));
  BOOST_TEST((verdict_of("implicit_euler") == Verdict::dissipates));
}

BOOST_AUTO_TEST_SUITE_END()
