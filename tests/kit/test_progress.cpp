#include <vector>

#include <boost/test/unit_test.hpp>

#include "experiments/kit/progress.hpp"

BOOST_AUTO_TEST_SUITE(progress)

using namespace qddot;

namespace {

// A Progress on a screen that keeps what is written, by a clock that a test moves.
struct Shown {
  double now = 100;  // [s]
  std::size_t columns = 80;
  std::vector<std::string> written;
  Progress progress{{.now = [this] { return now; },
                     .columns = [this] { return columns; },
                     .write = [this](std::string_view text) { written.emplace_back(text); }}};

  explicit Shown(Progress::Form form, std::size_t pieces = 0, double quiet = 0) {
    progress.start("bench", form, quiet);
    if (pieces > 0) progress.begin(pieces);
  }
  std::string last() const { return written.empty() ? "" : written.back(); }
};

std::string line(const std::string& words) { return "\r" + words + "\033[K"; }
const std::string wiped = "\r\033[K";

const ProgressState state{.program = "work_precision",
                          .number = 12,
                          .pieces = 56,
                          .what = "verlet h = 0.0005",
                          .elapsed = 63.9,
                          .left = 129.1};

}  // namespace

BOOST_AUTO_TEST_CASE(times_are_rounded_down_to_seconds) {
  BOOST_TEST(clock_words(0) == "0:00");
  BOOST_TEST(clock_words(63.9) == "1:03");
  BOOST_TEST(clock_words(3600) == "1:00:00");
  BOOST_TEST(clock_words(3599.5) == "59:59");
  BOOST_TEST(clock_words(-1) == "0:00");
  BOOST_TEST(clock_words(1e300) == clock_words(1e9));
}

BOOST_AUTO_TEST_CASE(a_state_is_one_line) {
  BOOST_TEST(progress_in_words(state, 80) ==
             "work_precision 12/56  verlet h = 0.0005  1:03, about 2:09 left");
  ProgressState other = state;
  other.left.reset();
  BOOST_TEST(progress_in_words(other, 80) == "work_precision 12/56  verlet h = 0.0005  1:03");
  other = {.program = "simulate", .what = "t = 1 of 2 s", .left = 10.9};
  BOOST_TEST(progress_in_words(other, 80) == "simulate  t = 1 of 2 s  0:00, about 0:10 left");
}

BOOST_AUTO_TEST_CASE(few_columns_leave_the_times) {
  BOOST_TEST(progress_in_words(state, 60) ==
             "work_precision 12/56  verlet h = 0.00  1:03, about 2:09 left");
  BOOST_TEST(progress_in_words(state, 39) == "12/56  verlet h   1:03, about 2:09 left");
  BOOST_TEST(progress_in_words(state, 20) == "12/56  1:03, about 2");
  for (std::size_t columns = 0; columns < 90; ++columns)
    BOOST_TEST(progress_in_words(state, columns).size() <= columns);
}

BOOST_AUTO_TEST_CASE(text_is_cut_by_what_it_takes_on_a_terminal) {
  BOOST_TEST(in_columns("n\u00e9e", 2) == "n\u00e9");
  BOOST_TEST(in_columns("e\u0301x", 1) == "e\u0301");            // an accent of its own takes none
  BOOST_TEST(in_columns("\u5e03\u5e03", 3) == "\u5e03");         // these take two columns each
  BOOST_TEST(in_columns("a\033[2Jb\nc\x7f", 9) == "a?[2Jb?c?");  // nothing that moves the cursor
  BOOST_TEST(in_columns("\u009b2J", 9) == "?2J");
  BOOST_TEST(in_columns("a\xff\xc3", 9) == "a??");  // no UTF-8
  BOOST_TEST(in_columns(std::string("a\0b", 3), 9) == "a?b");
}

