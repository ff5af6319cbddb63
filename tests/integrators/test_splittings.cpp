#include <algorithm>
#include <numeric>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/kick_drift.hpp"
#include "tests/integrators/growth.hpp"
#include "tests/integrators/tables.hpp"

BOOST_AUTO_TEST_SUITE(splittings)

using namespace qddot;

namespace {

const std::vector<WithTable<Splitting>>& all() {
  static const auto list = methods_with_tables(&Method::splitting);
  return list;
}

// A splitting as a Nystrom method. Each kick y_i is a stage at the time c_i of the drifts before
// it: a_ij = y_j (c_i - c_j), b_i = y_i (1 - c_i) and b'_i = y_i.
NystromPair as_nystrom(const Splitting& splitting) {
  const auto& [order, kicks, drifts] = splitting;
  const std::size_t drifts_before = drifts.size() > kicks.size() ? 1 : 0;
  NystromPair method{.order = order, .lower_order = 0, .b_prime = kicks};
  for (std::size_t i = 0; i < kicks.size(); ++i) {
    const auto end = drifts.begin() + static_cast<std::ptrdiff_t>(i + drifts_before);
    const double c = std::accumulate(drifts.begin(), end, 0.0);
    std::vector<double> row;
    for (std::size_t j = 0; j < i; ++j) row.push_back(kicks[j] * (c - method.c[j]));
    method.c.push_back(c);
    method.a.push_back(row);
    method.b.push_back(kicks[i] * (1 - c));
  }
  return method;
}

// Each of up to 18 products and sums of up to 8 levels rounds by 1.1e-16 of what is added up.
constexpr double rounding = 2e-15;

}  // namespace

BOOST_AUTO_TEST_CASE(each_splitting_meets_all_conditions_of_its_order_and_not_those_of_the_next) {
  for (const auto& [name, splitting] : all()) {
    BOOST_TEST(method_named(name).order == splitting.order);
    const NystromPair method = as_nystrom(splitting);
    const NystromTrees trees(method, splitting.order + 1);
    for (int p = 1; p <= splitting.order + 1; ++p) {
      const double defect = order_defect(trees.all(), method.b, method.b_prime, p);
      BOOST_TEST_CONTEXT(name << " at order " << p << ": " << defect) {
        BOOST_TEST((defect < rounding) == (p <= splitting.order));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(exactly_the_reversible_splittings_are_the_same_read_backwards) {
  const auto is_palindrome = [](const std::vector<double>& list) {
    return std::equal(list.begin(), list.end(), list.rbegin());
  };
  for (const auto& [name, splitting] : all()) {
    const bool is_same = is_palindrome(splitting.kicks) && is_palindrome(splitting.drifts) &&
                         splitting.kicks.size() != splitting.drifts.size();
    BOOST_TEST(method_named(name).is(Trait::reversible) == is_same, name);
    BOOST_TEST(method_named(name).is(Trait::symplectic), name);
  }
  BOOST_TEST(mirrored({1, 2, 3}, 5) == (std::vector<double>{1, 2, 3, 2, 1}),
             boost::test_tools::per_element());
  BOOST_TEST(mirrored({1, 2, 3}, 6) == (std::vector<double>{1, 2, 3, 3, 2, 1}),
             boost::test_tools::per_element());
}

BOOST_DATA_TEST_CASE(explicit_steps_let_vibrations_grow_above_their_stability_limit_only,
                     methods_of(Knob::step_size), method) {
  if (method.is(Trait::implicit) || method.family == Family::sundials) return;
  BOOST_REQUIRE_MESSAGE(method.stability_limit.has_value(),
                        "stability_limit of " << method << " is missing: stability_map --methods "
                                              << method << " measures it");
  const double limit = *method.stability_limit;
  if (limit == 0) return;  // it grows at every h
  double below = 0, above = 0;
  for (int i = 1; i <= 2000; ++i) {
    below = std::max(below, growth_a_step(method, limit * i / 2000));
    above = std::max(above, growth_a_step(method, limit * (1 + i / 2e5)));
  }
  // Rounding of the matrix by 1e-15 moves an eigenvalue by its root where two of them meet.
  BOOST_TEST(below < 1 + 1e-7);
  BOOST_TEST(above > 1 + 1e-4);
}

BOOST_AUTO_TEST_SUITE_END()
