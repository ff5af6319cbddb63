#include <complex>
#include <optional>

#include <boost/test/unit_test.hpp>

#include "integrators/sundials/arkode.hpp"
#include "integrators/sundials/imaginary_stability.hpp"
#include "integrators/sundials/low_storage.hpp"
#include "integrators/sundials/prince_dormand.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(imaginary_stability)

using namespace qddot;

namespace {

using namespace qddot::sundials;

template <ARKODE_ERKTableID id>
ButcherTable stock_table() {
  return ButcherTable(check(ARKodeButcherTable_LoadERK(id)));
}

// The same methods without the bound on their steps.
template <ButcherTable (*make_table)()>
class Unbounded final : public Arkode {
 public:
  explicit Unbounded(SystemRun& run)
      : Arkode(run, {.explicit_table = make_table().get()}, right_hand_side, nullptr, nullptr,
               run.system()) {}
};

// A method and its table. The limit is that of |R| = 1 in the literature, for tables of as many
// stages as the order. The last member makes the method without a bound.
struct Named {
  const char* method;
  ButcherTable (*make_table)();
  std::optional<double> limit;
  decltype(Method::make) make_unbounded;
};
template <ButcherTable (*make_table)()>
Named named(const char* method, std::optional<double> limit = {}) {
  return {method, make_table, limit, create_steps<Unbounded<make_table>>};
}
// |R|^2 is 1 at the limit. Order 4: 1 - y^6/72 + y^8/576, at y = 2 sqrt 2. Order 3: 1 - y^4/12 +
// y^6/36, at y = sqrt 3. Order 2: 1 + y^4/4, only at 0.
const Named tables[] = {
    named<stock_table<ARKODE_HEUN_EULER_2_1_2>>("arkode_erk2", 0),
    named<stock_table<ARKODE_BOGACKI_SHAMPINE_4_2_3>>("arkode_erk3", std::sqrt(3)),
    named<stock_table<ARKODE_ZONNEVELD_5_3_4>>("arkode_erk4", 2 * std::sqrt(2)),
    named<stock_table<ARKODE_DORMAND_PRINCE_7_4_5>>("arkode_erk5"),
    named<stock_table<ARKODE_VERNER_8_5_6>>("arkode_erk6"),
    named<prince_dormand_8_7>("arkode_erk8")};

// |1 + z + ... + z^p / p!| at z = iy: R of every table whose formula has as many stages as order p.
double exponential_series(int p, double y) {
  std::complex<double> sum = 1, term = 1;
  for (int k = 1; k <= p; ++k) sum += term *= std::complex<double>(0, y / k);
  return std::abs(sum);
}

double amplification(const ARKodeButcherTableMem& table, double y) {
  return std::abs(stability_function(table, {0, y}));
}

constexpr double growth = 1e-3, resolution = 1e-3;  // as imaginary_stability() says

// A method that averages steps of explicit Euler, with its R and stages.
struct Averaging {
  const char* method;
  int order, stages;
  std::complex<double> (*r)(std::complex<double>);
};
const Averaging averaging[] = {{"arkode_ssp3", 3, 4, growth_of_ssp3},
                               {"arkode_ssp4", 4, 10, growth_of_ssp4}};

// A chain of 100 masses that starts at rest, drawn as its slowest mode, whose frequency is
// 1/64 of w_max: the others move by rounding alone.
constexpr double rtol = 1e-3;
constexpr int masses = 100;
constexpr double mass = 1e-3, stiffness = 1e3;
const double gershgorin = 2 * std::sqrt(stiffness / mass);
double frequency(int j) { return gershgorin * std::sin(j * M_PI / (2 * (masses + 1))); }
// The cost of a run, and the larger of its errors in q [m] and v [m/s].
struct Ending {
  Counts counts;
  double error;
};
struct SmoothChain {
  std::unique_ptr<System> system = make_mass_spring(linear_chain(masses, mass, stiffness));
  State at(double t) const {
    State s{t, Vec::LinSpaced(masses, 1, masses), Vec(masses)};
    const Vec shape = Vec::NullaryExpr(
        masses, [](Index i) { return std::sin(static_cast<double>(i + 1) * M_PI / (masses + 1)); });
    s.q += std::cos(frequency(1) * t) * shape;
    s.v = -frequency(1) * std::sin(frequency(1) * t) * shape;
    return s;
  }
  double t_end = 5 * 2 * M_PI / frequency(1);

