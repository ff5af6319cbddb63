// Cables that go slack and springs that break, against closed forms: the order of every method in
// positions, velocities and the moments; and what happens at moments that are hard.
#include <boost/test/unit_test.hpp>

#include "qddot/model/capabilities.hpp"
#include "tests/integrators/motions.hpp"

BOOST_AUTO_TEST_SUITE(switching)

using namespace qddot;

namespace {

constexpr double mass = 2, stiffness = 300, rest_length = 1, gravity = 9.81;

// A mass that falls on a cable from 0.4 m below its pin, bounces and falls again, on a line.
// Closed form: free fall to l0; then l = l_e + a cos + b sin about the place of balance l_e, until
// it is l0 again; it leaves with the speed of its fall, as energy has it.
struct Bounce {
  double start = 0.4;

  double omega() const { return std::sqrt(stiffness / mass); }
  double speed() const { return std::sqrt(2 * gravity * (rest_length - start)); }
  double falling() const { return speed() / gravity; }
  double balance() const { return rest_length + mass * gravity / stiffness; }
  // The time on the cable: from the phase of l0 to the same length on the way up.
  double bouncing() const {
    const double below = rest_length - balance();
    return 2 / omega() * (M_PI - std::atan2(speed() / omega(), -below));
  }
  double period() const { return 2 * falling() + bouncing(); }
  // Length and rate at t [s].
  std::pair<double, double> at(double t) const {
    t = std::fmod(t, period());
    if (t > falling() + bouncing()) {
      const double left = period() - t;
      return {start + gravity / 2 * left * left, -gravity * left};
    }
    if (t < falling()) return {start + gravity / 2 * t * t, gravity * t};
    const double phase = omega() * (t - falling()), below = rest_length - balance();
    return {balance() + below * std::cos(phase) + speed() / omega() * std::sin(phase),
            -below * omega() * std::sin(phase) + speed() * std::cos(phase)};
  }
  Problem problem() const {
    Network network{.dimension = 1,
                    .gravity = Eigen::Vector3d(gravity, 0, 0),
                    .node_mass = Vec::Constant(1, mass)};
    network.general = {
        {.i = 0,
         .j = -1,
         .point = Eigen::Vector3d::Zero(),
         .law = {.stiffness = stiffness, .rest_length = rest_length, .pulls_only = true}}};
    return {network, {0, Vec::Constant(1, start), Vec::Zero(1)}};
  }
};

// Two masses below each other on two springs; the lower one breaks on the first way down. Closed
// form: two modes until l_2 = l_c; then one mass on its spring, and one in free fall.
struct Series {
  double breaks_at = 0.018, k = 900, m = 1;

