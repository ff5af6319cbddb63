// Errors of methods that choose their steps, as multiples of the tolerance.
#include <boost/test/unit_test.hpp>

#include "tests/integrators/motions.hpp"

BOOST_AUTO_TEST_SUITE(accuracy)

using namespace qddot;

namespace {

std::vector<Method> adaptive() {
  return methods_where([](const Method& method) { return method.knob == Knob::rtol; });
}

// The tolerance is for the estimated error of each step in the root mean square over q and v. These
// motions last two to three periods. The largest error of any entry is 0.1 to 25 tolerances with
// ARKODE (60 with order 3 at 1e-7, which takes the most steps). It comes to 330 where the implicit
// table of a pair works alone, at order 5. It is up to 1100 with multistep methods, whose order
// rises and falls. A Newton iteration that stops too early gives 1e4 and more.
double largest_factor(const Method& method) {
  return method.varies_order() ? 2000 : method.asks(Need::split_forces) ? 500 : 100;
}

// The largest error at rtol = 1e-3, 1e-5, 1e-7, 1e-9 as a multiple of rtol. Infinite if a finer
// tolerance does not lower the error, unless the stability limit already forced the steps of the
// coarser one.
double worst_factor(const Method& method, const KnownMotion& motion) {
  double worst = 0, last = INFINITY;
  for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9}) {
    const Run r = run(method, *motion.system, motion.start, motion.end.t, {.rtol = rtol});
    BOOST_REQUIRE(r.summary.message == "");
    const double error = distance(r.state, motion.end);
    worst = error < last ? std::max(worst, error / rtol) : INFINITY;
    const Counts& c = r.summary.counts;
    last = 2 * c.stability_limited_steps > c.steps ? INFINITY : error;
  }
  return worst;
}

}  // namespace

BOOST_DATA_TEST_CASE(motions_are_as_exact_as_the_tolerance_asks, adaptive(), method) {
  for (const KnownMotion* motion : motions_of(method)) {
    BOOST_TEST(worst_factor(method, *motion) < largest_factor(method), motion->name);
  }
}

BOOST_AUTO_TEST_SUITE_END()
