#include <boost/test/unit_test.hpp>

#include "qddot/algebra/automatic_factors.hpp"
#include "qddot/algebra/factors.hpp"
#include "tests/algebra/matrices.hpp"

BOOST_AUTO_TEST_SUITE(automatic_factors)

using namespace qddot;

namespace {

constexpr double tolerance = 1e-6;

// A scene with all springs at so many times their rest lengths, solved with by both.
struct Both {
  Both(const std::string& name, const GeneratorValues& values, double stretch)
      : matrix(displaced(stretched(draw(name, values), stretch), only_pins, 0)),
        k(matrix.k),
        b(Vec::LinSpaced(k.rows(), -1, 2)),
        automatic(make_automatic_factors(k, matrix.diagonal)),
        direct(make_multifrontal(k, matrix.diagonal)) {
    automatic->set_tolerance(tolerance);
  }
  // Whether the automatic factors gave the last bits of the direct ones: then they are the same.
  bool solves_directly() {
    BOOST_TEST((automatic->solve(b, x) == SolveOutcome::found));
    direct->solve(b, y);
    BOOST_TEST(distance(x, y) < 1e3 * tolerance * y.cwiseAbs().maxCoeff());
    return x == y;
  }

  Matrix matrix;
  const SymmetricMatrix& k;
  Vec b, x, y;
  std::unique_ptr<Factors> automatic, direct;
};

Both block(double stretch) {
  return {"lattice", {{"nodes_x", 18}, {"nodes_y", 17}, {"nodes_z", 17}}, stretch};
}

}  // namespace

BOOST_AUTO_TEST_CASE(small_scenes_are_factorised) {
  for (const char* name : {"cloth", "chain", "lattice"}) {
    Both both(name, {}, 1.1);
    BOOST_TEST(both.automatic->factorize_positive(1, 1e-6, both.k));
    BOOST_TEST(both.direct->factorize_positive(1, 1e-6, both.k));
    BOOST_TEST(both.solves_directly());
  }
}

// Few solves with a matrix are left to conjugate gradients; many pay for a factorisation, and so do
// as many with the next matrix.
BOOST_AUTO_TEST_CASE(a_block_is_factorised_once_its_iterations_have_cost_as_much) {
  Both both = block(1.1);
  const auto factorize = [&](double s) {
    BOOST_TEST(both.automatic->factorize_positive(1, s, both.k));
    BOOST_TEST(both.direct->factorize_positive(1, s, both.k));
  };
  for (int matrix = 0; matrix < 3; ++matrix) {
    factorize(1e-6);
    BOOST_TEST(!both.solves_directly());
  }
  int iterative = 0;
  factorize(2e-6);
  while (iterative < 1000 && !both.solves_directly()) ++iterative;
  BOOST_TEST((iterative > 1 && iterative < 1000));
  for (int i = 0; i < 3 * iterative; ++i) BOOST_TEST(both.solves_directly());
  factorize(3e-6);
  BOOST_TEST(both.solves_directly());
  // After one solve with that matrix, the next one iterates again.
  factorize(3e-6);
  BOOST_TEST(!both.solves_directly());
}

// Springs pushed to 0.9 of their lengths: in steps so long the block buckles.
BOOST_AUTO_TEST_CASE(an_indefinite_block_is_factorised_where_it_may_be_and_else_reported) {
  Both both = block(0.9);
  BOOST_TEST((both.direct->factorize(1, 1e-4, both.k) == Definiteness::indefinite));
  both.automatic->factorize(1, 1e-4, both.k);
  both.solves_directly();
  BOOST_TEST(both.automatic->negative_pivots() == both.direct->negative_pivots());
  if (both.automatic->factorize_positive(1, 1e-4, both.k))
    BOOST_TEST((both.automatic->solve(both.b, both.x) == SolveOutcome::indefinite));
}

BOOST_AUTO_TEST_SUITE_END()
