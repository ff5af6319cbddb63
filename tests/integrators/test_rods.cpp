// Rods against closed forms, and what methods that keep constraints are to keep: their order in
// places and velocities, constraints and momenta to rounding, energy, its balance, and time.
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <boost/test/unit_test.hpp>

#include "qddot/algebra/constraint_forces.hpp"
#include "qddot/integrators/base/kick_drift.hpp"
#include "qddot/integrators/misfit_words.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(rods)

using namespace qddot;

namespace {

constexpr double gravity = 9.81;

std::vector<Method> for_rods(Knob knob) {
  std::vector<Method> list = methods();
  std::erase_if(list,
                [=](const Method& m) { return !m.asks(Need::constraints) || m.knob != knob; });
  return list;
}
std::vector<Method> of_fixed_steps() { return for_rods(Knob::step_size); }
std::vector<Method> of_chosen_steps() { return for_rods(Knob::rtol); }
std::vector<Method> of_both() {
  std::vector<Method> list = of_fixed_steps();
  for (const Method& method : of_chosen_steps()) list.push_back(method);
  return list;
}

// A mass on a rod of the length L, let go from the horizontal. With k = sin(pi/4) and w^2 = g/L
// the angle from below is theta = 2 asin(k sn(K - w t, k)).
struct Pendulum {
  double length = 0.7, mass = 2;

  double angle(double t) const {
    const double k = std::sqrt(0.5), quarter = 1.8540746773013719;  // K(sin(pi/4))
    return 2 * std::asin(k * boost::math::jacobi_sn(k, quarter - std::sqrt(gravity / length) * t));
  }
  Vec place(double t) const {
    return Vec{{length * std::sin(angle(t)), -length * std::cos(angle(t))}};
  }
  // m g cos(theta) + m |v|^2/L, and |v|^2 = 2 g L cos(theta).
  double tension(double t) const { return 3 * mass * gravity * std::cos(angle(t)); }
  Problem problem() const {
    Network network{.dimension = 2,
                    .gravity = Eigen::Vector3d(0, -gravity, 0),
                    .node_mass = Vec::Constant(1, mass)};
    network.rods = {{0, -1, Eigen::Vector3d::Zero(), length}};
    return {network, {0, Vec{{length, 0}}, Vec::Zero(2)}};
  }
};

// Velocities changed, by as little as kinetic energy measures, such that no rod changes its length.
Problem kept(Problem p) {
  const auto system = make_mass_spring(p.network);
  Multipliers multipliers(*system);
  multipliers.take_gradients(p.initial);
  BOOST_TEST_REQUIRE(multipliers.factorize());
  multipliers.project_velocities(At(p.initial), p.initial.v);
  return p;
}

// Five masses in 2D or 3D: a row of three rods from a pin, a ring with the fourth node, springs
// across and to a point, all of different numbers.
Problem linkage(int dimension, bool is_pinned = true) {
  Network network{.dimension = dimension, .node_mass = Vec{{0.3, 0.5, 0.2, 0.8, 0.4}}};
  if (is_pinned) network.gravity[dimension - 1] = -gravity;
  Eigen::MatrixXd x(5, 3);
  x << 0.4, 0.1, 0.05, 0.9, -0.2, 0.3, 1.3, 0.3, -0.1, 0.7, 0.8, 0.4, 1.8, 0.1, 0.2;
  const auto at = [&](int i) { return Vec(x.row(i).head(dimension)); };
  const auto rod = [&](int i, int j) {
    network.rods.push_back({i, j, Eigen::Vector3d::Zero(), (at(i) - at(j)).norm()});
  };
  if (is_pinned) network.rods.push_back({0, -1, Eigen::Vector3d::Zero(), at(0).norm()});
  rod(0, 1);
  rod(1, 2);
  rod(3, 2);
  rod(0, 3);
  network.links = {{0, 2, {40, 0.8}}, {1, 4, {60, 0.7}}, {2, 4, {50, 0.6}}};
  if (is_pinned) network.anchors = {{4, {2, 1, 0}, {30, 0.5}}};
  State start{0, Vec(5 * dimension), Vec(5 * dimension)};
  for (int i = 0; i < 5; ++i) {
    start.q.segment(dimension * i, dimension) = at(i);
    for (int a = 0; a < dimension; ++a) start.v[dimension * i + a] = std::sin(3 * i + 2 * a + 1);
  }
  return kept({network, start});
}

// The largest |g| and |G v + dg/dt| at a state.
std::pair<double, double> violation(const System& system, const State& state) {
  const Constraints& constraints = offered(system.constraints());
  Vec g(constraints.constraint_count()), rates = g;
  constraints.constraint_values(state, g);
  GradientMatrix gradients = constraints.gradient_pattern();
  constraints.constraint_gradients(state, gradients);
  constraints.constraint_rates(state, rates);
  rates += gradients * state.v;
  return {g.lpNorm<Eigen::Infinity>(), rates.lpNorm<Eigen::Infinity>()};
}

State truth(const System& system, const State& start, double until) {
  const Run r = run(method_named("rattle8"), system, start, until, {.step_size = until / 2000});
  BOOST_TEST_REQUIRE(r.summary.message == "");
  return r.state;
}

// Errors at ever shorter steps, and the slope of the last ones above rounding.
double order_of(const Method& method, const System& system, const State& start, double until,
                const std::function<double(const State&)>& error_of) {
  std::vector<double> errors;
  for (double steps = method.order > 4   ? 12
                      : method.order > 2 ? 25
                                         : 100;
       steps < 20'000 && errors.size() < 6; steps *= std::sqrt(2.0)) {
    const Run r = run(method, system, start, until, {.step_size = until / std::round(steps)});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    const double error = error_of(r.state);
    if (error < 1e-11) break;
    errors.push_back(error);
  }
  BOOST_TEST_REQUIRE(errors.size() >= 3u);
  const auto used = std::min<std::size_t>(errors.size(), 4);
  Vec x(static_cast<Index>(used)), y(static_cast<Index>(used));
  for (std::size_t k = 0; k < used; ++k) {
    x[static_cast<Index>(k)] = -0.5 * static_cast<double>(k);
    y[static_cast<Index>(k)] = std::log2(errors[errors.size() - used + k]);
  }
  return slope(x, y);
}

// Twice as far from the order as errors of order p + 1 or p + 2 bring on these ladders.
double slack(const Method& method) { return method.order > 4 ? 0.8 : method.order > 2 ? 0.3 : 0.1; }

}  // namespace

