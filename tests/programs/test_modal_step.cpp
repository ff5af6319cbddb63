#include <boost/test/unit_test.hpp>

#include "experiments/stability_map/modal_step.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/settle.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(modal_step)

using namespace qddot;
using namespace qddot::stability_map;

namespace {

Model at_rest(const char* generator, const GeneratorValues& values) {
  return Model(settled(generate(*find_generator(generator), values, generator), generator),
               Reductions::all_directions());
}

// Some masses under their weight on springs, hanging from two ends in space.
const Model& hanging_chain() {
  static const Model scene =
      at_rest("chain", {{"nodes", 8}, {"pinned_ends", 2}, {"stiffness", 500}});
  return scene;
}

double largest_omega(const std::vector<Mode>& modes) { return modes.back().omega; }

}  // namespace

BOOST_AUTO_TEST_CASE(modes_are_those_of_the_scene_and_spread_over_the_spectrum) {
  const System& system = hanging_chain().system();
  const Vec& q = hanging_chain().initial().q;
  const auto all = sampled_modes(system, q, 1000), some = sampled_modes(system, q, 5);
  BOOST_TEST(all.size() == 18u);  // 6 nodes in space; all vibrate
  BOOST_TEST(some.size() == 5u);
  BOOST_TEST(some.front().rank == 1);
  BOOST_TEST(some.back().rank == 18);
  const Eigen::MatrixXd k = dense(stiffness_at(system, q));
  for (const Mode& mode : all) {
    // Rounding of an eigenproblem, 1e-15 of |K| times the shape.
    BOOST_TEST(
        (k * mode.shape + mode.omega * mode.omega * system.mass().cwiseProduct(mode.shape)).norm() <
        1e-8);
    BOOST_TEST(mode.part == mode.omega / largest_omega(all), boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(each_mode_is_stepped_as_an_oscillator_of_its_frequency) {
  const auto modes = sampled_modes(hanging_chain().system(), hanging_chain().initial().q, 6);
  for (const Method& method : methods_of(Family::hand_written, Knob::step_size)) {
    // Up to near the limit, where what a multistep method starts with goes into its spurious roots
    // by some hundredths.
    const double h = (method.recurrence_roots ? std::min(1.0, 0.9 * *method.stability_limit) : 1) /
                     largest_omega(modes);
    // Matrices of the springs' material alone mix modes, and few iterations leave some of a mode.
    if (method.solves_stiff_part || method.listens_to(Option::iterations)) continue;
    for (const Mode& mode : modes) {
      BOOST_TEST_CONTEXT(method.name << " in mode " << mode.rank) {
        const LinearStep predicted = linear_step(method, h * mode.omega);
        const LinearStep measured =
            qddot::stability_map::modal_step(method, hanging_chain(), mode, {.step_size = h});
        // Displacements of 3e-6 of the extent: cubic forces of (3e-5)^2 = 1e-9 of the linear ones
        // in the stiff modes, 1e-6 in slow ones.
        BOOST_TEST(std::abs(measured.damping_ratio() - predicted.damping_ratio()) < 3e-6);
        BOOST_TEST(std::abs(measured.period_error() - predicted.period_error()) < 3e-6);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(what_iterations_leave_is_seen) {
  const auto modes = sampled_modes(hanging_chain().system(), hanging_chain().initial().q, 6);
  const double h = 10 / largest_omega(modes);
  const Method& method = method_named("local_global");
  double largest = 0;
  for (const Mode& mode : modes) {
    const LinearStep predicted = linear_step(method, h * mode.omega);
    const LinearStep measured = qddot::stability_map::modal_step(method, hanging_chain(), mode,
                                                                 {.step_size = h, .iterations = 1});
    largest = std::max(largest, std::abs(measured.period_error() - predicted.period_error()));
  }
  BOOST_TEST(largest > 0.05);
}

BOOST_AUTO_TEST_CASE(verdicts_are_about_what_is_left_after_periods) {
  // r = exp(-zeta w' h) at h w' = 0.1.
  const auto damped = [](double zeta) {
    const double angle = 0.1 * std::sqrt(1 - zeta * zeta);
    return LinearStep{0.1, {std::polar(std::exp(-0.1 * zeta), angle)}};
  };
  // Half the energy after ten periods: exp(-2 zeta 2 pi 10) = 1/2; a tenth of the amplitude after
  // one: exp(-zeta 2 pi) = 1/10.
  const double living = std::log(2) / (40 * M_PI), killing = std::log(10) / (2 * M_PI);
  BOOST_TEST(modal_verdict(damped(0.99 * living)) == "lives");
  BOOST_TEST(modal_verdict(damped(1.01 * living)) == "is damped");
  BOOST_TEST(modal_verdict(damped(0.99 * killing)) == "is damped");
  BOOST_TEST(modal_verdict(damped(1.01 * killing)) == "is killed");
  BOOST_TEST(modal_verdict(damped(-1e-4)) == "blows up");
}

BOOST_AUTO_TEST_SUITE_END()
