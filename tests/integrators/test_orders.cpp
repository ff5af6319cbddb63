#include <boost/test/unit_test.hpp>

#include "integrators/sundials/orders.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(orders)

using namespace qddot;

namespace {

std::vector<Method> of_variable_order() {
  return methods_where([](const Method& method) { return method.varies_order(); });
}

Counts counts_of(const Method& method, const Options& options) {
  const Run r = run(method, hammock(2), 2, options);
  BOOST_REQUIRE(r.summary.message == "");
  return r.summary.counts;
}

// Conditions on the orders of any run up to `max_order`. Steps begin at order 1 and go up by one at
// a time, so that they cannot go down more often than up.
bool are_sound(const Counts& c, int max_order) {
  return c.order_sum >= c.steps && c.order_sum <= max_order * c.steps && c.order_reductions >= 0 &&
         c.order_reductions < c.steps / 2 && (max_order > 1 || c.order_reductions == 0);
}

}  // namespace

BOOST_AUTO_TEST_CASE(orders_are_added_up_and_reductions_counted) {
  qddot::sundials::Orders orders;
  Counts counts;
  for (const int order : {1, 1, 2, 3, 3, 1, 2, 1}) orders.note(order, counts);
  BOOST_TEST(counts == (Counts{.order_sum = 14, .order_reductions = 2}));
}

BOOST_AUTO_TEST_CASE(exactly_the_methods_of_variable_order_tell_of_their_orders) {
  for (const Method& method : general_methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      const Counts c = counts_of(method, options_of(method, 0.01, 1e-6));
      BOOST_TEST((c.order_sum > 0) == method.varies_order());
      if (!method.varies_order()) BOOST_TEST(c.order_reductions == 0);
    }
  }
  BOOST_TEST(!of_variable_order().empty());
}

BOOST_DATA_TEST_CASE(the_sum_of_the_orders_lies_between_those_of_all_low_and_all_high,
                     of_variable_order(), method) {
  for (const double rtol : {1e-3, 1e-6, 1e-9}) {
    BOOST_TEST_CONTEXT(method.name << " at " << rtol) {
      const Counts c = counts_of(method, {.rtol = rtol});
      BOOST_TEST(are_sound(c, method.order), c);
      BOOST_TEST(c.order_sum > c.steps);  // some steps are of higher order
    }
  }
}

BOOST_DATA_TEST_CASE(no_step_is_of_a_higher_order_than_allowed, of_variable_order(), method) {
  std::int64_t last_steps = std::numeric_limits<std::int64_t>::max();
  for (const int most : {1, 2, 3, 5}) {
    BOOST_TEST_CONTEXT(method.name << " up to order " << most) {
      const Counts c = counts_of(method, {.rtol = 1e-5, .max_order = most});
      BOOST_TEST(are_sound(c, most), c);
      if (most == 1) {
        BOOST_TEST(c.order_sum == c.steps);
      } else {
        // All but the first few of a hundred steps and more are of higher order than 1.
        BOOST_TEST(c.order_sum > 3 * c.steps / 2);
      }
      BOOST_TEST(c.steps < last_steps);  // the higher, the fewer
      last_steps = c.steps;
    }
  }
  // More than there is means what there is, as does 0.
  const Counts all = counts_of(method, {.rtol = 1e-5});
  BOOST_TEST(counts_of(method, {.rtol = 1e-5, .max_order = 100}) == all);
  BOOST_TEST(!are_sound(all, 1));
}

BOOST_AUTO_TEST_CASE(bdf_lowers_its_order_where_its_stability_limit_is_detected) {
  // A linear chain that starts as its slowest mode: the other modes' h w lie where BDF of order 3
  // to 5 is unstable.
  constexpr int masses = 30;
  const auto system = make_mass_spring(linear_chain(masses, 1e-3, 1e3));
  State start{0, Vec::LinSpaced(masses, 1, masses), Vec::Zero(masses)};
  for (int i = 0; i < masses; ++i) start.q[i] += std::sin((i + 1) * M_PI / (masses + 1));
  for (const char* name : {"cvode_bdf", "cvode_bdf_klu"}) {
    const auto mean_order = [&](bool detection) {
      const Run r = run(method_named(name), *system, start, 1,
                        {.rtol = 1e-4, .stability_detection = detection});
      BOOST_TEST(r.summary.message == "");
      const Counts& c = r.summary.counts;
      return static_cast<double>(c.order_sum) / static_cast<double>(c.steps);
    };
    BOOST_TEST(mean_order(true) < mean_order(false));
  }
}

BOOST_AUTO_TEST_SUITE_END()
