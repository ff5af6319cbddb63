#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

// A massless node on a shallow truss, pulled down by a mass on a soft spring. The node's balance
// can be followed down to a lowest place of the mass. The only balance beyond it is below the pins,
// as stable as the lost one.
BOOST_AUTO_TEST_SUITE(snap_through)

using namespace qddot;

namespace {

constexpr double g = 9.81;
constexpr double half_span = 1, rise = 0.3, hung = 0.2;  // m
constexpr double k = 1000, soft = 20;                    // N/m, of a bar and of the spring
const double bar = std::hypot(half_span, rise);          // m, at rest

double force_upwards(double y) {
  const double length = std::hypot(half_span, y);
  return 2 * k * (bar - length) * y / length;
}

// The height at which the truss, with 2 k (L a^2 / l^3 - 1) more push a metre, gives way as the
// spring does.
const double lost_at = std::sqrt(
    std::pow(bar * half_span * half_span / (1 + soft / (2 * k)), 2 / 3.) - half_span * half_span);
const double mass_then = lost_at - hung - force_upwards(lost_at) / soft;

// The mass whose weight does the work until then, falling from rest.
double threshold() {
  const double shortened = bar - std::hypot(half_span, lost_at);
  const double stretched = force_upwards(lost_at) / soft;
  const double energy = k * shortened * shortened + 0.5 * soft * stretched * stretched;
  return energy / (g * (rise - hung - mass_then));
}

Problem truss(double mass) {
  Problem p{{.dimension = 2, .gravity = {0, -g, 0}, .node_mass = Vec{{0, mass}}}, {}};
  p.network.anchors = {{0, {-half_span, 0, 0}, {k, bar}}, {0, {half_span, 0, 0}, {k, bar}}};
  p.network.links = {{0, 1, {soft, hung}}};
  p.initial = {0, Vec{{0, rise, 0, rise - hung}}, Vec::Zero(4)};
  return p;
}

}  // namespace

BOOST_DATA_TEST_CASE(a_balance_that_is_lost_ends_the_run_though_another_is_within_reach,
                     methods_with(Trait::accepts_massless), method) {
  // Implicit Euler at 1 ms loses some 1 % of the energy until then.
  const Problem held = truss(0.97 * threshold()), lost = truss(1.03 * threshold());
  for (const double h : {3e-3, 1e-3, 3e-4, 1e-4}) {
    BOOST_TEST_CONTEXT(method.name << " at " << h) {
      const Options options = options_of(method, h, 1e-2 * h);
      const Run swing = run(method, held, 1, options);
      BOOST_TEST(swing.summary.message == "");
      BOOST_TEST(swing.state.q[1] > lost_at);

      const Run fall = run(method, lost, 1, options);
      // A solve that begins where no balance is left may find none.
      BOOST_TEST((fall.summary.outcome == Outcome::went_slack ||
                  fall.summary.outcome == Outcome::newton_failed));
      BOOST_TEST(fall.summary.message.find("massless node") != std::string::npos);
      // The mass moves by less than 1 m/s, and in three steps a jump is told from its speed.
      BOOST_TEST(fall.state.q[3] > mass_then - 3 * h);
      BOOST_TEST(fall.state.q[3] < mass_then + 3 * h);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