BOOST_DATA_TEST_CASE(a_pendulum_follows_jacobi, of_fixed_steps(), method) {
  const Pendulum pendulum;
  const auto system = make_mass_spring(pendulum.problem().network);
  const State start = pendulum.problem().initial;
  const double order = order_of(method, *system, start, 2, [&](const State& end) {
    return (end.q - pendulum.place(2)).norm();
  });
  BOOST_TEST_MESSAGE(method.name << " " << order);
  BOOST_TEST(order > method.order - slack(method));
  BOOST_TEST(order < method.order + 2 * slack(method));
  if (method.order < 6) return;
  // To the rounding of some thousand forces, which grows along the motion as the time does.
  const Run r = run(method, *system, start, 2, {.step_size = 2. / 400});
  BOOST_TEST((r.state.q - pendulum.place(2)).norm() < 4e-13);
  BOOST_TEST(std::abs(ConstraintForces(*system).at(r.state)[0] - pendulum.tension(2)) < 4e-11);
}

BOOST_DATA_TEST_CASE(methods_that_choose_steps_follow_it_as_well, of_chosen_steps(), method) {
  const Pendulum pendulum;
  for (const double rtol : {1e-4, 1e-7, 1e-10}) {
    const Run r = run(method, pendulum.problem(), 2, {.rtol = rtol});
    BOOST_TEST_REQUIRE(r.summary.message == "");
    // As in the suite `order`.
    const double most = (method.varies_order() ? 2000 : 100) * rtol;
    BOOST_TEST((r.state.q - pendulum.place(2)).norm() < most, method.name << " at " << rtol);
    BOOST_TEST(violation(*make_mass_spring(pendulum.problem().network), r.state).first < rtol);
  }
}

BOOST_DATA_TEST_CASE(a_linkage_keeps_the_order_in_places_and_velocities,
                     of_fixed_steps() * boost::unit_test::data::make({2, 3}), method, dimension) {
  const Problem p = linkage(dimension);
  const auto system = make_mass_spring(p.network);
  const State end = truth(*system, p.initial, 0.5);
  const double of_q = order_of(method, *system, p.initial, 0.5,
                               [&](const State& s) { return (s.q - end.q).norm(); });
  const double of_v = order_of(method, *system, p.initial, 0.5,
                               [&](const State& s) { return (s.v - end.v).norm(); });
  BOOST_TEST_MESSAGE(method.name << " " << dimension << "D " << of_q << " " << of_v);
  for (const double order : {of_q, of_v}) {
    BOOST_TEST(order > method.order - slack(method));
    BOOST_TEST(order < method.order + 2 * slack(method));
  }
}

