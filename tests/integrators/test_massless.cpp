#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(massless)

using namespace qddot;

namespace {

constexpr double g = 9.81;

// The mass of two_in_series() under the one spring that both are. It swings by 0.09 m about a
// stretch of 0.16 m: gravity keeps both in tension.
Problem one_spring(int dimension) {
  Problem p = two_in_series(dimension);
  p.network.node_mass = Vec{{2}};
  p.network.anchors = {{0, {0, 0, 0}, {120, 1.7}}};
  p.network.links.clear();
  p.initial = {0, p.initial.q.tail(dimension), Vec::Zero(dimension)};
  return p;
}

// Springs differ by two orders, so that some massless nodes hang on soft ones.
Problem massless_network(std::mt19937& random, int scene) {
  const int dimension = 1 + scene % 3;
  Problem p = random_network(random, dimension, 5, 1.4);
  for (auto& link : p.network.links) {
    link.law.stiffness *= std::pow(10, std::uniform_real_distribution<>(0, 2)(random));
  }
  p.network.node_mass[1] = p.network.node_mass[3] = 0;
  // Springs of rest length zero pull whatever happens, and hold what they touch for ever.
  const auto is_massless = [](int node) { return node == 1 || node == 3; };
  if (scene % 2 == 0) {
    for (auto& link : p.network.links) {
      if (is_massless(link.i) || is_massless(link.j)) link.law.rest_length = 0;
    }
    for (auto& anchor : p.network.anchors) {
      if (is_massless(anchor.i)) anchor.law.rest_length = 0;
    }
  }
  return p;
}

struct Verdict {
  double force = INFINITY;       // N, on the massless node at the end
  double difference = INFINITY;  // m or m/s, of the mass from its motion under one spring
};

Verdict judge(const Method& method, int dimension, double rtol = 1e-6) {
  const Problem two = two_in_series(dimension), one = one_spring(dimension);
  const auto series = make_mass_spring(two.network);
  const Options options = options_of(method, 0.01, rtol);
  const Run a = run(method, *series, two.initial, 1, options);
  const Run b = run(method, one, 1, options);
  BOOST_REQUIRE(b.summary.message == "");
  if (a.summary.outcome != Outcome::reached_end || !is_finite(a.state)) return {};
  return {force_at(*series, a.state.q).head(dimension).norm(),
          std::max(distance(a.state.q.tail(dimension), b.state.q),
                   distance(a.state.v.tail(dimension), b.state.v))};
}

std::vector<Method> accepting(Knob knob) {
  return methods_where(
      [&](const Method& m) { return m.is(Trait::accepts_massless) && m.knob == knob; });
}

// The force on a massless node [N] that Newton's iteration of an adaptive method leaves. The place
// between springs of 500 N/m has an error of a third of the tolerance. That is the root mean square
// over up to 12 entries of 2 m.
double balance(double rtol) { return 500. / 3 * std::sqrt(12) * 3 * rtol; }

// The hammock with its second node massless and all springs in tension; that node is drawn where
// its forces do not balance.
Problem massless_hammock(int dimension) {
  Problem p = hammock(dimension);
  p.network.node_mass[1] = 0;
  for (auto& link : p.network.links) link.law.rest_length *= 0.7;
  return p;
}

// The force on the massless second node and its rate of change, (K v).
Vec second_force(const System& system, const State& s) {
  const Index d = system.size() / 4;
  return force_at(system, s.q).segment(d, d);
}
Vec second_force_rate(const System& system, const State& s) {
  const Index d = system.size() / 4;
  return (dense(stiffness_at(system, s.q)) * s.v).segment(d, d);
}

}  // namespace

BOOST_DATA_TEST_CASE(two_springs_with_a_massless_node_between_are_the_one_in_series,
                     accepting(Knob::step_size), method) {
  for (const int dimension : {1, 3}) {
    BOOST_TEST_CONTEXT(method.name << " in dimension " << dimension) {
      const Verdict verdict = judge(method, dimension);
      // Forces are linear on the line, so that one Newton step finds balance. What is left is
      // rounding of 100 steps with forces of 100 N and a matrix of condition 1e3.
      BOOST_TEST(verdict.force < 1e-9);
      BOOST_TEST(verdict.difference < 1e-11);
    }
  }
}

BOOST_DATA_TEST_CASE(adaptive_methods_come_as_near_to_the_one_in_series_as_their_tolerance_asks,
                     accepting(Knob::rtol), method) {
  for (const int dimension : {1, 3}) {
    BOOST_TEST_CONTEXT(method.name << " in dimension " << dimension) {
      double last = INFINITY;
      for (const double rtol : {1e-4, 1e-6, 1e-8}) {
        const Verdict verdict = judge(method, dimension, rtol);
        BOOST_TEST(verdict.difference < 1000 * rtol);  // as in the suite `order`
        // Two errors, each of up to some 300 tolerances, may cancel at one tolerance.
        BOOST_TEST(verdict.difference < std::max(last, 300 * rtol));
        BOOST_TEST(verdict.force < balance(rtol));
        last = verdict.difference;
      }
    }
  }
}

