#include <boost/test/unit_test.hpp>

#include "qddot/scene/reduce/reduced_scene.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(slack)

using namespace qddot;

namespace {

constexpr double omega = 10, h = 0.02, middle = 0.31;

// A mass of 1 kg on a spring that must not be compressed. Its rest length is 1 m, and a load
// stretches it by 0.05 m. x = 1.05 - a cos(w (t - middle)) has its lowest point in the middle of a
// step.
Problem swing(double amplitude) {
  constexpr double k = omega * omega;
  Problem p{{.dimension = 1, .node_mass = Vec::Ones(1)}, {}};
  p.network.load = Vec::Constant(1, 0.05 * k);
  p.network.anchors = {{0, {0, 0, 0}, {k, 1}, Holds::in_tension}};
  p.initial = {0, Vec::Constant(1, 1.05 - amplitude * std::cos(omega * middle)),
               Vec::Constant(1, -amplitude * omega * std::sin(omega * middle))};
  return p;
}

double number_behind(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? NAN : std::stod(text.substr(at + words.size()));
}

Problem thrown_upwards(int dimension) {
  Problem p = two_in_series(dimension);
  p.initial.v.tail(dimension) = -3 / 1.95 * p.initial.q.tail(dimension);
  return p;
}
// When the one spring is at rest length: x = l + m g/k + r cos(w t + phase).
double time_of_slack() {
  const double w = std::sqrt(120. / 2), sag = 2 * 9.81 / 120;
  const double r = std::hypot(0.25 - sag, 3 / w), phase = std::atan2(3 / w, 0.25 - sag);
  return (std::acos(-sag / r) - phase) / w;
}

}  // namespace

BOOST_DATA_TEST_CASE(compression_between_two_steps_is_seen_and_its_time_told,
                     methods_of(Knob::step_size), method) {
  // Between steps the spring is shorter than at rest, by a quarter of (h w)^2/8 of 0.05 m. At their
  // ends it is longer by about as much. An error of order 4, (h w)^4, is far below that.
  const double excess = h * h * omega * omega / 16;
  const Problem p = swing(0.05 * (1 + excess));
  const auto system = make_mass_spring(p.network);
  const double first = middle - std::acos(1 / (1 + excess)) / omega;
  if (method.order < 4) return;
  const Run r = run(method, *system, p.initial, 0.5, {.step_size = h});
  BOOST_TEST(name(r.summary.outcome) == "went_slack");
  BOOST_TEST(r.state.t == 15 * h);
  BOOST_TEST(is_valid_at(*system, r.state.q));
  BOOST_TEST(std::abs(number_behind(r.summary.message, "at t = ") - first) < 1e-4,
             r.summary.message);
  // Just not compressed.
  const Problem other = swing(0.05 * (1 - excess / 2));
  BOOST_TEST(run(method, other, 2, {.step_size = h}).summary.message == "");
}

BOOST_AUTO_TEST_CASE(long_steps_of_damping_methods_over_a_stiff_spring_raise_no_alarm) {
  // A pendulum on a spring of w = 1000 rad/s, which its load stretches by 1e-5 m; h w = 50.
  Problem p{{.dimension = 2, .gravity = {0, -10, 0}, .node_mass = Vec::Ones(1)}, {}};
  p.network.anchors = {{0, {0, 0, 0}, {1e6, 1}, Holds::in_tension}};
  p.initial = {0, (1 + 9.5e-6) * Vec{{std::sin(0.3), -std::cos(0.3)}}, Vec::Zero(2)};
  for (const char* method : {"implicit_euler", "bdf2", "trbdf2"}) {
    const Run r = run(method_named(method), p, 1, {.step_size = 0.05});
    BOOST_TEST(r.summary.message == "", method << ": " << r.summary.message);
  }
}

BOOST_DATA_TEST_CASE(who_keeps_a_massless_node_notices_that_its_place_is_no_longer_stable,
                     methods_with(Trait::accepts_massless), method) {
  for (const int dimension : {2, 3}) {
    BOOST_TEST_CONTEXT(method.name << " in dimension " << dimension) {
      const Problem p = thrown_upwards(dimension);
      const Run r = run(method, p, 0.2, options_of(method, 1e-3, 1e-7));
      BOOST_TEST(name(r.summary.outcome) == "went_slack");
      BOOST_TEST(r.summary.message.find("at a massless node") != std::string::npos);
      // It is slack after the last state and where it is told. Implicit Euler's error at h = 1 ms
      // is some h.
      const double told = number_behind(r.summary.message, "at t = ");
      BOOST_TEST(r.state.t < time_of_slack() + 3e-3);
      BOOST_TEST(told > time_of_slack() - 3e-3);
      BOOST_TEST(told - r.state.t < 1e-2);  // a step
      const Run before = run(method, p, 0.07, options_of(method, 1e-3, 1e-7));
      BOOST_TEST(before.summary.message == "");
    }
  }
  // Nothing can fold in one dimension.
  const Problem p = thrown_upwards(1);
  const Run r = run(method, p, 0.2, options_of(method, 1e-3, 1e-6));
  BOOST_TEST(r.summary.message == "");
}

BOOST_DATA_TEST_CASE(what_would_fold_across_the_line_that_a_plane_scene_is_left_with_is_noticed,
                     methods_with(Trait::accepts_massless), method) {
  Scene scene{.dimension = 2, .gravity = {0, -9.81, 0}};
  scene.nodes = {{.position = {0, 0, 0}, .pinned = true},
                 {.position = {0, -0.95, 0}, .mass = 0},
                 {.position = {0, -1.95, 0}, .velocity = {0, 3, 0}, .mass = 2}};
  scene.springs = {{{0, 1}, {200, 0.8}}, {{1, 2}, {300, 0.9}}};
  const ReducedScene reduced(scene, Reductions().without(Reduction::massless));
  BOOST_TEST(reduced.system().size() == 2);
  const Run r =
      run(method, reduced.system(), reduced.initial(), 0.2, options_of(method, 1e-3, 1e-7));
  BOOST_TEST(name(r.summary.outcome) == "went_slack");
  // The state is that before the step in which it happens.
  const double told = number_behind(r.summary.message, "at t = ");
  BOOST_TEST(std::abs(told - time_of_slack()) < 3e-3);
  BOOST_TEST((r.state.t <= told && r.state.t > told - 0.01));
}

BOOST_AUTO_TEST_SUITE_END()
