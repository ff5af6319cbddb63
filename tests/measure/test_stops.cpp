// Deadlines, and interruptions of a thread of its own.
#include <latch>
#include <limits>
#include <thread>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/interruption.hpp"

BOOST_AUTO_TEST_SUITE(stops)

using namespace qddot;

BOOST_AUTO_TEST_CASE(a_deadline_asks_for_a_stop_when_its_time_has_come) {
  for (const double seconds : {0.01, 0.}) {
    const Deadline deadline(seconds);
    std::latch passed(1);
    const std::stop_callback wake(deadline.token(), [&] { passed.count_down(); });
    passed.wait();  // as long as it takes
    BOOST_TEST((deadline.passed() && deadline.token().stop_requested()));
  }
}

BOOST_AUTO_TEST_CASE(destroyed_early_it_neither_waits_nor_asks) {
  std::stop_token token;
  for (int i = 0; i < 100; ++i) {
    const Deadline deadline(1e300);
    token = deadline.token();
    BOOST_TEST(!deadline.passed());
  }
  BOOST_TEST(!token.stop_requested());
}

BOOST_AUTO_TEST_CASE(an_infinite_time_does_not_pass) {
  const Deadline deadline(std::numeric_limits<double>::infinity());
  BOOST_TEST(!deadline.passed());
}

BOOST_AUTO_TEST_CASE(one_alarm_serves_deadlines_by_turns_earlier_ones_too) {
  Alarm alarm;
  for (const double seconds : {0.01, 1e300, 0.005, 0., 1e300, 0.01}) {
    const Deadline deadline(seconds, alarm);
    if (seconds > 1) continue;
    std::latch passed(1);
    const std::stop_callback wake(deadline.token(), [&] { passed.count_down(); });
    passed.wait();
    BOOST_TEST(deadline.passed());
  }
}

BOOST_AUTO_TEST_CASE(an_alarm_asks_nobody_whose_deadline_is_no_more) {
  Alarm alarm;
  std::stop_token early;
  {
    const Deadline deadline(0.005, alarm);
    early = deadline.token();
  }
  const Deadline deadline(0.02);
  std::latch passed(1);
  const std::stop_callback wake(deadline.token(), [&] { passed.count_down(); });
  passed.wait();
  BOOST_TEST(!early.stop_requested());
}

BOOST_AUTO_TEST_CASE(an_interruption_ends_the_work_of_its_own_thread_alone) {
  std::stop_source source;
  std::latch is_interrupted(1), is_looked_at(1);
  std::thread other([&] {
    const OwnInterruption own(source.get_token(), {"somebody", 7});
    BOOST_TEST(!interrupted());
    const Deadline deadline(1e300);
    source.request_stop();
    is_interrupted.count_down();
    is_looked_at.wait();
    BOOST_REQUIRE(interrupted());
    BOOST_TEST(interrupted()->by == "somebody");
    BOOST_TEST(interruption().stop_requested());
    BOOST_TEST(deadline.passed());
    BOOST_CHECK_EXCEPTION(stop_if_interrupted(), Interrupted,
                          [](const Interrupted& e) { return e.status == 7; });
  });
  is_interrupted.wait();
  BOOST_TEST(!interrupted());
  BOOST_TEST(!interruption().stop_requested());
  stop_if_interrupted();
  is_looked_at.count_down();
  other.join();
}

BOOST_AUTO_TEST_CASE(an_inner_one_stands_before_an_outer_one_as_long_as_it_lives) {
  std::stop_source outer, inner;
  const OwnInterruption one(outer.get_token(), {"outer", 1});
  outer.request_stop();
  {
    const OwnInterruption other(inner.get_token(), {"inner", 2});
    BOOST_TEST(!interrupted());
    inner.request_stop();
    BOOST_TEST(interrupted()->by == "inner");
  }
  BOOST_TEST(interrupted()->by == "outer");
}

BOOST_AUTO_TEST_SUITE_END()
