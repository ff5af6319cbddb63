#include <functional>
#include <random>

#include <boost/test/unit_test.hpp>

#include "integrators/sundials/support.hpp"
#include "tests/measure.hpp"

BOOST_AUTO_TEST_SUITE(vector)

using namespace qddot;

namespace {

using namespace qddot::sundials;

// Lengths 2n below, at and above the 256 entries that sums are made in, odd multiples of what a
// processor adds at once among them.
constexpr Index halves[] = {1, 2, 3, 5, 127, 128, 129, 300, 511};

// Vectors of one kind, filled with numbers of either sign and sizes from 1e-3 to 1e3.
struct Vectors {
  Vectors(Vector (*make)(Index, SUNContext), Index n, int count) {
    std::mt19937 random(static_cast<unsigned>(n));
    std::uniform_real_distribution<double> number(-1, 1), exponent(-3, 3);
    const Vector first = make(2 * n, context.get());
    for (int i = 0; i < count; ++i) {
      own.push_back(clone(first.get()));
      all.push_back(own.back().get());
      for (double& x : values(i)) x = number(random) * std::pow(10, exponent(random));
    }
  }
  Eigen::Map<Vec> values(int i) const {
    N_Vector x = all[static_cast<std::size_t>(i)];
    return {N_VGetArrayPointer(x), N_VGetLength(x)};
  }
  N_Vector operator[](int i) const { return all[static_cast<std::size_t>(i)]; }
  N_Vector* from(int i) { return all.data() + i; }

  Context context = make_context();
  std::vector<Vector> own;
  std::vector<N_Vector> all;
};

constexpr int count = 8;
using Operation = std::function<void(Vectors&)>;

// The largest difference of an operation on our vectors and on SUNDIALS' own, of length 2n. It is
// in roundings of the sum of the sizes of all terms.
double roundings(Index n, const Operation& ours, const Operation& theirs) {
  Vectors a(make_vector, n, count), b(make_stock_vector, n, count);
  Vec size = Vec::Zero(2 * n);
  for (int i = 0; i < count; ++i) size += b.values(i).cwiseAbs();
  ours(a);
  theirs(b);
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const Vec difference = (a.values(i) - b.values(i)).cwiseAbs();
    worst = std::max(worst, difference.cwiseQuotient(eps * size).maxCoeff());
    if (!difference.allFinite()) worst = INFINITY;
  }
  return worst;
}

// Factors below 2 of count terms, each rounded in a product and a sum, or in both at once.
constexpr double most_roundings = 2 * 2 * count;

void check_same(const Operation& operation) {
  for (const Index n : halves) {
    BOOST_TEST_CONTEXT("n = " << n) {
      BOOST_TEST(roundings(n, operation, operation) <= most_roundings);
    }
  }
}

double factors[count] = {1.5, -0.25, 1 / 3., 1, -1, 0, 1.9, 1e-3};

}  // namespace

BOOST_AUTO_TEST_CASE(our_vectors_have_our_operations_and_so_have_their_clones) {
  const Context context = make_context();
  const Vector ours = make_vector(8, context.get()), copy = clone(ours.get());
  const Vector stock = make_stock_vector(8, context.get());
  BOOST_TEST(N_VGetLength(ours.get()) == 8);
  BOOST_TEST(N_VGetLength(stock.get()) == 8);
  for (const Vector* zero : {&ours, &copy, &stock}) {
    BOOST_TEST(Eigen::Map<Vec>(N_VGetArrayPointer(zero->get()), 8).norm() == 0);
  }
  for (auto* op : {ours->ops, copy->ops}) {
    BOOST_TEST((op->nvlinearsum != stock->ops->nvlinearsum));
    BOOST_TEST((op->nvwrmsnorm != stock->ops->nvwrmsnorm));
    BOOST_TEST((op->nvlinearcombination == ours->ops->nvlinearcombination));
    BOOST_TEST((op->nvlinearcombination != nullptr));
    BOOST_TEST((op->nvscaleaddmulti != nullptr));
    BOOST_TEST((op->nvscalevectorarray != nullptr));
    BOOST_TEST((op->nvlinearsumvectorarray != nullptr));
  }
}

BOOST_AUTO_TEST_CASE(sums_of_two_are_those_of_sundials_also_in_place) {
  for (const double a : {1.0, -1.0, 0.7}) {
    for (const double b : {1.0, -1.0, -1.3}) {
      check_same([&](Vectors& x) { N_VLinearSum(a, x[0], b, x[1], x[2]); });
      check_same([&](Vectors& x) { N_VLinearSum(a, x[0], b, x[1], x[0]); });
      check_same([&](Vectors& x) { N_VLinearSum(a, x[0], b, x[1], x[1]); });
      check_same([&](Vectors& x) { N_VLinearSum(a, x[0], b, x[0], x[0]); });
    }
  }
}

BOOST_AUTO_TEST_CASE(multiples_and_constants_are_those_of_sundials_also_in_place) {
  for (const double a : {1.0, -1.0, 0.0, 0.7}) {
    check_same([&](Vectors& x) { N_VScale(a, x[0], x[1]); });
    check_same([&](Vectors& x) { N_VScale(a, x[0], x[0]); });
    check_same([&](Vectors& x) { N_VConst(a, x[3]); });
  }
}

BOOST_AUTO_TEST_CASE(combinations_of_several_are_those_of_sundials_also_in_place) {
  for (int terms = 1; terms < count; ++terms) {
    check_same([&](Vectors& x) { N_VLinearCombination(terms, factors, x.from(0), x[7]); });
  }
  // The result is the first of them, as SUNDIALS allows it to be, or any other.
  for (int place = 0; place < count; ++place) {
    const auto into = [&](Vectors& x) {
      N_VLinearCombination(count, factors, x.from(0), x[place]);
    };
    const auto into_another = [&](Vectors& x) {
      const Vector sum = clone(x[0]);
      N_VLinearCombination(count, factors, x.from(0), sum.get());
      N_VScale(1, sum.get(), x[place]);
    };
    for (const Index n : halves) {
      BOOST_TEST(roundings(n, into, into_another) <= most_roundings);
    }
  }
}

BOOST_AUTO_TEST_CASE(operations_on_arrays_are_those_of_sundials) {
  for (int pairs = 1; pairs <= 3; ++pairs) {
    check_same([&](Vectors& x) { N_VScaleAddMulti(pairs, factors, x[0], x.from(1), x.from(4)); });
    check_same([&](Vectors& x) { N_VScaleAddMulti(pairs, factors, x[0], x.from(1), x.from(1)); });
    check_same([&](Vectors& x) { N_VScaleVectorArray(pairs, factors, x.from(0), x.from(4)); });
    check_same([&](Vectors& x) { N_VScaleVectorArray(pairs, factors, x.from(0), x.from(0)); });
    check_same([&](Vectors& x) {
      N_VLinearSumVectorArray(pairs, 0.7, x.from(0), -1.3, x.from(4), x.from(0));
    });
  }
}

BOOST_AUTO_TEST_CASE(the_weighted_norm_is_that_of_sundials) {
  for (const Index n : halves) {
    const Vectors ours(make_vector, n, 2), theirs(make_stock_vector, n, 2);
    const double norm = N_VWrmsNorm(theirs[0], theirs[1]);
    // 2n squares are each rounded and added; the root halves that.
    BOOST_TEST(std::abs(N_VWrmsNorm(ours[0], ours[1]) - norm) <=
               static_cast<double>(n + 2) * eps * norm);
    BOOST_TEST(norm > 0);
  }
}

BOOST_AUTO_TEST_SUITE_END()