BOOST_AUTO_TEST_CASE(a_terminal_s_line_says_what_is_measured) {
  Shown shown(Progress::Form::line);
  shown.progress.stage("making the reference");
  BOOST_TEST(shown.last() == line("bench  making the reference  0:00"));
  shown.progress.begin(3);
  shown.now += 5;
  shown.progress.now_at("verlet");
  BOOST_TEST(shown.last() == line("bench 1/3  verlet  0:05"));
  shown.now += 5;
  shown.progress.finish("verlet is done");
  BOOST_TEST(shown.last() == line("bench 1/3  verlet is done  0:10, about 0:20 left"));
  shown.now += 1;
  shown.progress.now_at("rk4");
  BOOST_TEST(shown.last() == line("bench 2/3  rk4  0:11, about 0:19 left"));
  shown.columns = 34;  // three are left free
  shown.now += 1;
  shown.progress.now_at("rk4 again");
  BOOST_TEST(shown.last() == line("2/3  rk4  0:12, about 0:18 left"));
}

BOOST_AUTO_TEST_CASE(it_is_written_at_most_ten_times_a_second) {
  Shown shown(Progress::Form::line, 10000);
  for (int i = 0; i < 3000; ++i) {  // 3 s
    shown.now += 1e-3;
    shown.progress.now_at("verlet");
  }
  BOOST_TEST(shown.written.size() <= 30u);
  BOOST_TEST(shown.written.size() >= 28u);  // and as often: sums of milliseconds are rounded
}

BOOST_AUTO_TEST_CASE(it_is_wiped_once_and_closed_for_good) {
  Shown shown(Progress::Form::line);
  shown.progress.wipe();
  BOOST_TEST(shown.written.empty());  // there is nothing to wipe
  shown.progress.stage("a");
  shown.progress.wipe();
  shown.progress.wipe();
  BOOST_TEST(shown.written.size() == 2u);
  BOOST_TEST(shown.last() == wiped);
  shown.now += 1;
  shown.progress.stage("b");
  shown.progress.close();
  BOOST_TEST(shown.last() == wiped);
  shown.now += 1;
  shown.progress.stage("c");
  BOOST_TEST(shown.last() == wiped);
}

BOOST_AUTO_TEST_CASE(plain_lines_say_what_is_done_and_are_half_a_minute_apart) {
  Shown shown(Progress::Form::plain);
  shown.progress.stage("making the reference");
  shown.progress.begin(100);
  for (int i = 0; i < 100; ++i) {
    shown.progress.now_at("verlet");
    shown.now += 1;
    shown.progress.finish("verlet is done");
  }
  const std::vector<std::string> expected = {
      "bench 1/100  verlet is done  0:01, about 1:39 left\n",
      "bench 31/100  verlet is done  0:31, about 1:09 left\n",
      "bench 61/100  verlet is done  1:01, about 0:39 left\n",
      "bench 91/100  verlet is done  1:31, about 0:09 left\n"};
  BOOST_TEST(shown.written == expected, boost::test_tools::per_element());
  shown.progress.wipe();
  BOOST_TEST(shown.written.size() == expected.size());
}

BOOST_AUTO_TEST_CASE(what_is_over_soon_is_quiet) {
  Shown shown(Progress::Form::plain, 40, 30);
  for (int i = 0; i < 40; ++i) {
    shown.now += 1;
    shown.progress.finish("verlet is done");
  }
  BOOST_TEST_REQUIRE(shown.written.size() == 1u);
  BOOST_TEST(shown.last() == "bench 30/40  verlet is done  0:30, about 0:10 left\n");
}

BOOST_AUTO_TEST_CASE(the_time_left_is_that_of_the_pieces_to_come_at_the_pace_of_those_measured) {
  Shown shown(Progress::Form::line, 8);
  shown.progress.now_at("a");
  BOOST_TEST(shown.last() == line("bench 1/8  a  0:00"));  // nobody knows yet
  shown.progress.finish("a");                              // kept from before
  shown.now += 10;
  shown.progress.finish("b");
  BOOST_TEST(shown.last() == line("bench 2/8  b  0:10, about 1:00 left"));
  shown.now += 4;
  shown.progress.now_at("c");
  BOOST_TEST(shown.last() == line("bench 3/8  c  0:14, about 0:56 left"));
  shown.now += 16;
  shown.progress.finish("c");
  BOOST_TEST(shown.last() == line("bench 3/8  c  0:30, about 1:15 left"));
  shown.now += 100;
  shown.progress.now_at("d");
  BOOST_TEST(shown.last() == line("bench 4/8  d  2:10"));
}

BOOST_AUTO_TEST_SUITE_END()