BOOST_DATA_TEST_CASE(two_unlike_methods_agree, boost::unit_test::data::make({2, 3}), dimension) {
  const Problem p = linkage(dimension);
  const auto system = make_mass_spring(p.network);
  const State end = truth(*system, p.initial, 0.5);
  for (const Method& method : of_chosen_steps()) {
    for (const double rtol : {1e-4, 1e-7, 1e-10}) {
      const Run r = run(method, *system, p.initial, 0.5, {.rtol = rtol});
      BOOST_TEST_REQUIRE(r.summary.message == "");
      const double most = (method.varies_order() ? 2000 : 100) * rtol;
      BOOST_TEST((r.state.q - end.q).norm() < most, method.name << " at " << rtol);
      BOOST_TEST((r.state.v - end.v).norm() < 10 * most, method.name << " at " << rtol);
    }
  }
}

BOOST_DATA_TEST_CASE(constraints_and_momenta_stay_to_rounding, of_fixed_steps(), method) {
  const Problem p = linkage(3, false);
  const auto system = make_mass_spring(p.network);
  const auto momenta = [&](const State& state) {
    Vec all = Vec::Zero(6);
    for (Index i = 0; i < 5; ++i) {
      const Eigen::Vector3d x = state.q.segment<3>(3 * i),
                            w = system->mass()[3 * i] * state.v.segment<3>(3 * i);
      all.head<3>() += w;
      all.tail<3>() += x.cross(w);
    }
    return all;
  };
  const double h = method.order == 2 ? 1e-3 : 5e-3, size = p.initial.q.lpNorm<Eigen::Infinity>();
  const double steps = 20'000;
  const Vec before = momenta(p.initial);
  double worst = 0, worst_rate = 0;
  Observer each;
  each.step = [&](const State& state) {
    const auto [g, rate] = violation(*system, state);
    // A ring that flies away has larger coordinates.
    const double roundings = eps * std::max(size, state.q.lpNorm<Eigen::Infinity>());
    worst = std::max(worst, g / roundings);
    worst_rate = std::max(worst_rate, rate / eps);
  };
  const Run r = run(method, *system, p.initial, steps * h, {.step_size = h}, each);
  BOOST_TEST_REQUIRE(r.summary.message == "");
  // Newton's method ends at 2 roundings, or up to 64 where it stands still.
  BOOST_TEST(worst <= 8);
  // A projection leaves roundings of speeds of about 2 m/s.
  BOOST_TEST(worst_rate < 40);
  // Each of 20,000 to 340,000 forces rounds 15 numbers; they add up like a random walk.
  BOOST_TEST((momenta(r.state) - before).norm() < 4e-11 * std::max(1.0, before.norm()));
}

// Energy that is bounded for all time: a regular motion of three rods, let go 0.3 rad from below.
BOOST_DATA_TEST_CASE(energy_does_not_drift, of_fixed_steps(), method) {
  Network network{.dimension = 2,
                  .gravity = Eigen::Vector3d(0, -gravity, 0),
                  .node_mass = Vec{{0.3, 0.5, 0.2}}};
  State start{0, Vec(6), Vec::Zero(6)};
  for (int i = 0; i < 3; ++i) {
    network.rods.push_back({i, i - 1, Eigen::Vector3d::Zero(), 0.4});
    start.q.segment<2>(2 * i) << 0.4 * (i + 1) * std::sin(0.3), -0.4 * (i + 1) * std::cos(0.3);
  }
  const auto system = make_mass_spring(network);
  const double energy = total_energy(*system, start);
  const double h = method.order == 2 ? 0.01 : 0.05, steps = 50'000;
  Vec halves = Vec::Zero(2);
  Observer each;
  each.step = [&](const State& state) {
    double& half = halves[state.t < steps / 2 * h ? 0 : 1];
    half = std::max(half, std::abs(total_energy(*system, state) - energy));
  };
  const Run r = run(method, *system, start, steps * h, {.step_size = h}, each);
  BOOST_TEST_REQUIRE(r.summary.message == "");
  BOOST_TEST_MESSAGE(method.name << " " << halves.transpose() / std::abs(energy));
  // Both halves see many beats of the three modes. A drift would double the error.
  BOOST_TEST(halves[1] < 1.2 * halves[0]);
  BOOST_TEST(halves[1] < 0.01 * std::abs(energy));
}

