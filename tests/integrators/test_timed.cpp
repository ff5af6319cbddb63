#include <chrono>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/parts.hpp"

BOOST_AUTO_TEST_SUITE(timed)

using namespace qddot;

namespace {

double sum(const Seconds& s) { return s.force + s.stiffness + s.factorization + s.solve; }

Options options_for(const Method& method, bool is_timed) {
  Options options = options_of(method, 0.01, 1e-5);
  options.timed = is_timed;
  return options;
}

}  // namespace

BOOST_DATA_TEST_CASE(times_are_taken_if_asked_for_and_change_nothing_else, general_methods(),
                     method) {
  const Run a = run(method, hammock(2), 0.5, options_for(method, false));
  const Run b = run(method, hammock(2), 0.5, options_for(method, true));
  BOOST_TEST(sum(a.summary.seconds) == 0);
  BOOST_TEST(sum(b.summary.seconds) > 0);
  BOOST_TEST(same(a.state, b.state));
  BOOST_TEST(a.summary.counts == b.summary.counts);
}

BOOST_DATA_TEST_CASE(times_are_those_of_what_is_counted_and_add_up_to_less_than_the_run,
                     general_methods(), method) {
  const Part one = part(hammock(2));
  for (const int count : {1, 2}) {
    const Together parts(std::vector(static_cast<std::size_t>(count), one));
    BOOST_TEST_CONTEXT(count << " parts") {
      const auto integrator = make_integrator(method, *parts.system, options_for(method, true));
      for (int repeat = 0; repeat < 2; ++repeat) {  // of the second, too, only its own
        State state = parts.start;
        const auto start = std::chrono::steady_clock::now();
        const Summary summary = integrator->advance(state, start_time + 0.5);
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        const Seconds& s = summary.seconds;
        BOOST_TEST(summary.message == "");
        BOOST_TEST(sum(s) <= time.count());
        BOOST_TEST(s.force > 0);
        BOOST_TEST((s.stiffness > 0) == (summary.counts.stiffness_evaluations > 0));
        // Other methods' solves are their own.
        const bool counts_solves = method.listens_to(Option::iterations);
        if (method.family != Family::sundials && !counts_solves) continue;
        BOOST_TEST((s.factorization > 0) == (summary.counts.factorizations > 0));
        BOOST_TEST((s.solve > 0) == (summary.counts.solves > 0));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
