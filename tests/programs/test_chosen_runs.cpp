#include <algorithm>

#include <boost/test/unit_test.hpp>

#include "experiments/motions/chosen_runs.hpp"
#include "qddot/integrators/registry.hpp"

BOOST_AUTO_TEST_SUITE(chosen_runs)

using namespace qddot;
using namespace qddot::motions;

namespace {

Point point(const char* method, double value, double error, double time,
            Outcome outcome = Outcome::reached_end) {
  return {.method = find_method(method),
          .value = value,
          .outcome = outcome,
          .errors = {.position = error},
          .time = time};
}

// Verlet is the fastest to 1e-3, rk4 from there; IDA is slower everywhere.
const std::vector<Point> points = {
    point("verlet", 1, 0, 0, Outcome::diverged),
    point("verlet", 0.5, 0, 0, Outcome::diverged),
    point("verlet", 0.1, 5e-3, 1),
    point("verlet", 0.05, 1.2e-3, 2),
    point("verlet", 0.025, 3e-4, 4),
    point("rk4", 0.2, 2e-2, 3),
    point("rk4", 0.1, 1e-5, 6),
    point("rk4", 0.01, 0, 0, Outcome::over_budget),
    point("ida", 1e-3, 2e-3, 10),
    point("ida", 1e-6, 2e-6, 30),
};

std::vector<ChosenRun> chosen() {
  Reference reference;
  reference.certified.position = 1e-12;
  return motions::chosen_runs(points, fastest_at_each_accuracy(points, reference));
}

std::string why(std::size_t point) {
  const auto runs = chosen();
  const auto found = std::ranges::find(runs, &points[point], &ChosenRun::point);
  return found == runs.end() ? "not chosen" : found->why;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_run_is_chosen_once_and_says_what_it_shows) {
  BOOST_TEST(why(2) == "fastest from 1e-1 to 1e-2, coarsest run");
  BOOST_TEST(why(4) == "fastest at 1e-3");
  BOOST_TEST(why(6) == "fastest at 1e-4");
  BOOST_TEST(why(8) == "fastest of SUNDIALS from 1e-1 to 1e-2, coarsest run");
  // It is the fastest of all at 1e-5 too, which no other method reaches.
  BOOST_TEST(why(9) == "fastest at 1e-5, fastest of SUNDIALS from 1e-3 to 1e-5");
  BOOST_TEST(why(5) == "coarsest run");
  BOOST_TEST(why(0) == "diverged");
  BOOST_TEST(why(1) == "");
  BOOST_TEST(why(3) == "");
}

BOOST_AUTO_TEST_CASE(a_run_that_took_too_long_is_not_chosen) {
  BOOST_TEST(why(7) == "not chosen");
  BOOST_TEST(chosen().size() == points.size() - 1);
}

BOOST_AUTO_TEST_CASE(the_most_telling_come_first) {
  const auto runs = chosen();
  const std::vector<std::size_t> order = {2, 4, 6, 9, 8, 0, 5, 1, 3};
  BOOST_TEST_REQUIRE(runs.size() == order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    BOOST_TEST((runs[i].point == &points[order[i]]), "place " << i);
  }
}

BOOST_AUTO_TEST_CASE(without_points_nothing_is_chosen) {
  Reference reference;
  BOOST_TEST(motions::chosen_runs({}, fastest_at_each_accuracy({}, reference)).empty());
}

BOOST_AUTO_TEST_SUITE_END()