BOOST_DATA_TEST_CASE(steps_back_lead_to_the_start, of_fixed_steps(), method) {
  const Problem p = linkage(3);
  const auto system = make_mass_spring(p.network);
  Run there = run(method, *system, p.initial, 0.4, {.step_size = 0.004});
  State turned{0, there.state.q, -there.state.v};
  const Run back = run(method, *system, turned, 0.4, {.step_size = 0.004});
  // Roundings of 100 to 1700 forces, grown by the motion.
  BOOST_TEST((back.state.q - p.initial.q).norm() < 1e-11);
  BOOST_TEST((back.state.v + p.initial.v).norm() < 1e-10);
}

// Declared limits are those of vibrations without rods: there the trace of a step passes 2.
BOOST_DATA_TEST_CASE(stability_limits_are_the_declared_ones, of_fixed_steps(), method) {
  const Splitting& splitting = *method.splitting;
  const auto trace = [&](double hw) {
    Eigen::Matrix2d step = Eigen::Matrix2d::Identity();  // of (q, v)
    for (std::size_t i = 0; i < splitting.kicks.size(); ++i) {
      step.row(1) -= splitting.kicks[i] * hw * step.row(0);
      if (i < splitting.drifts.size()) step.row(0) += splitting.drifts[i] * hw * step.row(1);
    }
    return std::abs(step.trace());
  };
  for (double hw = 0.01; hw < *method.stability_limit; hw += 0.01) BOOST_TEST(trace(hw) <= 2);
  BOOST_TEST(trace(*method.stability_limit * (1 + 1e-9)) > 2);
}

// Stormer's recurrence q_{n+1} - 2 q_n + q_{n-1} = h^2 M^-1 (f - G'lambda), of SHAKE.
BOOST_AUTO_TEST_CASE(rattle_has_the_places_of_shake) {
  const Problem p = linkage(2);
  const auto system = make_mass_spring(p.network);
  const double h = 0.005;
  std::vector<Vec> places = {p.initial.q};
  Observer each;
  each.step = [&](const State& state) {
    if (state.t > 0) places.push_back(state.q);
  };
  run(method_named("rattle"), *system, p.initial, 20 * h, {.step_size = h}, each);
  BOOST_TEST_REQUIRE(places.size() == 21u);
  const Constraints& constraints = offered(system->constraints());
  GradientMatrix gradients = constraints.gradient_pattern();
  for (std::size_t n = 1; n + 1 < places.size(); ++n) {
    const Vec& q = places[n];
    constraints.constraint_gradients(q, gradients);
    const Vec rest = system->mass().cwiseProduct(places[n + 1] - 2 * q + places[n - 1]) / (h * h) -
                     force_at(*system, q);
    // The rest is along the rods: G' lambda for some lambda.
    const Eigen::MatrixXd columns = Eigen::MatrixXd(gradients).transpose();
    const Vec along = columns * columns.colPivHouseholderQr().solve(rest);
    BOOST_TEST((rest - along).norm() < 1e-9);  // roundings of places over h^2
  }
}

namespace {

// The linkage with what takes and gives energy: air, dashpots, a moving pin, a load that changes.
Problem damped(bool with_dashpots) {
  Problem p = linkage(2);
  p.network.air_damping = 0.4;
  if (with_dashpots) {
    for (auto& link : p.network.links) link.law.damping = 1.5;
  }
  return p;
}
Problem driven() {
  Problem p = linkage(2);
  TimeCurve swing, load;
  swing.harmonics = {{{0.1, 0.05, 0}, 6, 0}};
  load.harmonics = {{{0, 3, 0}, 4, 0.5}};
  p.network.curves = {swing, load};
  p.network.rods[0].curve = 0;
  p.network.driven_loads = {{3, 1, 1, Eigen::Vector3d::Zero()}};
  return kept(p);
}

double balance(const System& system, const State& state) {
  return total_energy(system, state) + state.work.taken();
}

}  // namespace

