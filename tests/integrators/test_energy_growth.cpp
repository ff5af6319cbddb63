#include <random>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(energy_growth)

using namespace qddot;

namespace {

// Four masses that fall from rest in a row of springs which hang from a pin.
Problem falling() {
  Problem p{{.dimension = 2, .gravity = {0, -9.81, 0}, .node_mass = Vec{{1, 0.1, 0.3, 2}}}, {}};
  for (int i = 0; i < 3; ++i) p.network.links.push_back({i, i + 1, {500, 0.5}});
  p.network.anchors = {{0, {0, 0, 0}, {500, 0.5}}};
  p.initial = {0, Vec{{0.5, 0, 1, 0, 1.5, 0, 2, 0}}, Vec::Zero(8)};
  return p;
}

// Twelve masses that fly about at random, most of whose springs are compressed.
Problem crumpled(std::mt19937& random) {
  const auto drawn = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  constexpr int nodes = 12;
  Problem p{{.dimension = 3, .gravity = {0, 0, -9.81}, .node_mass = Vec::Constant(nodes, 0.1)}, {}};
  p.initial = {0, Vec(3 * nodes), Vec(3 * nodes)};
  for (double& x : p.initial.q) x = drawn(0, 1);
  for (double& v : p.initial.v) v = drawn(-2, 2);
  const double stiffness = std::pow(10, drawn(2, 4));
  for (int i = 0; i < nodes; ++i) {
    for (int j = 0; j < i; ++j) {
      if (drawn(0, 1) > 0.4) continue;
      const double length = (p.initial.q.segment<3>(3 * i) - p.initial.q.segment<3>(3 * j)).norm();
      p.network.links.push_back({j, i, {stiffness, length * drawn(0.9, 1.5)}});
    }
  }
  p.network.anchors = {{0, {0, 0, 0}, {stiffness, 0.5}}};
  return p;
}

// The oscillator pushed from rest length, so that all of its energy is kinetic at the start.
Problem pushed(double omega, double v0 = 1) {
  return Oscillator{.mass = 1, .stiffness = omega * omega, .x0 = 0, .v0 = v0}.problem();
}

double growth(const Method& method, const Problem& p, double t_end, const Options& options) {
  return run(method, p, t_end, options).summary.energy_growth;
}

// The growth that a run reports, and the growth over its states at many times.
struct Growth {
  double said, seen;
};
Growth growth_seen(const Method& method, const Problem& p, double t_end, const Options& options,
                   int looks) {
  const auto system = make_mass_spring(p.network);
  double most = 0;
  Observer observer{{}, [&](const State& s) { most = std::max(most, total_energy(*system, s)); }};
  for (int i = 1; i <= looks; ++i) observer.times.push_back(i * t_end / looks);
  const Run r = run(method, *system, p.initial, t_end, options, observer);
  return {r.summary.energy_growth, most / total_energy(*system, p.initial)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(motions_as_they_should_be_have_no_more_energy_than_they_began_with) {
  for (const Problem& p : {falling(), hammock(2), hammock(3), linear_hammock(2)}) {
    for (const Method& method : general_methods()) {
      if (method.stability_limit == 0) continue;  // which gains some at every h
      BOOST_TEST_CONTEXT(method.name) {
        // h w_max < 0.3 of the chain, 0.1 of the others.
        const double g = growth(method, p, 1, options_of(method, 0.004, 1e-6));
        BOOST_TEST(g >= 1);
        BOOST_TEST(g < 1.1);
      }
    }
  }
}

BOOST_DATA_TEST_CASE(what_rests_in_balance_does_not_grow, general_methods(), method) {
  // A mass at rest far from the origin, where V rounds by 1e-10 J without any motion.
  Problem p{{.dimension = 1, .gravity = {9.81, 0, 0}, .node_mass = Vec::Ones(1)}, {}};
  p.network.anchors = {{0, {1000, 0, 0}, {981, 1}}};
  p.initial = {0, Vec::Constant(1, 1001.01), Vec::Zero(1)};
  BOOST_TEST(growth(method, p, 1, options_of(method, 0.01, 1e-6)) < 10, method.name);
}

BOOST_AUTO_TEST_CASE(symplectic_swings_below_the_limit_are_no_growth) {
  // The modified energy v^2 + w^2 q^2 (1 - (h w)^2/4) is kept: up to 1/(1 - 0.81) = 5.3.
  const double g = growth(method_named("verlet"), pushed(10), 100, {.step_size = 0.18});
  BOOST_TEST(g < 5.3);
  BOOST_TEST(g > 2);
}

BOOST_AUTO_TEST_CASE(an_energy_that_grows_and_comes_back_is_seen_in_short_runs_and_long_ones) {
  // From rest length, Verlet's energy goes up to 1/(1 - s) times its start and back, s = (h w)^2/4.
  // A step turns the vibration by acos(1 - 2 s). So the energy is beyond 0.7 of its crest in half
  // of all steps, and right again once or twice in 30. 10 looks in the shortest run all miss this
  // with a probability of 1e-3; the looks are the same in each run.
  for (const double h_omega : {1.9, 1.99, 1.999}) {
    const double crest = 1 / (1 - h_omega * h_omega / 4), h = h_omega / 10;
    for (const int steps : {30, 120, 500, 5000}) {
      BOOST_TEST_CONTEXT("h w = " << h_omega << ", " << steps << " steps") {
        const Options options{.step_size = h};
        const double said = growth(method_named("verlet"), pushed(10), steps * h, options);
        BOOST_TEST(said > 0.7 * crest);
        BOOST_TEST(said < crest * (1 + 1e-9));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_growth_is_what_the_energies_on_the_way_say) {
  const Method &euler = method_named("explicit_euler"), &verlet = method_named("verlet");
  // (1 + (h w)^2)^steps: e^10 after 1000 steps of 0.1.
  BOOST_TEST(growth(euler, pushed(10), 10, {.step_size = 0.01}) == std::pow(1.01, 1000),
             boost::test_tools::tolerance(1e-6));
  // Just above the limit, far from diverging; its speeds are seen to the factor of 2 between two.
  const auto [said, seen] = growth_seen(verlet, pushed(10), 20.02, {.step_size = 0.2002}, 100);
  BOOST_TEST(seen > 100);
  BOOST_TEST(said <= seen * 1.0001);
  BOOST_TEST(said > seen / 10);
}

BOOST_AUTO_TEST_CASE(a_motion_from_rest_that_grows_from_the_first_step_on_is_told_by_how_much) {
  // Drawn out and let go, at h w = 2.01: V is never again as low as at the start. The least energy
  // that is found ahead is within a factor of 2 in s of the lowest, (1/3)^2 of V left at most.
  const Problem p = Oscillator{.mass = 1, .stiffness = 100, .x0 = 1, .v0 = 0}.problem();
  const auto [said, seen] = growth_seen(method_named("verlet"), p, 8.04, {.step_size = 0.201}, 40);
  BOOST_TEST(seen > 100);
  BOOST_TEST(said > seen / 2);
  BOOST_TEST(said < 2 * seen);
}

BOOST_AUTO_TEST_CASE(adaptive_methods_that_let_an_oscillation_grow_say_so) {
  const Problem p = pushed(10);
  for (const char* name : {"cvode_bdf", "cvode_adams"}) {
    const Method& method = method_named(name);
    // Each look is the end of a step.
    const auto [said, seen] = growth_seen(method, p, 30, {.rtol = 1e-2}, 100);
    BOOST_TEST_CONTEXT(name << " says " << said << " and shows " << seen) {
      BOOST_TEST(seen > 10);
      BOOST_TEST(said > seen / 4);
      BOOST_TEST(said < seen * 4);
      BOOST_TEST(growth(method, p, 30, {.rtol = 1e-7}) < 1.5);
    }
  }
}

BOOST_AUTO_TEST_CASE(methods_with_soft_springs_above_their_limit_say_so_with_reached_end) {
  // A soft vibration of w = 10 rad/s beside a stiff one that the methods take care of.
  Problem p{{.dimension = 1, .node_mass = Vec::Ones(2)}, {0, Vec{{0, 0}}, Vec{{1, 1}}}};
  p.network.anchors = {{0, {0, 0, 0}, {1e4, 0}, Holds::always, true},
                       {1, {0, 0, 0}, {100, 0}, Holds::always, false}};
  p.network.offers_split = true;
  for (const char* name : {"linear_midpoint", "linear_midpoint4", "arkode_mri3", "arkode_mri4"}) {
    BOOST_TEST_CONTEXT(name) {
      const Run fine = run(method_named(name), p, 5, {.step_size = 0.01});
      BOOST_TEST(fine.summary.message == "");
      BOOST_TEST(fine.summary.energy_growth < 1.5);
      // A few steps at h w = 3 or 6, far beyond the limits of all of them.
      const bool is_mri = method_named(name).asks(Need::split_forces);
      const Run coarse =
          run(method_named(name), p, is_mri ? 0.6 : 1.8, {.step_size = is_mri ? 0.3 : 0.6});
      BOOST_TEST(coarse.summary.message == "");
      BOOST_TEST(coarse.summary.energy_growth > 1e3);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_linearly_implicit_step_that_goes_anywhere_and_comes_back_is_seen) {
  // Crumpled nets: where compressed springs make M - h^2 K nearly singular, one step throws nodes
  // far away, and the next ones damp that again. Each energy is computed, so none is missed.
  const Method& method = method_named("semi_implicit_euler");
  std::mt19937 random(7);
  int came_back = 0;
  for (int net = 0; net < 60; ++net) {
    const Problem p = crumpled(random);
    const Options options{.step_size =
                              std::pow(10, std::uniform_real_distribution(-2.5, -1.)(random))};
    const auto system = make_mass_spring(p.network);
    const double start = total_energy(*system, p.initial);
    double most = start, last = start, lowest = system->potential(p.initial.q);
    Observer each{{}, [&](const State& s) {
                    last = total_energy(*system, s);
                    most = std::max(most, last);
                    lowest = std::min(lowest, system->potential(s.q));
                  }};
    for (int i = 1; i <= 40; ++i) each.times.push_back(i * options.step_size);
    const Run r = run(method, *system, p.initial, each.times.back(), options, each);
    if (r.summary.outcome != Outcome::reached_end) continue;
    const double grown = 1 + (most - start) / (start - lowest);
    came_back += grown > 2 && last < start;
    // The lowest energy ahead counts, too, if all of it grew.
    BOOST_TEST(r.summary.energy_growth >= 1 + (grown - 1) / 2, "net " << net << ": " << grown);
    BOOST_TEST(r.summary.energy_growth < grown * (1 + 1e-9));
  }
  BOOST_TEST(came_back >= 5);
}

BOOST_AUTO_TEST_CASE(a_loss_is_what_the_last_energy_says) {
  // (1 + (h w)^2)^-1 a step.
  const Run damped = run(method_named("implicit_euler"), pushed(10), 1, {.step_size = 0.01});
  BOOST_TEST(damped.summary.energy_loss == 1 - std::pow(1.01, -100),
             boost::test_tools::tolerance(1e-9));
  BOOST_TEST(damped.summary.energy_lost == damped.summary.energy_loss / 2,
             boost::test_tools::tolerance(1e-9));
  // A fall turns energy into speed and loses none.
  for (const Method& method : general_methods()) {
    if (method.stability_limit == 0 || method.order == 1) continue;
    BOOST_TEST(
        run(method, falling(), 0.3, options_of(method, 0.001, 1e-6)).summary.energy_loss < 0.01,
        method.name);
  }
  // The losses of parts are compared with the energies of all: here 1/2 J and 1/2 J.
  const auto both = in_parts(pushed(1e-3).network, pushed(10).network);
  const Run r = run(method_named("implicit_euler"), both, {0, Vec{{0, 0}}, Vec{{1, 1}}}, 1,
                    {.step_size = 0.01});
  BOOST_TEST(r.summary.energy_loss == damped.summary.energy_loss / 2,
             boost::test_tools::tolerance(1e-6));
}

BOOST_AUTO_TEST_CASE(of_several_parts_the_worst_counts) {
  const auto both = in_parts(pushed(1).network, pushed(11).network);
  const Run r =
      run(method_named("verlet"), both, {0, Vec{{0, 0}}, Vec{{1000, 1e-3}}}, 6, {.step_size = 0.2});
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(r.summary.energy_growth > 1e6);
}

BOOST_AUTO_TEST_SUITE_END()
