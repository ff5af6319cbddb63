#include <boost/test/unit_test.hpp>

#include "qddot/integrators/nearest_name.hpp"
#include "qddot/integrators/registry.hpp"

BOOST_AUTO_TEST_SUITE(nearest_name)

using namespace qddot;

BOOST_AUTO_TEST_CASE(letters_apart_are_those_of_the_shortest_edit) {
  BOOST_TEST(letters_apart("", "") == 0);
  BOOST_TEST(letters_apart("", "abc") == 3);
  BOOST_TEST(letters_apart("kitten", "sitting") == 3);
  BOOST_TEST(letters_apart("sitting", "kitten") == 3);
  BOOST_TEST(letters_apart("verlet", "vrlet") == 1);
  BOOST_TEST(letters_apart("flaw", "lawn") == 2);
}

BOOST_AUTO_TEST_CASE(one_wrong_letter_names_the_method) {
  std::vector<std::string> names;
  for (const Method& method : methods()) names.push_back(method.name);
  for (const std::string& name : names) {
    if (name.size() < 5) continue;  // short names are near each other
    BOOST_TEST(qddot::nearest_name(name, names) == name);
    BOOST_TEST(letters_apart(qddot::nearest_name("x" + name, names), name) == 0);
  }
  BOOST_TEST(qddot::nearest_name("leapfrog", names) == "");
  BOOST_TEST(qddot::nearest_name("", names) == "");
  BOOST_TEST(qddot::nearest_name("lu", {"klu"}) == "");
  BOOST_TEST(qddot::nearest_name(std::string(100'000, 'v'), names) == "");
  BOOST_TEST(qddot::nearest_name("verlet", {}) == "");
}

BOOST_AUTO_TEST_SUITE_END()
