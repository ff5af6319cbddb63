#include <optional>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/model.hpp"
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

// A mass on a cable of two to four springs in a plane, with massless nodes between, and under the
// one spring that the cable is while taut.
struct Cable {
  Problem joints, one;
  double omega = 0;               // of the mass on the cable [rad/s]
  std::optional<double> slack{};  // when the cable goes slack [s]
  double least = INFINITY;        // least tension until `until` if it pushed as well, over m g
  State end{};                    // of the mass, at `until`, if it did not

  static constexpr double until = 0.6;
};

Cable drawn_cable(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  constexpr double g = 9.81, mass = 1;
  const int joints = std::uniform_int_distribution(1, 3)(random);
  std::vector<SpringLaw> laws;
  double compliance = 0, rest_length = 0;
  for (int i = 0; i <= joints; ++i) {
    laws.push_back(
        {.stiffness = std::pow(10, between(2.3, 3.3)), .rest_length = between(0.2, 0.5)});
    compliance += 1 / laws.back().stiffness;
    rest_length += laws.back().rest_length;
  }
  const double angle = between(-0.8, 0.8), tension = between(0.6, 1.4) * mass * g;
  const Vec down{{std::sin(angle), -std::cos(angle)}}, across{{down[1], -down[0]}};
  Cable cable;
  for (Problem* p : {&cable.joints, &cable.one}) *p = {{.dimension = 2, .gravity = {0, -g, 0}}, {}};
  cable.joints.network.node_mass = Vec::Zero(joints + 1);
  cable.joints.network.node_mass[joints] = mass;
  Vec q(2 * joints + 2), v = Vec::Zero(q.size());
  double length = 0;
  for (int i = 0; i <= joints; ++i) {
    length += laws[i].rest_length + tension / laws[i].stiffness;
    q.segment<2>(2 * i) = length * down;
    if (i > 0) cable.joints.network.links.push_back({i - 1, i, laws[i]});
  }
  cable.joints.network.anchors = {{0, {0, 0, 0}, laws[0]}};
  v.tail<2>() = between(-2, 2) * down + between(-0.4, 0.4) * across;
  cable.joints.initial = {0, q, v};
  const SpringLaw law{.stiffness = 1 / compliance, .rest_length = rest_length};
  cable.one.network.node_mass = Vec::Constant(1, mass);
  cable.one.network.anchors = {{0, {0, 0, 0}, law, Holds::in_tension}};
  cable.one.initial = {0, q.tail<2>(), v.tail<2>()};
  cable.omega = std::sqrt(law.stiffness / mass);
  // The classical Runge-Kutta method, at h w < 0.01.
  using Plane = Eigen::Matrix<long double, 2, 1>;
  const auto acceleration = [&](const Plane& x) -> Plane {
    const long double l = x.norm();
    return -law.stiffness / mass * (1 - rest_length / l) * x - Plane(0, g);
  };
  constexpr int steps = 6000;
  constexpr long double dt = static_cast<long double>(Cable::until) / steps;
  Plane x = cable.one.initial.q.cast<long double>(), u = cable.one.initial.v.cast<long double>();
  for (int n = 0; n <= steps; ++n) {
    const double pull = law.tension(static_cast<double>(x.norm()));
    cable.least = std::min(cable.least, pull / (mass * g));
    if (pull < 0 && !cable.slack) cable.slack = static_cast<double>(n * dt);
    if (n == steps) break;
    const Plane a1 = acceleration(x), u2 = u + dt / 2 * a1, a2 = acceleration(x + dt / 2 * u);
    const Plane u3 = u + dt / 2 * a2, a3 = acceleration(x + dt / 2 * u2);
    const Plane u4 = u + dt * a3, a4 = acceleration(x + dt * u3);
    x += dt / 6 * (u + 2 * u2 + 2 * u3 + u4);
    u += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  cable.end = {Cable::until, x.cast<double>(), u.cast<double>()};
  return cable;
}

// Cables of which half or so go slack, none by a hair's breadth.
std::vector<Cable> drawn_cables() {
  std::mt19937 random(12);
  std::vector<Cable> cables;
  while (cables.size() < 24) {
    Cable cable = drawn_cable(random);
    if (std::abs(cable.least) > 0.2) cables.push_back(std::move(cable));
  }
  return cables;
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
  const Model reduced(scene, Reductions().without(Reduction::massless));
  BOOST_TEST(reduced.system().size() == 2);
  const Run r =
      run(method, reduced.system(), reduced.initial(), 0.2, options_of(method, 1e-3, 1e-7));
  BOOST_TEST(name(r.summary.outcome) == "went_slack");
  // The state is that before the step in which it happens.
  const double told = number_behind(r.summary.message, "at t = ");
  BOOST_TEST(std::abs(told - time_of_slack()) < 3e-3);
  BOOST_TEST((r.state.t <= told && r.state.t > told - 0.01));
}

BOOST_DATA_TEST_CASE(random_cables_are_followed_while_taut_and_no_farther,
                     methods_with(Trait::accepts_massless), method) {
  int slack = 0;
  for (const Cable& cable : drawn_cables()) {
    const Run r = run(method, cable.joints, Cable::until, options_of(method, 1e-4, 1e-7));
    BOOST_TEST_CONTEXT(method.name << ": " << r.summary.message) {
      if (cable.slack) {
        ++slack;
        BOOST_TEST(name(r.summary.outcome) == "went_slack");
        // Errors of the first order are of the size h w^2 t/2 < 0.03 of the amplitude.
        BOOST_TEST(std::abs(number_behind(r.summary.message, "at t = ") - *cable.slack) < 0.01);
        BOOST_TEST(r.state.t <= *cable.slack + 0.01);
      } else {
        BOOST_TEST(r.summary.message == "");
        BOOST_TEST(distance(r.state.q.tail(2), cable.end.q) < 0.02);
      }
    }
  }
  BOOST_TEST(slack >= 8);
  BOOST_TEST(slack <= 16);
}

BOOST_DATA_TEST_CASE(no_step_is_so_long_that_a_slack_is_passed_unseen, methods_of(Knob::step_size),
                     method) {
  int runs = 0;
  for (const Cable& cable : drawn_cables()) {
    const double turn = 2 * M_PI / cable.omega;
    for (const double step : {3 / cable.omega, Cable::until, 3.0}) {
      // Later, methods that damp no longer have the motion.
      if (!cable.slack || *cable.slack > 0.9 * std::min(step, turn)) continue;
      for (const Problem* p : {&cable.joints, &cable.one}) {
        if (p == &cable.joints && !method.is(Trait::accepts_massless)) continue;
        if (misfit(method, *make_mass_spring(p->network))) continue;
        const Run r = run(method, *p, std::max(step, Cable::until), {.step_size = step});
        BOOST_TEST_CONTEXT(method.name << " at h = " << step << ": " << r.summary.message) {
          ++runs;
          BOOST_TEST(r.state.t == 0);
          if (r.summary.outcome == Outcome::newton_failed) continue;  // before anybody can ask
          if (r.summary.outcome == Outcome::diverged) continue;
          BOOST_TEST(name(r.summary.outcome) == "went_slack");
          // Within the turn the cable swings aside as well.
          const double at = number_behind(r.summary.message, "at t = ");
          BOOST_TEST(std::abs(at - *cable.slack) < 0.15 * turn);
        }
      }
    }
  }
  BOOST_TEST(runs > 10);
}

BOOST_AUTO_TEST_SUITE_END()
