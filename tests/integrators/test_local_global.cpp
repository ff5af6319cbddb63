#include <boost/test/unit_test.hpp>

#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(local_global)

using namespace qddot;

namespace {

std::vector<Method> all() { return methods_with(Option::iterations); }

// A step of h with `iterations` iterations.
State step(const Method& method, const System& system, const State& start, double h,
           int iterations) {
  const Run r = run(method, system, start, start.t + h, {.step_size = h, .iterations = iterations});
  BOOST_REQUIRE(r.summary.message == "");
  BOOST_REQUIRE(r.summary.counts.steps == 1);
  return r.state;
}
State step(const Method& method, const Problem& p, double h, int iterations) {
  return step(method, *make_mass_spring(p.network), p.initial, h, iterations);
}

// The energy that the step minimises.
double energy(const System& system, const State& start, const State& end) {
  return system.kinetic(end.v - start.v) + system.potential(end.q);
}
double energy(const Problem& p, const State& end) {
  return energy(*make_mass_spring(p.network), p.initial, end);
}

// Networks with and without quartic springs, stretched and compressed.
std::vector<Problem> networks() {
  std::mt19937 random(17);
  std::vector<Problem> list;
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {1.3, 0.8}) {
      const Problem p = random_network(random, dimension, 7, stretch);
      list.push_back(p);
      list.push_back({without_quartic(p.network), p.initial});
    }
  }
  return list;
}

// A cloth that has fallen for 0.1 s.
struct Fallen {
  Model scene{generate(*find_generator("cloth"), {{"nodes", 12}}, "test")};
  State state =
      run(method_named("verlet"), scene.system(), scene.initial(), 0.1, {.step_size = 1e-4}).state;
};

