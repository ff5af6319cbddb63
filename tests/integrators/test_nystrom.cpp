#include <boost/test/unit_test.hpp>

#include "tests/integrators/nystrom_trees.hpp"
#include "tests/integrators/tables.hpp"

BOOST_AUTO_TEST_SUITE(nystrom)

using namespace qddot;

namespace {

const std::vector<WithTable<NystromPair>>& pairs() {
  static const auto list = methods_with_tables<Nystrom>();
  return list;
}

// Each of up to 17 products and sums of up to 12 levels rounds by 1.1e-16 of what is added up, and
// so do coefficients of 16 digits.
constexpr double rounding = 2e-15;

}  // namespace

BOOST_AUTO_TEST_CASE(there_are_as_many_terms_of_each_order_as_there_should_be) {
  std::vector<int> count(13, 0);
  const NystromTrees trees(pairs().front().table, 12);
  for (const NystromTree& tree : trees.all()) {
    ++count[static_cast<std::size_t>(tree.order)];
  }
  // Hairer, Norsett and Wanner, table II.14.2, and its recursion.
  const std::vector<int> expected = {0, 1, 1, 2, 3, 6, 10, 20, 36, 72, 137, 275, 541};
  BOOST_TEST(count == expected, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(each_pair_meets_all_conditions_of_its_orders_and_not_those_of_the_next) {
  for (const auto& [name, pair] : pairs()) {
    const NystromTrees trees(pair, pair.order + 1);
    for (int p = 1; p <= pair.order + 1; ++p) {
      const double higher = order_defect(trees.all(), pair.b, pair.b_prime, p);
      const double lower = order_defect(trees.all(), pair.lower_b, pair.lower_b_prime, p);
      BOOST_TEST_CONTEXT(name << " at order " << p << ": " << higher << ", " << lower) {
        BOOST_TEST((higher < rounding) == (p <= pair.order));
        BOOST_TEST((lower < rounding) == (p <= pair.lower_order));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