  // The modes about the balance, of x1, x2 with M = m and K = -k [[2, -1], [-1, 1]].
  double square(int mode) const {
    return k / m * (mode == 0 ? 3 - std::sqrt(5) : 3 + std::sqrt(5)) / 2;
  }
  Eigen::Vector2d shape(int mode) const {
    // (2 k - w^2 m) u1 = k u2.
    return Eigen::Vector2d(1, 2 - square(mode) * m / k).normalized();
  }
  Eigen::Vector2d balance() const {
    const double e2 = m * gravity / k, e1 = 2 * m * gravity / k;
    return {1 + e1, 2 + e1 + e2};
  }
  // From rest at the rest lengths.
  std::pair<Eigen::Vector2d, Eigen::Vector2d> whole(double t) const {
    Eigen::Vector2d x = balance(), v = Eigen::Vector2d::Zero();
    const Eigen::Vector2d from = Eigen::Vector2d(1, 2) - balance();
    for (const int mode : {0, 1}) {
      const double w = std::sqrt(square(mode)), a = shape(mode).dot(from);
      x += a * std::cos(w * t) * shape(mode);
      v -= a * w * std::sin(w * t) * shape(mode);
    }
    return {x, v};
  }
  double moment() const {
    const auto strain = [&](double t) {
      const auto [x, v] = whole(t);
      return x[1] - x[0] - 1 - breaks_at;
    };
    double low = 0, high = 0;
    while (strain(high) < 0) high += 1e-3;
    low = high - 1e-3;
    for (int i = 0; i < 100; ++i) (strain((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
    return high;
  }
  std::pair<Eigen::Vector2d, Eigen::Vector2d> at(double t) const {
    const double t_break = moment();
    if (t <= t_break) return whole(t);
    const auto [x, v] = whole(t_break);
    const double s = t - t_break, w = std::sqrt(k / m), e = 1 + m * gravity / k, a = x[0] - e;
    return {{e + a * std::cos(w * s) + v[0] / w * std::sin(w * s),
             x[1] + v[1] * s + gravity / 2 * s * s},
            {-a * w * std::sin(w * s) + v[0] * std::cos(w * s), v[1] + gravity * s}};
  }
  Problem problem() const {
    Network network{.dimension = 1,
                    .gravity = Eigen::Vector3d(gravity, 0, 0),
                    .node_mass = Vec::Constant(2, m)};
    network.anchors = {{0, Eigen::Vector3d::Zero(), {.stiffness = k, .rest_length = 1}}};
    network.general = {{.i = 0,
                        .j = 1,
                        .point = Eigen::Vector3d::Zero(),
                        .law = {.stiffness = k, .rest_length = 1, .breaks_at = breaks_at}}};
    return {network, {0, Eigen::Vector2d(1, 2), Vec::Zero(2)}};
  }
};

bool runs_here(const Method& m) {
  return !m.asks(Need::constant_stiffness) && !m.asks(Need::split_forces);
}
std::vector<Method> of_fixed_steps() {
  return methods_where([](const Method& m) { return runs_here(m) && m.knob == Knob::step_size; });
}
std::vector<Method> of_chosen_steps() {
  return methods_where([](const Method& m) { return runs_here(m) && m.knob == Knob::rtol; });
}

// The slope of errors over the last steps before rounding shows. They scatter where a moment falls
// elsewhere in its step, so that a line is fitted through many.
double observed_order(const Method& method, const std::function<double(double)>& error_of) {
  const double first = method.order == 1   ? 800
                       : method.order == 2 ? 150
                       : method.order < 6  ? 50
                                           : 10;
  // The error of rk4 changes its sign between 200 and 400 steps.
  const double most = method.order == 1 ? 30'000 : method.order == 4 ? 20'000 : 4'000;
  const double factor = method.order >= 6 ? 1.15 : 1.3;
  std::vector<double> h, errors;
  for (double steps = first; steps < most; steps *= factor) {
    const double error = error_of(std::round(steps));
    if (error < 2e-12) break;
    h.push_back(-std::log(std::round(steps)));
    errors.push_back(std::log(error));
  }
  BOOST_TEST_REQUIRE(errors.size() >= 4u);
  const auto used = std::min<std::size_t>(errors.size(), 9);
  const Vec x = Eigen::Map<const Vec>(h.data() + h.size() - used, std::ssize(h) > 0 ? used : 0);
  const Vec y = Eigen::Map<const Vec>(errors.data() + errors.size() - used, used);
  return slope(x, y);
}

}  // namespace

BOOST_DATA_TEST_CASE(a_bounce_on_a_cable_keeps_the_order, of_fixed_steps(), method) {
  const Bounce bounce;
  const Problem p = bounce.problem();
  const double until = 2.4 * bounce.period();
  const auto [l, l_rate] = bounce.at(until);
  const double order = observed_order(method, [&](double steps) {
    const Run r = run(method, p, until, {.step_size = until / steps});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    return std::abs(r.state.q[0] - l) + std::abs(r.state.v[0] - l_rate) / 10;
  });
  BOOST_TEST_MESSAGE(method.name << " " << order);
  // Errors of different moments may cancel in a step or two.
  BOOST_TEST(order > method.order - (method.order > 6 ? 1.2 : 0.5));
}

// Steps end on all five moments, whose errors fall by the method's order.
BOOST_DATA_TEST_CASE(moments_have_the_order_of_the_method, of_fixed_steps(), method) {
  if (method.order <= 2) return;
  const Bounce bounce;
  const Problem p = bounce.problem();
  const double until = 2.4 * bounce.period(), down = bounce.falling(),
               up = down + bounce.bouncing(), period = bounce.period();
  const std::vector<double> exact = {down, up, period + down, period + up, 2 * period + down};
  const double order = observed_order(method, [&](double steps) {
    std::vector<double> moments;
    Observer observer;
    observer.step = [&](const State& state) {
      const bool is_new = moments.empty() || state.t > moments.back() + 1e-6;
      // Steps of a try end within its rounding.
      if (std::abs(state.q[0] - rest_length) < 1e-13 && is_new) moments.push_back(state.t);
    };
    run(method, p, until, {.step_size = until / steps}, observer);
    // Some steps of a long formula are no motion yet.
    if (moments.size() != exact.size() && steps < 100) return 1.0;
    BOOST_TEST_REQUIRE(moments.size() == exact.size());
    double error = 0;
    for (std::size_t k = 0; k < exact.size(); ++k)
      error = std::max(error, std::abs(moments[k] - exact[k]));
    return error;
  });
  // The error of order 10 is that of rounding after a few steps of the ladder.
  BOOST_TEST(order > method.order - (method.order > 8 ? 2.5 : method.order > 6 ? 1.2 : 0.5));
}

BOOST_DATA_TEST_CASE(a_spring_breaks_at_its_moment, of_fixed_steps(), method) {
  const Series series;
  const Problem p = series.problem();
  const double until = 2 * series.moment();
  const auto [x, v] = series.at(until);
  double last_moment = 0;
  const double order = observed_order(method, [&](double steps) {
    const Run r = run(method, p, until, {.step_size = until / steps});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    BOOST_TEST_REQUIRE(r.summary.breaks.size() == 1u);
    last_moment = std::abs(r.summary.breaks[0].t - series.moment());
    return (r.state.q - x).norm() + (r.state.v - v).norm() / 30 + last_moment;
  });
  BOOST_TEST_MESSAGE(method.name << " " << order << " " << last_moment);
  BOOST_TEST(order > method.order - (method.order > 6 ? 1.2 : 0.5));
}

BOOST_DATA_TEST_CASE(methods_that_choose_steps_land_on_both, of_chosen_steps(), method) {
  const Bounce bounce;
  const Series series;
  const double t_bounce = 2.4 * bounce.period(), t_series = 2 * series.moment();
  for (const double rtol : {1e-5, 1e-8}) {
    // As in the suite `order`: multistep methods err by up to 1100 tolerances.
    const double most = (method.varies_order() ? 2000 : 200) * rtol;
    const Run bounced = run(method, bounce.problem(), t_bounce, {.rtol = rtol});
    BOOST_TEST_REQUIRE(bounced.summary.message == "");
    // Down twice and up twice, and once more down; methods of order 2 step over them.
    BOOST_TEST(bounced.summary.phase_changes == (method.order == 2 ? 0 : 5));
    BOOST_TEST(std::abs(bounced.state.q[0] - bounce.at(t_bounce).first) < most);
    const Run broken = run(method, series.problem(), t_series, {.rtol = rtol});
    BOOST_TEST_REQUIRE(broken.summary.message == "");
    BOOST_TEST_REQUIRE(broken.summary.breaks.size() == 1u);
    BOOST_TEST(std::abs(broken.summary.breaks[0].t - series.moment()) < most);
    BOOST_TEST((broken.state.q - series.at(t_series).first).norm() < most);
    BOOST_TEST_MESSAGE(method.name << " " << rtol << " "
                                   << std::abs(bounced.state.q[0] - bounce.at(t_bounce).first)
                                   << " " << (broken.state.q - series.at(t_series).first).norm()
                                   << " steps " << bounced.summary.counts.steps << " "
                                   << broken.summary.counts.steps);
  }
}

namespace {

// A mass on a line between cables to fixed points, as (place, rest length).
Problem between_cables(const std::vector<std::pair<double, double>>& cables, double x, double v,
                       double damping = 0, double breaks_at = INFINITY) {
  Network network{.dimension = 1, .node_mass = Vec::Constant(1, mass)};
  for (const auto& [place, length] : cables) {
    network.general.push_back({.i = 0,
                               .j = -1,
                               .point = Eigen::Vector3d(place, 0, 0),
                               .law = {.stiffness = stiffness,
                                       .rest_length = length,
                                       .damping = damping,
                                       .breaks_at = breaks_at,
                                       .pulls_only = true},
                               .number = static_cast<int>(network.general.size())});
  }
  return {network, {0, Vec::Constant(1, x), Vec::Constant(1, v)}};
}

}  // namespace

// Two cables that no motion makes taut: a free flight.
BOOST_AUTO_TEST_CASE(cables_that_stay_slack_do_nothing) {
  const Problem p = between_cables({{-1, 5}, {1, 5}}, 0, 0.7);
  for (const char* name : {"verlet", "kahan_li8", "dprkn8", "cvode_adams", "symmetric6"}) {
    const Method& method = method_named(name);
    const Run r = run(method, p, 3, options_of(method, 1e-2, 1e-8));
    BOOST_TEST_REQUIRE(r.summary.message == "");
    BOOST_TEST(r.summary.phase_changes == 0);
    BOOST_TEST(std::abs(r.state.q[0] - 2.1) < 1e-12);
  }
}

// Two alike cables at one place change at one moment, as one of twice the stiffness; and a third
// whose moment is 1e-9 m later.
BOOST_AUTO_TEST_CASE(many_at_once_and_two_nearly_so_all_change) {
  const double v = 0.7, w = std::sqrt(2 * stiffness / mass);
  for (const char* name : {"rk4", "kahan_li8", "dprkn12", "arkode_erk8", "symmetric8"}) {
    const Method& method = method_named(name);
    const Options options = options_of(method, 1e-3, 1e-12);
    // The mass leaves the cables' rest length at x = 0, and comes back after half a period.
    const Problem twins = between_cables({{-1, 1.5}, {-1, 1.5}}, 0.2, v);
    const double t = 0.3 / v + M_PI / w + 0.1;
    const Run r = run(method, twins, t, options);
    BOOST_TEST_REQUIRE(r.summary.message == "");
    BOOST_TEST(r.summary.phase_changes == 4);
    // Errors of h^4 and of tolerances, both far below.
    BOOST_TEST(std::abs(r.state.q[0] - (0.5 - 0.1 * v)) < 1e-8);
    const Run near = run(method, between_cables({{-1, 1.5}, {-1, 1.5 + 1e-9}}, 0.2, v), t, options);
    BOOST_TEST_REQUIRE(near.summary.message == "");
    BOOST_TEST(near.summary.phase_changes == 4);
    BOOST_TEST(std::abs(near.state.q[0] - r.state.q[0]) < 1e-8);
  }
}

// A mass on an oscillation that comes within `gap` of a cable's rest length and turns back.
BOOST_AUTO_TEST_CASE(a_graze_changes_nothing_and_a_touch_changes_twice) {
  for (const char* name : {"kahan_li8", "dprkn8", "arkode_erk8", "cvode_adams", "rk8"}) {
    const Method& method = method_named(name);
    for (const double gap : {1e-5, -1e-5}) {
      Problem p = between_cables({{-1, 2 + gap}}, 1, 0);
      p.network.anchors = {{0, Eigen::Vector3d::Zero(), {.stiffness = stiffness}}};
      // From rest at x = 1: back there after each period, where the cable is 2 m long.
      const double period = 2 * M_PI / std::sqrt(stiffness / mass);
      const Run r = run(method, p, 2.5 * period, options_of(method, period / 200, 1e-12));
      BOOST_TEST_REQUIRE(r.summary.message == "");
      // At rest beside the end of its phase, the start is taut where it is longer.
      BOOST_TEST(r.summary.phase_changes == (gap > 0 ? 0 : 5));
      const double pull = gap > 0 ? 0 : 1e-5;
      BOOST_TEST(std::abs(r.state.q[0] + 1) < 1e-9 + 3 * pull);
    }
  }
}

// A start on the rest length goes to the side that its rate leads to.
BOOST_AUTO_TEST_CASE(a_start_on_the_rest_length_knows_its_side) {
  for (const double v : {0.5, -0.5}) {
    const Problem p = between_cables({{-1, 1}}, 0, v);
    const Run r = run(method_named("kahan_li8"), p, 0.05, {.step_size = 1e-3});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    const double w = std::sqrt(stiffness / mass);
    const double expected = v > 0 ? v / w * std::sin(w * 0.05) : v * 0.05;
    BOOST_TEST(std::abs(r.state.q[0] - expected) < 1e-13);
  }
}

// A damped mass that hangs on its cable comes to rest there: some bounces, and no end of changes.
BOOST_AUTO_TEST_CASE(a_damped_bounce_comes_to_rest) {
  Problem p = Bounce().problem();
  p.network.general[0].law.damping = 30;
  for (const char* name : {"verlet", "rk4", "dirk"}) {
    if (!find_method(name)) continue;
    const Run r = run(method_named(name), p, 10, {.step_size = 1e-3});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    BOOST_TEST(std::abs(r.state.q[0] - Bounce().balance()) < 1e-6);
    BOOST_TEST(r.summary.phase_changes < 20);
  }
}

// The energy that it held goes with a broken spring, and T + V + released stays.
BOOST_DATA_TEST_CASE(the_balance_is_kept_across_a_break, of_fixed_steps(), method) {
  if (!method.is(Trait::symplectic) && method.order < 4) return;
  const Series series;
  const Problem p = series.problem();
  const auto system = make_mass_spring(p.network);
  const double until = 2 * series.moment();
  const Run r = run(method, *system, p.initial, until, {.step_size = until / 400});
  BOOST_TEST_REQUIRE(r.summary.breaks.size() == 1u);
  BOOST_TEST(r.state.work.released == r.summary.breaks[0].energy);
  BOOST_TEST(std::abs(r.summary.breaks[0].strain - series.breaks_at) < 1e-13);
  const double change =
      total_energy(*system, r.state) + r.state.work.released - total_energy(*system, p.initial);
  // Kicks of order 1 leave errors of h; those of order 2 h^2.
  const double most = method.order == 1 ? 0.1 : method.order == 2 ? 1e-2 : 1e-6;
  BOOST_TEST(std::abs(change) < most);
}

// A run that goes on from a state knows its broken springs.
BOOST_AUTO_TEST_CASE(a_broken_spring_stays_broken_in_a_later_run) {
  const Series series;
  const Problem p = series.problem();
  const auto system = make_mass_spring(p.network);
  const Method& method = method_named("dprkn12");
  const double t = 2 * series.moment();
  const Run whole = run(method, *system, p.initial, t, {.rtol = 1e-12});
  const Run half = run(method, *system, p.initial, 0.7 * t, {.rtol = 1e-12});
  BOOST_TEST_REQUIRE(bool(half.state.phases));
  const Run rest = run(method, *system, half.state, t, {.rtol = 1e-12});
  BOOST_TEST(rest.summary.breaks.empty());
  BOOST_TEST((whole.state.q - rest.state.q).norm() < 1e-10);
}

// Looks between steps see the motion on both sides of a moment, and change no step.
BOOST_DATA_TEST_CASE(looks_change_nothing, of_fixed_steps(), method) {
  const Bounce bounce;
  const Problem p = bounce.problem();
  const double until = 2.4 * bounce.period(), h = until / 300;
  const Run alone = run(method, p, until, {.step_size = h});
  Film film;
  for (int k = 1; k < 97; ++k) film.times.push_back(until * k / 97);
  const Run looked = run(method, p, until, {.step_size = h}, film.observer());
  BOOST_TEST((alone.state.q == looked.state.q));
  if (method.order < 4) return;
  for (const State& state : film.seen)
    BOOST_TEST(std::abs(state.q[0] - bounce.at(state.t).first) < 1e-4);
}

// Each part breaks by itself, and the whole knows which.
BOOST_AUTO_TEST_CASE(parts_have_breaks_of_their_own) {
  const Series early{.breaks_at = 0.015}, late{.breaks_at = 0.018};
  const auto whole = in_parts(late.problem().network, early.problem().network);
  State start{0, Vec(4), Vec::Zero(4)};
  start.q << 1, 2, 1, 2;
  for (const char* name : {"rk4", "dprkn8", "arkode_erk8"}) {
    const Method& method = method_named(name);
    const double until = 2 * late.moment();
    const Run r = run(method, whole, start, until, options_of(method, until / 1000, 1e-11));
    BOOST_TEST_REQUIRE(r.summary.message == "");
    BOOST_TEST_REQUIRE(r.summary.breaks.size() == 2u);
    BOOST_TEST(r.summary.breaks[0].number == 1);
    BOOST_TEST(r.summary.breaks[1].number == 0);
    BOOST_TEST(std::abs(r.summary.breaks[0].t - early.moment()) < 1e-8);
    BOOST_TEST((r.state.q.head(2) - late.at(until).first).norm() < 1e-8);
    BOOST_TEST((r.state.q.tail(2) - early.at(until).first).norm() < 1e-8);
    BOOST_TEST(std::abs(total_energy(whole, r.state) + r.state.work.released -
                        total_energy(whole, start)) < 1e-7);
  }
}

namespace {

// A mass in free flight, and a spring that changes its phase at once and for ever.
class Restless final : public CapableSystem {
 public:
  Restless() : CapableSystem(Vec::Ones(1)) {}
  double potential(const At&) const override { return 0; }
  void force(const At&, MutableVec f) const override { f.setZero(); }
  const Switching* switching() const override { return this; }
  Index phase_count() const override { return 1; }
  std::optional<int> order_of_slack() const override { return 1; }
  void set_phases(const At&, bool, std::span<Phase> phases) const override {
    phases[0] = Phase::slack;
  }
  std::optional<Change> first_change(const State& from, const State&, std::span<const Phase> phases,
                                     const Changed&) const override {
    if (from.t < 0.5) return {};
    return Change{from.t, 0, phases[0] == Phase::slack ? Phase::taut : Phase::slack};
  }
  Margin margin(const At&, int, Phase) const override { return {0, -1, 1e-16}; }
  void add_due_changes(const At&, std::span<const Phase>, std::vector<Change>&) const override {}
  double energy_of(const At&, int) const override { return 0; }
  double strain_of(const At&, int) const override { return 0; }

 private:
  void material_stiffness(const At&, SymmetricMatrix&) const override {}
  void weighted_stiffness(const At&, double, SymmetricMatrix&) const override {}
  void mean_force(const At&, const At&, MutableVec) const override {}
  void assemble_laplacian(SymmetricMatrix&) const override {}
  bool bounds_stiffness() const override { return false; }
  bool is_linear_at(const At&) const override { return false; }
  bool is_valid_at(const At&) const override { return true; }
  Index kink_count() const override { return 0; }
  void kink_lengths(const At&, MutableVec) const override {}
  void friction(const At&, MutableVec) const override {}
  void damping_matrix(const At&, SymmetricMatrix&) const override {}
  bool damping_is_constant() const override { return true; }
  Work driving_power(const At&) const override { return {}; }
  double potential_change(double, double, const At&) const override { return 0; }
  void force_rate(const At&, MutableVec) const override {}
  std::vector<Corner> corners() const override { return {}; }
};

}  // namespace

// Changes that follow one another in no time end the run, and it says so.
BOOST_AUTO_TEST_CASE(changes_without_end_are_an_outcome) {
  const Restless system;
  for (const char* name : {"verlet", "kahan_li8", "rk4"}) {
    const Run r =
        run(method_named(name), system, {0, Vec::Zero(1), Vec::Ones(1)}, 1, {.step_size = 0.01});
    BOOST_TEST((r.summary.outcome == Outcome::chatters));
    BOOST_TEST(r.summary.message == advice(Outcome::chatters));
    BOOST_TEST(std::abs(r.summary.t_reached - 0.5) < 0.011);
    BOOST_TEST(std::abs(r.state.q[0] - r.state.t) < 1e-12);
  }
}

BOOST_AUTO_TEST_SUITE_END()
