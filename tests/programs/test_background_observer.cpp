#include <stdexcept>

#include <boost/test/unit_test.hpp>

#include "experiments/simulate/background_observer.hpp"

BOOST_AUTO_TEST_SUITE(background_observer)

using namespace qddot;
using namespace qddot::simulate;

namespace {

// The i-th of a run, of n unknowns.
State state(int i, Index n) { return {i * 0.1, Vec::Constant(n, i), Vec::Constant(n, -i)}; }

}  // namespace

BOOST_AUTO_TEST_CASE(every_state_is_looked_at_once_and_in_order) {
  for (const Index n : {1, 1000, 100'000}) {  // many at once, a few, each by itself
    std::vector<State> seen;
    BackgroundObserver aside([&](const State& at) { seen.push_back(at); });
    constexpr int states = 50;
    for (int i = 0; i < states; ++i) aside.see(state(i, n));
    aside.finish();
    BOOST_TEST_REQUIRE(seen.size() == static_cast<std::size_t>(states));
    for (int i = 0; i < states; ++i) {
      BOOST_TEST(seen[i].t == i * 0.1);
      BOOST_TEST((seen[i].q == Vec::Constant(n, i) && seen[i].v == Vec::Constant(n, -i)));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_run_may_go_on_after_finish) {
  int seen = 0;
  BackgroundObserver aside([&](const State&) { ++seen; });
  aside.finish();
  aside.see(state(1, 3));
  aside.finish();
  aside.finish();
  BOOST_TEST(seen == 1);
}

BOOST_AUTO_TEST_CASE(what_looking_throws_arrives_and_ends_it) {
  int seen = 0;
  BackgroundObserver aside([&](const State& at) {
    ++seen;
    if (at.q[0] == 2) throw std::runtime_error("the disk is full");
  });
  const auto see_all = [&] {
    for (int i = 0; i < 10; ++i) aside.see(state(i, 100'000));
    aside.finish();
  };
  BOOST_CHECK_THROW(see_all(), std::runtime_error);
  BOOST_CHECK_THROW(aside.finish(), std::runtime_error);
  BOOST_TEST(seen == 3);
}

BOOST_AUTO_TEST_CASE(it_may_end_with_states_that_nobody_looked_at) {
  int seen = 0;
  {
    BackgroundObserver aside([&](const State&) { ++seen; });
    aside.see(state(0, 1));
  }
  BOOST_TEST(seen == 0);
}

BOOST_AUTO_TEST_SUITE_END()