// A mass on a spring of 100 N/m and 1 m, pulled out to 1.5 m and 1 um beside the line of that.
struct Transverse {
  static constexpr double m = 0.5, k = 100, l0 = 1, l = 1.5, h = 0.05;
  Transverse() {
    Network network{.dimension = 2, .gravity = {k * (l - l0) / m, 0, 0}, .node_mass = Vec{{m}}};
    network.anchors = {{0, {0, 0, 0}, {k, l0}}};
    system = make_mass_spring(network);
  }
  std::unique_ptr<System> system;
  State start{0, Vec{{l, 1e-6}}, Vec::Zero(2)};
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_energy_falls_with_every_iteration) {
  for (const Problem& p : networks()) {
    for (const Method& method : all()) {
      if (method.name == "local_global_chebyshev") continue;  // which may rise in between
      for (const double h : {0.01, 0.1, 1.0}) {
        BOOST_TEST_CONTEXT(method.name << ", h = " << h) {
          double last = energy(p, {0, p.initial.q + h * p.initial.v, p.initial.v});
          for (int iterations = 1; iterations <= 25; ++iterations) {
            const double now = energy(p, step(method, p, h, iterations));
            // Energies of 1e3 J are rounded, and speeds of 100 m/s in them.
            BOOST_TEST(now <= last + 1e-12 * std::max(1e3, std::abs(last)));
            if (iterations == 1) BOOST_TEST(now < last);
            last = now;
          }
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(many_iterations_end_where_implicit_euler_does) {
  // Every network's energy has one minimum near by at this h, which all methods find.
  constexpr double h = 0.02;
  for (const Problem& p : networks()) {
    const auto system = make_mass_spring(p.network);
    const State exact = run(method_named("implicit_euler"), *system, p.initial, h,
                            {.step_size = h, .solve_tolerance = 1e-12})
                            .state;
    for (const Method& method : all()) {
      BOOST_TEST_CONTEXT(method.name) {
        // A line search stops where rounding hides what is left of the energy, some
        // sqrt(1e-16 100 J / 1 kg).
        BOOST_TEST(distance(step(method, *system, p.initial, h, 500).v, exact.v) < 1e-6);
        // Only quartic springs need a second iteration on a line.
        if (p.network.dimension == 1 && offered(system->laplacian()).bounds_stiffness()) continue;
        BOOST_TEST(distance(step(method, *system, p.initial, h, 1).v, exact.v) > 1e-6);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(iterations_after_the_last_that_gains_anything_do_no_harm) {
  const Fallen cloth;
  const System& system = cloth.scene.system();
  for (const char* name : {"local_global_anderson", "local_global_lbfgs"}) {
    const State converged = step(method_named(name), system, cloth.state, 0.01, 300);
    const State later = step(method_named(name), system, cloth.state, 0.01, 2000);
    // As far as rounding hides the energy, which is one of 1e-3 J at 1e-3 kg a node.
    BOOST_TEST(distance(converged.q, later.q) < 1e-7, name);
  }
}

BOOST_AUTO_TEST_CASE(where_springs_have_no_rest_length_one_iteration_is_the_whole_step) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = linear_hammock(dimension);
    const State exact = run(method_named("implicit_euler"), p, 0.1, {.step_size = 0.1}).state;
    for (const Method& method : all()) {
      for (const int iterations : {1, 2, 30}) {
        BOOST_TEST_CONTEXT(method.name << ", " << iterations) {
          // Two ways of one solve, of condition 100.
          BOOST_TEST(distance(step(method, p, 0.1, iterations), exact) < 1e-12);
        }
      }
    }
  }
}

// Across the spring, H = m + h^2 tau/l and the metric is P = m + h^2 k. So each iteration leaves (P
// - H)/P = h^2 k (l0/l) / (m + h^2 k) of the error there.
BOOST_AUTO_TEST_CASE(errors_shrink_by_what_theory_says) {
  using T = Transverse;
  const T t;
  const double left = T::h * T::h * T::k * (T::l0 / T::l) / (T::m + T::h * T::h * T::k);
  const double minimum = T::m * 1e-6 / (T::m + T::h * T::h * T::k * (T::l - T::l0) / T::l);
  const Method& method = method_named("local_global");
  double last = 1e-6 - minimum;
  for (int iterations = 1; iterations <= 5; ++iterations) {
    const double error = step(method, *t.system, t.start, T::h, iterations).q[1] - minimum;
    // The spring is longer by 1e-12 of it for being oblique; the last error is 5e-10 m, and what it
    // is told by rounds by 1e-16 m.
    BOOST_TEST(std::abs(error / last - left) < 2e-6);
    last = error;
  }
  // Noticed: the rate of the same spring at its rest length.
  BOOST_TEST(left < 0.9 * T::h * T::h * T::k / (T::m + T::h * T::h * T::k));
}

BOOST_AUTO_TEST_CASE(accelerations_reach_the_same_minimum_in_fewer_iterations) {
  const Fallen cloth;
  const System& system = cloth.scene.system();
  constexpr double h = 0.02;
  const State exact =
      run(method_named("implicit_euler"), system, cloth.state, cloth.state.t + h, {.step_size = h})
          .state;
  const auto error = [&](const Method& method, int iterations) {
    return distance(step(method, system, cloth.state, h, iterations).q, exact.q);
  };
  const double after_40 = error(method_named("local_global"), 40);
  BOOST_TEST(after_40 > 1e-7);
  for (const char* name :
       {"local_global_chebyshev", "local_global_anderson", "local_global_lbfgs"}) {
    BOOST_TEST(error(method_named(name), 30) < after_40, name);
  }
}

BOOST_AUTO_TEST_CASE(they_take_the_iterations_they_are_told_and_one_factorisation_a_step_size) {
  constexpr std::int64_t steps = 7;
  const Problem quadratic{without_quartic(hammock(3).network), hammock(3).initial};
  for (const Problem& p : {hammock(2), quadratic, linear_hammock(2)}) {
    for (const Method& method : all()) {
      for (const int iterations : {0, 1, 4, 10}) {
        BOOST_TEST_CONTEXT(method.name << ", " << iterations) {
          const std::int64_t each = iterations == 0 ? 10 : iterations;
          const Options options{.step_size = 0.01, .iterations = iterations};
          const Run r = run(method, p, steps * 0.01, options);
          BOOST_TEST(r.summary.counts == (Counts{.steps = steps,
                                                 .force_evaluations = each * steps,
                                                 .factorizations = 1,
                                                 .solves = each * steps}));
          const Run rest = run(method, p, (steps + 0.4) * 0.01, options);
          BOOST_TEST(rest.summary.counts.factorizations == 2);
          BOOST_TEST(rest.summary.counts.solves == each * (steps + 1));
        }
      }
    }
  }
}

BOOST_DATA_TEST_CASE(on_quartic_springs_far_beyond_their_length_the_step_is_shortened, all(),
                     method) {
  Network network{.dimension = 1, .node_mass = Vec{{1}}};
  network.anchors = {{0, {0, 0, 0}, {.stiffness = 1, .rest_length = 1, .quartic = 1000}}};
  const auto system = make_mass_spring(network);
  const State start{0, Vec{{3}}, Vec{{0}}};
  constexpr double h = 1;
  // A whole step would go to 3 - h^2 c 8 / (m + h^2 k) = -4000.
  const State end = step(method, *system, start, h, 1);
  BOOST_TEST(energy(*system, start, end) < energy(*system, start, start));
  BOOST_TEST(std::abs(end.q[0]) < 3);
}

BOOST_AUTO_TEST_SUITE_END()