BOOST_DATA_TEST_CASE(damping_and_driving_keep_the_order_and_the_balance,
                     of_fixed_steps() * boost::unit_test::data::make({0, 1, 2}), method, kind) {
  const Problem p = kind == 0 ? damped(false) : kind == 1 ? damped(true) : driven();
  const auto system = make_mass_spring(p.network);
  if (const auto why = misfit(method, *system)) {
    BOOST_TEST((*why == Outcome::refuses_damping));
    BOOST_TEST(misfit_words(method, *why).find("rattle") != std::string::npos);
    return;
  }
  // The truth by the adaptive method, which is unlike: RATTLE of order 8 takes no dashpots.
  const State end =
      run(method_named("arkode_erk8_rods"), *system, p.initial, 0.5, {.rtol = 1e-14}).state;
  const double of_q = order_of(method, *system, p.initial, 0.5,
                               [&](const State& s) { return (s.q - end.q).norm(); });
  const double energy = balance(*system, p.initial);
  const double of_balance = order_of(method, *system, p.initial, 0.5, [&](const State& s) {
    return std::abs(balance(*system, s) - energy);
  });
  BOOST_TEST_MESSAGE(method.name << " " << kind << ": " << of_q << " " << of_balance);
  BOOST_TEST(of_q > method.order - slack(method));
  BOOST_TEST(of_balance > method.order - 2 * slack(method));
  BOOST_TEST(std::abs(balance(*system, end) - energy) < 1e-10);
}

BOOST_AUTO_TEST_CASE(tensions_are_what_newton_asks_for) {
  const Problem p = linkage(3);
  const auto system = make_mass_spring(p.network);
  ConstraintForces forces(*system);
  // Accelerations by central differences of velocities on the motion.
  const double h = 1e-4;
  const auto v_at = [&](double t) {
    State start = p.initial;
    if (t < 0) start.v *= -1;
    const State end =
        run(method_named("rattle8"), *system, start, std::abs(t), {.step_size = std::abs(t) / 4})
            .state;
    return Vec(t < 0 ? -end.v : end.v);
  };
  const Vec a = (8 * (v_at(h) - v_at(-h)) - (v_at(2 * h) - v_at(-2 * h))) / (12 * h);
  GradientMatrix gradients = system->constraints()->gradient_pattern();
  system->constraints()->constraint_gradients(p.initial, gradients);
  const Vec pull = gradients.transpose() * forces.at(p.initial);
  const Vec rest = system->mass().cwiseProduct(a) - force_at(*system, p.initial.q) + pull;
  BOOST_TEST(rest.norm() < 1e-8);  // roundings of v over h
}

BOOST_DATA_TEST_CASE(other_methods_refuse_rods_by_name, methods(), method) {
  const auto system = make_mass_spring(linkage(2).network);
  if (method.asks(Need::constraints)) {
    const auto plain = make_mass_spring(hammock(2).network);
    BOOST_TEST((misfit(method, *plain) == Outcome::no_constraints));
    return;
  }
  const Run r = run(method, *system, linkage(2).initial, 1, options_of(method, 0.01, 1e-4));
  BOOST_TEST((r.summary.outcome == Outcome::refuses_constraints));
  BOOST_TEST(r.summary.message.find("take rattle") != std::string::npos);
}

BOOST_DATA_TEST_CASE(too_long_a_step_fails_loudly, of_fixed_steps(), method) {
  const Problem p = linkage(2);
  const Run r = run(method, p, 30, {.step_size = 3});
  BOOST_TEST((r.summary.outcome == Outcome::newton_failed));
  BOOST_TEST(r.summary.message.find("smaller step") != std::string::npos);
  BOOST_TEST(r.summary.t_reached == 0);
}

// Two rods between pins, pulled straight by gravity along them: no forces along the rods can stop
// them.
BOOST_DATA_TEST_CASE(rods_that_lock_end_the_run, of_both(), method) {
  Network network{.dimension = 2, .node_mass = Vec{{1}}};
  const double length = 1;
  network.rods = {{0, -1, {-1, 0, 0}, length}, {0, -1, {1, 0, 0}, length}};
  const Problem p{network, {0, Vec::Zero(2), Vec::Zero(2)}};
  const Run r = run(method, p, 1, options_of(method, 0.01, 1e-6));
  BOOST_TEST((r.summary.outcome != Outcome::reached_end));
  BOOST_TEST(r.state.q.allFinite());
}

BOOST_AUTO_TEST_SUITE_END()