  Ending run_by(const Method& method) const {
    const Run r = run(method, *system, at(0), t_end, {.rtol = rtol});
    BOOST_TEST(r.summary.message == "");
    return {r.summary.counts, distance(r.state, at(t_end))};
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(up_to_its_limit_no_table_lets_a_vibration_grow_and_beyond_it_does) {
  for (const auto& [method, make_table, known, make_unbounded] : tables) {
    BOOST_TEST_CONTEXT(method) {
      const ButcherTable table = make_table();
      BOOST_TEST(table->q == method_named(method).order);
      const double limit = qddot::sundials::imaginary_stability(*table);
      BOOST_TEST(limit > 0.1);
      if (known) {
        for (const double y : {0.0, 0.1, 1.0, 2.0, 5.0, 30.0}) {
          const double expected = exponential_series(table->q, y);
          // Rounding of some ten terms.
          BOOST_TEST(std::abs(amplification(*table, y) - expected) < 1e-14 * (1 + expected));
        }
        BOOST_TEST(limit > *known - resolution);
        // y^4/8 = 1e-3 of order 2; the slope of |R| at the limit is 0.29 and 1.9.
        BOOST_TEST(limit < *known + (table->q == 2 ? 0.3 : 0.01));
      }
      BOOST_TEST(limit < 2 * table->stages);
      for (double y = 0; y <= limit; y += resolution / 7) {
        if (amplification(*table, y) > 1 + growth + 1e-6) BOOST_ERROR("grows at " << y);
      }
      BOOST_TEST(amplification(*table, limit + 1.01 * resolution) > 1 + growth);
    }
  }
}

BOOST_AUTO_TEST_CASE(averaging_methods_have_the_order_of_their_growth) {
  for (const auto& [method, order, stages, r] : averaging) {
    BOOST_TEST_CONTEXT(method) {
      // R(z) = exp(z) + c z^(p + 1) + ...: half of z has a 2^(p + 1)th of the error.
      const auto error = [&, growth_factor = r](double y) {
        return std::abs(growth_factor({0, y}) - std::polar(1., y));
      };
      const double observed = std::log2(error(0.2) / error(0.1)) - 1;
      BOOST_TEST(std::abs(observed - order) < 0.1);
      const double limit = qddot::sundials::imaginary_stability(r, stages);
      BOOST_TEST(std::abs(r({0, limit})) < 1 + growth);
      BOOST_TEST(std::abs(r({0, limit + 1.01 * resolution})) > 1 + growth);
      BOOST_TEST(limit > 2);
    }
  }
}

#if QDDOT_SUNDIALS >= 70200

BOOST_AUTO_TEST_CASE(a_step_of_an_averaging_method_multiplies_a_vibration_by_its_r) {
  const Oscillator oscillator;
  const Problem p = oscillator.problem();
  for (const auto& [method, order, stages, r] : averaging) {
    BOOST_TEST_CONTEXT(method) {
      Method steps = method_named(method);
      steps.knob = Knob::step_size;
      for (const double y : {0.1, 1.0, 3.0}) {
        // q + i v/w rotates by -i w.
        const auto amplitude = [&](const State& s) {
          return std::complex<double>(s.q[0], s.v[0] / oscillator.omega());
        };
        const double h = y / oscillator.omega();
        const State end = run(steps, p, h, {.step_size = h}).state;
        BOOST_TEST(std::abs(amplitude(end) - r({0, -y}) * amplitude(p.initial)) < 1e-14);
      }
      const SmoothChain chain;
      const Ending bounded = chain.run_by(method_named(method));
      const double longest = qddot::sundials::imaginary_stability(r, stages) / gershgorin;
      BOOST_TEST(static_cast<double>(bounded.counts.steps) * longest >= chain.t_end);
      BOOST_TEST(static_cast<double>(bounded.counts.steps) * longest < 1.5 * chain.t_end);
      BOOST_TEST(bounded.counts.rejected == 0);
      BOOST_TEST(bounded.error < 10 * rtol);
    }
  }
}

#endif

BOOST_AUTO_TEST_CASE(explicit_methods_hold_their_steps_to_the_limit_of_the_stiffest_mode) {
  const SmoothChain chain;
  for (const auto& [name, make_table, known, make_unbounded] : tables) {
    BOOST_TEST_CONTEXT(name) {
      const Ending bounded = chain.run_by(method_named(name));
      const double longest = qddot::sundials::imaginary_stability(*make_table()) / gershgorin;
      // The mean step is below the limit, most steps are held to it, and none is in vain.
      BOOST_TEST(static_cast<double>(bounded.counts.steps) * longest >= chain.t_end);
      BOOST_TEST(static_cast<double>(bounded.counts.steps) * longest < 1.5 * chain.t_end);
      BOOST_TEST(bounded.counts.stability_limited_steps > bounded.counts.steps / 2);
      BOOST_TEST(bounded.counts.rejected == 0);
      // Speeds are up to 31 m/s.
      BOOST_TEST(bounded.error < 10 * rtol);
      // Without that bound the stiffest modes grow until the error test sees them.
      Method unbounded = method_named(name);
      unbounded.make = make_unbounded;
      const Ending free = chain.run_by(unbounded);
      BOOST_TEST(free.counts.stability_limited_steps == 0);
      BOOST_TEST(free.counts.rejected > 0);
      BOOST_TEST(free.error > 10 * bounded.error);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_error_estimate_of_order_8_sees_forces_that_depend_on_time_alone) {
  // For y' = t^k the formulas err by sum_i b_i c_i^k - 1/(k + 1).
  const auto defect = [](const ARKodeButcherTableMem& table, const double* b, int k) {
    double sum = -1. / (k + 1);
    for (int i = 0; i < table.stages; ++i) sum += b[i] * std::pow(table.c[i], k);
    return std::abs(sum);
  };
  const ButcherTable table = prince_dormand_8_7(), fehlberg = stock_table<ARKODE_FEHLBERG_13_7_8>();
  int order = 0, lower = 0;
  // ARKODE checks all conditions up to order 6, or 8 in newer versions; the order of runs is tested
  // for all methods.
  BOOST_TEST(ARKodeButcherTable_CheckOrder(table.get(), &order, &lower, nullptr) >= 0);
  BOOST_TEST((order == 6 || order == 8));
  BOOST_TEST((lower == 6 || lower == 7));
  for (int k = 0; k < 8; ++k) {
    // Rounding of thirteen terms of up to three.
    BOOST_TEST(defect(*table, table->b, k) < 1e-15);
    BOOST_TEST((defect(*table, table->d, k) < 2e-15) == (k < 7));
  }
  for (int k = 7; k < 20; ++k) {
    BOOST_TEST(std::abs(defect(*table, table->b, k) - defect(*table, table->d, k)) > 1e-5);
    BOOST_TEST(std::abs(defect(*fehlberg, fehlberg->b, k) - defect(*fehlberg, fehlberg->d, k)) <
               1e-15);
  }
}

BOOST_AUTO_TEST_CASE(errors_of_order_8_follow_the_tolerance_where_a_mass_flies_past_another) {
  // 12 m/s past the anchor of its spring at 3 mm.
  Problem p{{.dimension = 2, .node_mass = Vec::Ones(1)}, {0, Vec{{1, 0.003}}, Vec{{-12, 0}}}};
  p.network.anchors = {{0, {0, 0, 0}, {.stiffness = 48, .rest_length = 0.41}}};
  const auto end = [&](const char* method, double tolerance) {
    return run(method_named(method), p, 0.3, {.rtol = tolerance, .speed = 12}).state;
  };
  const State exact = end("dprkn12", 1e-13);
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    BOOST_TEST_CONTEXT("at " << tolerance) {
      // The force turns the mass within 3e-4 s: an error of its place there turns it otherwise.
      BOOST_TEST(distance(end("arkode_erk8", tolerance).q, exact.q) < 100 * tolerance);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
