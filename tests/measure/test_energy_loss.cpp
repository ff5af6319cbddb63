#include <cmath>
#include <string>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/stability/energy_loss.hpp"
#include "qddot/scene/scene_file.hpp"

BOOST_AUTO_TEST_SUITE(energy_loss)

using namespace qddot;

namespace {

struct Told {
  Summary summary;
  std::string words;
};

Told told(const std::string& scene, const char* name, const Options& options, double until) {
  Simulation run(load_scene(scene), method(name), options);
  const Summary summary = run.advance(until);
  return {summary, loss_warning(method(name), run.options(), run.model(), summary, until, 1000)};
}

double number_after(const std::string& words, const std::string& text) {
  const auto at = words.find(text);
  BOOST_TEST_REQUIRE(at != std::string::npos, words << " has no '" << text << "'");
  return std::stod(words.substr(at + text.size()));
}

std::string first_method_of(const std::string& words) {
  const std::string text = "tried at this step: ";
  const auto at = words.find(text);
  BOOST_TEST_REQUIRE(at != std::string::npos, words);
  return words.substr(at + text.size(), words.find(' ', at + text.size()) - at - text.size());
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_implicit_euler_takes_is_its_damping_ratio) {
  // The roots 1/(1 -+ i h w) have the damping ratio ln(1 + (h w)^2)/2 over that and atan(h w); here
  // w = 10 rad/s.
  const auto [summary, words] = told("oscillator", "implicit_euler", {.step_size = 0.01}, 5);
  // V is least where the mass passes its rest length, between two looks: 1 % of the energy.
  BOOST_TEST(summary.energy_loss == 1 - std::pow(1.01, -500), boost::test_tools::tolerance(0.01));
  const std::complex<double> root = std::log(std::complex(1., -0.1));
  BOOST_TEST(number_after(words, "damping ratio of ") == root.real() / std::abs(root),
             boost::test_tools::tolerance(0.05));  // as printed
  // Accelerations and speeds at 64 of 500 steps, damped on the way.
  BOOST_TEST(number_after(words, "own w = ") == 10, boost::test_tools::tolerance(0.3));
}

BOOST_AUTO_TEST_CASE(the_step_and_the_methods_that_are_named_keep_the_energy) {
  struct Case {
    const char *scene, *method;
    double h, until;
  };
  for (const auto& [scene, name, h, until] : {Case{"oscillator", "implicit_euler", 0.01, 5},
                                              {"cloth", "implicit_euler", 0.01, 0.5},
                                              {"pendulum", "bdf2", 0.1, 5},
                                              {"cloth", "bdf2", 0.03, 0.5},
                                              {"chain", "implicit_euler", 0.01, 0.5}}) {
    BOOST_TEST_CONTEXT(name << " on " << scene) {
      const auto [summary, words] = told(scene, name, {.step_size = h}, until);
      BOOST_TEST_REQUIRE(summary.energy_loss > 0.05);
      BOOST_TEST(number_after(words, "took ") > 0);
      BOOST_TEST(number_after(words, " J, ") == 100 * summary.energy_loss,
                 boost::test_tools::tolerance(0.05));  // as printed
      // A hundredth, by the theory of one vibration in place of many.
      const double finer = number_after(words, "a step of ");
      BOOST_TEST(finer < h);
      BOOST_TEST(told(scene, name, {.step_size = finer}, until).summary.energy_loss < 0.03);
      const std::string other = first_method_of(words);
      const Summary kept = told(scene, other.c_str(), {.step_size = h}, until).summary;
      BOOST_TEST(kept.energy_loss < 0.05, other << " loses " << kept.energy_loss);
      BOOST_TEST(kept.energy_growth < 1.1, other << " gains " << kept.energy_growth);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_swing_is_no_damping_and_a_kept_energy_needs_no_words) {
  // Verlet keeps v^2 + w^2 q^2 (1 - (h w)^2/4).
  bool swings = false;
  for (const double until : {1.9, 2.09, 2.28, 2.47}) {
    const auto [summary, words] = told("oscillator", "verlet", {.step_size = 0.19}, until);
    BOOST_TEST((words == "") == (summary.energy_loss <= 0.05));
    swings = swings || words.find("verlet damps no vibration") != std::string::npos;
    BOOST_TEST(words.find("damping ratio") == std::string::npos, words);
  }
  BOOST_TEST(swings);
  BOOST_TEST(told("cloth", "verlet", {.step_size = 2e-4}, 0.1).words == "");
  BOOST_TEST(told("oscillator", "exact", {.step_size = 1}, 10).words == "");
}

BOOST_AUTO_TEST_CASE(a_method_that_chooses_its_steps_is_told_to_lower_its_tolerance) {
  const auto [summary, words] = told("oscillator", "ida", {.rtol = 1e-3}, 20);
  BOOST_TEST_REQUIRE(summary.energy_loss > 0.05);
  BOOST_TEST(words.find("lower --rtol") != std::string::npos, words);
}

BOOST_AUTO_TEST_SUITE_END()
