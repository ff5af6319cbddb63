// The table of options, from which checks, command lines and Python are made.
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/option_table.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(option_table)

using namespace qddot;

BOOST_AUTO_TEST_CASE(each_option_has_one_row_and_some_method_takes_it) {
  std::set<std::string> names;
  std::set<Option> options;
  for (const OptionRow& row : option_rows()) {
    BOOST_TEST(names.insert(row.name).second, row.name);
    BOOST_TEST(&option_row(row.name) == &row);
    BOOST_TEST(*row.words != 0, row.name);
    if (is_of_takes(row)) BOOST_TEST(options.insert(std::get<Option>(row.takers)).second, row.name);
    const auto takes_it = [&](const Method& method) { return takes(method, row); };
    BOOST_TEST(std::ranges::any_of(methods(), takes_it), row.name);
  }
  for (const Method& method : methods()) {
    for (int i = 0; i < 31; ++i) {
      const Option option = static_cast<Option>(i);
      BOOST_TEST((!method.listens_to(option) || options.count(option) == 1), method.name << i);
    }
  }
  BOOST_TEST(option_row("solve_tolerance").program_name() == "--solve-tolerance");
  BOOST_CHECK_THROW(option_row("solve-tolerance"), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(each_number_is_refused_in_the_words_of_its_row) {
  for (const Method* method : {&method_named("verlet"), &method_named("ida")}) {
    for (const OptionRow& row : option_rows()) {
      for (const double wrong : {-1.0, double(INFINITY)}) {
        Options options{.step_size = 0.1, .rtol = 1e-3};
        BOOST_CHECK_NO_THROW(check_options(*method, options));
        if (const auto* number = std::get_if<double Options::*>(&row.member)) {
          options.** number = wrong;
        } else if (const auto* whole = std::get_if<int Options::*>(&row.member);
                   whole && wrong < 0) {
          options.** whole = -1;
        } else {
          continue;
        }
        std::string said;
        try {
          check_options(*method, options);
        } catch (const std::invalid_argument& error) {
          said = error.what();
        }
        const bool is_ignored = std::holds_alternative<Knob>(row.takers) && !takes(*method, row);
        const std::string sentence = method->name + ": " + row.name + " = " +
                                     (wrong < 0 ? "-1" : "inf") + " is not allowed; it is " +
                                     row.allowed;
        BOOST_TEST(said == (is_ignored ? "" : sentence));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
