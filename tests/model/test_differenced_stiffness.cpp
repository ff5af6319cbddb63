// K by differences of f, held against the K that springs have.
#include <boost/test/unit_test.hpp>

#include "qddot/model/differenced_stiffness.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(differenced_stiffness)

using namespace qddot;

namespace {

// The pairs of unknowns that K has entries for.
std::vector<std::pair<Index, Index>> pairs_of(const SymmetricMatrix& k) {
  std::vector<std::pair<Index, Index>> pairs;
  for (Index j = 0; j < k.outerSize(); ++j) {
    for (SymmetricMatrix::InnerIterator at(k, j); at; ++at) pairs.emplace_back(at.row(), j);
  }
  return pairs;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_the_stiffness_of_springs) {
  for (const int dimension : {1, 2, 3}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      std::mt19937 random(seed);
      const Problem p = random_network(random, dimension, 12, 1.1);
      const std::shared_ptr<const System> springs = make_mass_spring(p.network);
      const DifferencedStiffness system(springs, pairs_of(springs->stiffness_pattern()));
      const Vec& q = p.initial.q;
      SymmetricMatrix exact = springs->stiffness_pattern(), found = system.stiffness_pattern();
      BOOST_TEST(exact.nonZeros() == found.nonZeros());
      springs->stiffness(q, exact);
      system.stiffness(q, found);
      const double largest = Eigen::MatrixXd(exact).lpNorm<Eigen::Infinity>();
      const Eigen::MatrixXd difference = Eigen::MatrixXd(exact) - Eigen::MatrixXd(found);
      // d^2 of the third derivative and 2^-52/d of the force: some 1e-10 each.
      BOOST_TEST(difference.lpNorm<Eigen::Infinity>() < 1e-8 * largest);
    }
  }
}

BOOST_AUTO_TEST_CASE(it_is_constant_where_that_of_the_system_is) {
  std::mt19937 random(1);
  Problem p = random_network(random, 2, 5, 1.1);
  for (const bool is_linear : {false, true}) {
    if (is_linear) p.network = without_rest_lengths(p.network);
    const std::shared_ptr<const System> springs = make_mass_spring(p.network);
    const DifferencedStiffness system(springs, pairs_of(springs->stiffness_pattern()));
    BOOST_TEST(system.stiffness_is_constant() == is_linear);
  }
}

BOOST_AUTO_TEST_CASE(columns_without_a_common_row_share_a_force) {
  // A chain of n unknowns in which neighbours pull each other: three colours, however long.
  class Chain final : public System {
   public:
    explicit Chain(Index n) : System(Vec::Ones(n)) {}
    double potential(const At& at) const override {
      return 0.5 * (at.q.tail(size() - 1) - at.q.head(size() - 1)).squaredNorm();
    }
    void force(const At& at, MutableVec f) const override {
      const Vec pull = at.q.tail(size() - 1) - at.q.head(size() - 1);
      f.setZero();
      f.head(size() - 1) += pull;
      f.tail(size() - 1) -= pull;
    }
  };
  std::vector<std::pair<Index, Index>> pairs;
  for (Index i = 0; i + 1 < 50; ++i) pairs.emplace_back(i, i + 1);
  const DifferencedStiffness system(std::make_shared<const Chain>(50), pairs);
  BOOST_TEST(system.forces_per_stiffness() == 6);
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(Vec(Vec::Random(50)), k);
  for (Index i = 1; i + 1 < 50; ++i) {
    BOOST_TEST(std::abs(k.coeff(i, i) + 2) < 1e-8);
    BOOST_TEST(std::abs(k.coeff(i, i - 1) - 1) < 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(pairs_and_lengths_that_cannot_be_are_refused) {
  const std::shared_ptr<const System> springs = make_mass_spring(hammock(2).network);
  BOOST_CHECK_THROW(DifferencedStiffness(springs, {{0, springs->size()}}), std::invalid_argument);
  BOOST_CHECK_THROW(DifferencedStiffness(springs, {{-1, 0}}), std::invalid_argument);
  BOOST_CHECK_THROW(DifferencedStiffness(springs, {}, 0), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
