#include <boost/test/unit_test.hpp>

#include "qddot/measure/advice/own_frequencies.hpp"
#include "qddot/measure/motion/simulation.hpp"

BOOST_AUTO_TEST_SUITE(own_frequencies)

using namespace qddot;
using measure::OwnFrequencies;

namespace {

// Two masses on a line, each on its own spring of rest length 0. A weak spring joins them to one
// part. They vibrate with nearly `slow` and `fast` [rad/s], with amplitudes 1 and `share`.
Scene two_vibrations(double slow, double fast, double share) {
  Scene scene{.name = "two", .dimension = 1};
  scene.nodes = {
      {.pinned = true}, {.position = {1, 0, 0}, .mass = 1}, {.position = {share, 0, 0}, .mass = 1}};
  scene.springs = {
      {{0, 1}, {slow * slow}}, {{0, 2}, {fast * fast}}, {{1, 2}, {1e-9 * slow * slow}}};
  return scene;
}

OwnFrequencies of(const Scene& scene, double until, double w_max) {
  const Model model(scene);
  std::vector<State> path;
  Simulation run(scene, method("exact"), {.step_size = until});
  Observer observer{{}, [&](const State& state) { path.push_back(state); }};
  for (int i = 1; i <= 40; ++i) observer.times.push_back(until * i / 40);
  run.advance(until, observer);
  return measure::own_frequencies(model, path, w_max, 20);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_single_vibration_has_its_own_frequency_at_all_orders) {
  Scene scene = two_vibrations(3, 3, 0);
  scene.nodes.pop_back();
  scene.springs.resize(1);
  const OwnFrequencies own = of(scene, 17, 3);
  // The largest of few samples of sines and cosines has an error of some percent, reduced by the
  // p-th root. Differences over h w = 1/2 have an error of 1 %.
  for (int p = 2; p <= 10; p += 2) BOOST_TEST(std::abs(own.at(p) / 3 - 1) < 0.15, p);
  // |q'| over the largest |q - q(0)|, which is twice the amplitude: w / (2 sqrt 2).
  BOOST_TEST(std::abs(own.speed / (3 / std::sqrt(8)) - 1) < 0.15);
}

BOOST_AUTO_TEST_CASE(rounding_is_no_vibration) {
  // Bursts are made for a fast vibration that the motion has not. From order 4 on, differences of
  // the slow one, (h slow)^5 = 3e-22, are far below their rounding.
  const double slow = 1, fast = 1e4;
  const OwnFrequencies own = of(two_vibrations(slow, fast, 0), 9, fast);
  // They go on as those before, whose few samples are off by some percent.
  for (int p = 2; p <= 10; p += 2) BOOST_TEST(std::abs(own.at(p) / slow - 1) < 0.3, p);
}

BOOST_AUTO_TEST_CASE(a_fast_vibration_of_small_amplitude_shows_at_high_orders) {
  // It counts by share w^(p+1) at order p: from the p on at which share (fast/slow)^(p+1) is above
  // 1.
  const double slow = 1, fast = 20, share = 1e-6;
  const OwnFrequencies own = of(two_vibrations(slow, fast, share), 9, fast);
  BOOST_TEST(std::abs(own.at(2) / slow - 1) < 0.2);
  const double expected = std::pow(share * std::pow(fast / slow, 11), 0.1);  // of p = 10
  BOOST_TEST(std::abs(own.at(10) / expected - 1) < 0.2);
  BOOST_TEST(own.at(10) > 4 * own.at(2));
}

BOOST_AUTO_TEST_CASE(what_rests_has_none) {
  Scene scene = two_vibrations(1, 1, 0);
  for (Node& node : scene.nodes) node.position.setZero();
  const OwnFrequencies own = of(scene, 1, 1);
  BOOST_TEST(own.speed == 0);
  BOOST_TEST(own.at(4) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
