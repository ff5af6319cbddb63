#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(twins)

using namespace qddot;

namespace {

// The methods that solve with stock KLU; each is the stock way of one with n x n solves.
std::vector<Method> stock() {
  std::vector<Method> list = methods();
  std::erase_if(list, [](const Method& method) { return method.stock_of.empty(); });
  BOOST_REQUIRE(!list.empty());
  return list;
}

// Solves that round differently, by some 1e-15, change error estimates of 1e-3 or less by 1e-12 in
// a hundred stages. Estimates change the lengths of steps: the end changes by up to 6e-12. ARKODE's
// rates are also differences of solutions over a part of a step. They change the end by 1.1e-9 in
// its methods of high order at coarse tolerances.
constexpr double by_rounding = 1e-10, by_coarse_rates = 1e-8;

}  // namespace

BOOST_AUTO_TEST_CASE(n_x_n_solves_and_klu_take_the_same_steps) {
  for (const int dimension : {2, 3}) {
    const Problem p = hammock(dimension);
    for (const Method& twin : stock()) {
      for (const double rtol : {1e-3, 1e-6}) {
        BOOST_TEST_CONTEXT(twin.name << " in dimension " << dimension << ", rtol " << rtol) {
          const Run n_x_n = run(method_named(twin.stock_of), p, 1, {.rtol = rtol});
          Run klu = run(twin, p, 1, {.rtol = rtol});
          BOOST_TEST(n_x_n.summary.message == "");
          BOOST_TEST(n_x_n.summary.counts.steps > 5);
          klu.summary.counts.indefinite_factorizations =
              n_x_n.summary.counts.indefinite_factorizations;  // which LU does not see
          BOOST_TEST(n_x_n.summary.counts == klu.summary.counts);
          const bool has_coarse_rates = twin.name.starts_with("arkode") && rtol > 1e-6;
          BOOST_TEST(distance(n_x_n.state, klu.state) <
                     (has_coarse_rates ? by_coarse_rates : by_rounding));
        }
      }
    }
  }
}

BOOST_DATA_TEST_CASE(another_tolerance_is_noticed, stock(), twin) {
  const Problem p = hammock(2);
  const Run a = run(method_named(twin.stock_of), p, 1, {.rtol = 1e-6});
  const Run b = run(twin, p, 1, {.rtol = 1.01e-6});
  BOOST_TEST(distance(a.state, b.state) > by_coarse_rates);
}

BOOST_AUTO_TEST_SUITE_END()