BOOST_DATA_TEST_CASE(a_massless_node_drawn_out_of_balance_is_brought_to_it_and_moves_with_it,
                     accepting(Knob::rtol), method) {
  for (const int dimension : {1, 2, 3}) {
    for (const double rtol : {1e-4, 1e-7, 1e-10}) {
      BOOST_TEST_CONTEXT(method.name << " in dimension " << dimension << " at " << rtol) {
        const Problem p = massless_hammock(dimension);
        const auto system = make_mass_spring(p.network);
        BOOST_TEST(second_force(*system, p.initial).norm() > 1);
        BOOST_TEST(second_force_rate(*system, p.initial).norm() > 1);
        // The first look is after a step of 1 us, the last one after one that is as short.
        Film film{{1e-6, 1 - 1e-6}};
        const Run r = run(method, p, 1, {.rtol = rtol}, film.observer());
        BOOST_TEST(r.summary.message == "");
        std::vector<State>& seen = film.seen;
        seen.push_back(r.state);
        const double energy = total_energy(*system, seen.front());
        for (const State& s : seen) {
          BOOST_TEST(second_force(*system, s).norm() < balance(rtol));
          // Solved for with stiffnesses of 500 N/m and velocities of 10 m/s.
          BOOST_TEST(second_force_rate(*system, s).norm() < 1e-10);
          // No energy is lost, but for the 1000 tolerances of sums of 100 J.
          BOOST_TEST(std::abs(total_energy(*system, s) - energy) < 1000 * rtol * 100);
        }
        // The others have not moved at first.
        for (const Index node : {0, 2, 3}) {
          const auto at = [&](const Vec& x) { return x.segment(node * dimension, dimension); };
          BOOST_TEST(distance(at(seen[0].q), at(p.initial.q)) < 1e-5);
          BOOST_TEST(distance(at(seen[0].v), at(p.initial.v)) < 1e-3);
        }
        // Two runs of unlike tolerances end alike, the massless node's velocity included.
        const Run other = run(method, *system, p.initial, 1, {.rtol = rtol / 10});
        BOOST_TEST(distance(other.state, r.state) < 1000 * rtol * 10);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(random_networks_with_massless_nodes_run_at_every_tolerance_or_at_none) {
  std::mt19937 random(14);
  int reached = 0, slack = 0;
  for (int scene = 0; scene < 12; ++scene) {
    const Problem p = massless_network(random, scene);
    std::vector<Run> runs;
    for (const double rtol : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
      runs.push_back(run(method_named("ida"), p, 0.5, {.rtol = rtol}));
      const Summary& summary = runs.back().summary;
      BOOST_TEST_CONTEXT("scene " << scene << " at " << rtol) {
        BOOST_TEST((summary.outcome == runs.front().summary.outcome), summary.message);
        const bool is_slack = summary.outcome == Outcome::went_slack ||
                              summary.message.starts_with("no positions of the massless nodes");
        BOOST_TEST((is_slack || summary.outcome == Outcome::reached_end), summary.message);
        // The time at which springs let go of a node does not depend on a sufficiently small
        // tolerance. A coarse one may let go at another swing.
        if (rtol < 1e-7) BOOST_TEST(std::abs(summary.t_reached - runs[2].summary.t_reached) < 0.01);
        reached += summary.outcome == Outcome::reached_end;
        slack += is_slack;
      }
    }
  }
  BOOST_TEST(reached >= 30);  // those that are held
  BOOST_TEST(reached + slack == 60);
}

BOOST_AUTO_TEST_CASE(what_springs_hardly_hold_at_the_start_is_no_obstacle_at_any_tolerance) {
  // A mass hangs, aside, on two springs with a massless node between them, drawn at rest lengths of
  // six digits. They are stretched by some 1e-7 m and hold the node across by 1e-7 of their
  // stiffness. So rounding of forces moves it by more than 1e-12 m.
  Problem p{{.dimension = 3, .gravity = {0, 0, -g}}, {}};
  p.network.node_mass = Vec{{0, 1}};
  p.network.anchors = {{0, {0, 0, 0}, {83140.4, 0.850063}}};
  p.network.links = {{0, 1, {9338.66, 0.949805}}};
  p.initial = {0, Vec{{0.0046, 0.1945, -0.8275, 0.0097, 0.4118, -1.7521}}, Vec::Zero(6)};
  const Run expected = run(method_named("ida"), p, 0.05, {.rtol = 1e-11});
  BOOST_TEST(expected.summary.message == "");
  for (const double atol : {1e-10, 1e-11, 1e-12, 1e-13, 1e-14}) {
    const Run r = run(method_named("ida"), p, 0.05, {.rtol = 1e-9, .atol = atol});
    BOOST_TEST(r.summary.message == "", atol);
    BOOST_TEST(distance(r.state, expected.state) < 1e-6);  // a thousand steps to 1e-9
  }
}

BOOST_AUTO_TEST_CASE(energy_elsewhere_does_not_let_a_massless_node_jump) {
  std::mt19937 random(14);
  int lost = 0;
  for (int scene = 0; scene < 40; ++scene) {
    Problem p = massless_network(random, scene);
    const int dimension = p.network.dimension, nodes = static_cast<int>(p.network.node_mass.size());
    const Run expected = run(method_named("ida"), p, 0.5, {.rtol = 1e-8});
    // A heavy mass that swings beside it: its energy is ten thousand times the network's.
    p.network.node_mass.conservativeResize(nodes + 1);
    p.network.node_mass[nodes] = 1e6;
    p.network.anchors.push_back({nodes, {0, 0, 0}, {.stiffness = 1e6}});
    for (Vec* x : {&p.initial.q, &p.initial.v}) {
      x->conservativeResize(dimension * (nodes + 1));
      x->tail(dimension).setConstant(1);
    }
    for (const double rtol : {1e-6, 1e-7}) {
      const Run r = run(method_named("ida"), p, 0.5, {.rtol = rtol});
      BOOST_TEST_CONTEXT("scene " << scene << " at " << rtol << ": " << r.summary.message) {
        BOOST_TEST((r.summary.outcome == expected.summary.outcome));
        // When, is known no better than where the nodes are.
        BOOST_TEST(std::abs(r.summary.t_reached - expected.summary.t_reached) < 0.01);
      }
    }
    lost += expected.summary.outcome == Outcome::went_slack;
  }
  BOOST_TEST(lost >= 5);
}

BOOST_DATA_TEST_CASE(where_all_nodes_are_massless_all_are_at_rest_in_balance, accepting(Knob::rtol),
                     method) {
  Problem p = Oscillator().problem();
  p.network.node_mass.setZero();
  const Run r = run(method, p, 1, {.rtol = 1e-6});
  BOOST_TEST(r.summary.message == "");
  BOOST_TEST(std::abs(r.state.q[0]) < 1e-6);
  BOOST_TEST(r.state.v[0] == 0);
}

BOOST_DATA_TEST_CASE(a_massless_node_whose_forces_balance_nowhere_is_refused, accepting(Knob::rtol),
                     method) {
  // f = -1 - q^2 has no root, and 1 N on a node without springs is not balanced anywhere.
  Problem p = Oscillator().problem();
  p.network.node_mass = Vec{{1, 0}};
  p.network.load = Vec{{0, 1}};
  p.initial = {0, Vec::Ones(2), Vec::Zero(2)};
  const auto unbound = make_mass_spring(p.network);
  Problem bound = p;
  bound.network.anchors.push_back({1, {0, 0, 0}, {1}});
  const auto system = make_mass_spring(bound.network);
  Relay rootless(*system);
  rootless.after_force = [](const ConstVec& q, MutableVec f) { f[1] = -1 - q[1] * q[1]; };
  rootless.after_stiffness = [](const Vec& q, SymmetricMatrix& k) { k.coeffRef(1, 1) = -2 * q[1]; };
  for (const System* bad :
       {static_cast<const System*>(unbound.get()), static_cast<const System*>(&rootless)}) {
    BOOST_TEST_CONTEXT(method.name) {
      const Run r = run(method, *bad, p.initial, 1, {.rtol = 1e-6});
      BOOST_TEST(name(r.summary.outcome) == "newton_failed");
      BOOST_TEST(r.summary.message.starts_with(
          "no positions of the massless nodes were found in which their forces balance at t = 0 "
          "s: draw them where their springs, stretched, pull equally (IDA "));
      BOOST_TEST(same(r.state, p.initial));
    }
  }
  BOOST_TEST(run(method, *system, p.initial, 1, {.rtol = 1e-6}).summary.message == "");
}

BOOST_AUTO_TEST_CASE(methods_of_fixed_steps_balance_massless_nodes_off_the_line_too) {
  const Problem p = massless_hammock(2);
  const auto system = make_mass_spring(p.network);
  for (const char* method : {"implicit_euler", "bdf2"}) {
    for (const double solve_tolerance : {1e-4, 1e-12}) {
      const Run r = run(method_named(method), *system, p.initial, 1,
                        {.step_size = 0.01, .solve_tolerance = solve_tolerance});
      BOOST_TEST(r.summary.message == "");
      // First corrections are below the 1 mm that accelerations move a node in a step; the springs'
      // 200 N/m on it make a force of what is left. Forces of 100 N round by 1e-14 of them.
      BOOST_TEST(force_at(*system, r.state.q).segment<2>(2).norm() < 0.2 * solve_tolerance + 1e-12);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
