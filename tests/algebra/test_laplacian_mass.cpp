#include <boost/test/unit_test.hpp>

#include "qddot/algebra/factors.hpp"
#include "qddot/algebra/laplacian_mass.hpp"
#include "tests/algebra/matrices.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(laplacian_mass)

using namespace qddot;

namespace {

Scene cloth(int nodes) { return draw("cloth", {{"nodes", nodes}}); }

// Solves with M + s L.
void check_solve(const System& system, double s) {
  LaplacianMass matrix(system);
  BOOST_TEST_REQUIRE(matrix.factorize(s));
  SymmetricMatrix l = system.stiffness_pattern();
  offered(system.laplacian()).assemble_laplacian(l);
  const SymmetricMatrix a = whole(system.mass(), -s, l);
  const Vec b = Vec::LinSpaced(system.size(), -1, 2).array().sin();
  Vec x = Vec::Constant(system.size(), NAN);
  matrix.solve(b, x);
  BOOST_TEST(backward_error(a, x, b) < tolerance_of(a));
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_solves_on_networks_with_images_anchors_and_nodes_on_planes) {
  for_networks({1.4, 0.7}, [](const Network& network, const Vec&) {
    const auto system = make_mass_spring(network);
    for (const double s : {0.0, 1e-4, 1e4}) check_solve(*system, s);
  });
}

BOOST_AUTO_TEST_CASE(it_solves_on_cloths_as_they_are_and_reduced_held_or_in_parts) {
  for (const int nodes : {3, 10, 30}) {
    const Scene scene = cloth(nodes);
    for (const Reductions& reductions :
         {Reductions(), Reductions().without(Reduction::mirror),
          Reductions().without(Reduction::pins), Reductions::only({Reduction::pins})}) {
      const Model reduced(scene, reductions);
      check_solve(reduced.system(), 1e-4);
    }
  }
  // Five times the same: fifteen columns in four solves.
  const Network one = hammock(3).network;
  const BlockDiagonalSystem divided = in_parts(one, one, one, one, one);
  check_solve(divided, 1e-2);
  BOOST_TEST((LaplacianMass(divided).sizes() == std::vector<Index>{4}));
}

BOOST_AUTO_TEST_CASE(axes_that_are_alike_have_one_matrix) {
  const Scene scene = cloth(11);
  const Model whole(scene, Reductions().without(Reduction::mirror));
  BOOST_TEST((LaplacianMass(whole.system()).sizes() == std::vector<Index>{11 * 11 - 2}));
  // The middle column has no x in the mirror x = 0.5, and links to images have another sign there.
  const Model half(scene);
  BOOST_TEST((LaplacianMass(half.system()).sizes() == std::vector<Index>{11 * 6 - 1, 11 * 5 - 1}));
}

BOOST_AUTO_TEST_CASE(four_columns_are_solved_for_as_each_by_itself) {
  for (const int nodes : {2, 3, 9, 40}) {
    const Model scene(cloth(nodes), Reductions().without(Reduction::mirror));
    const System& system = scene.system();
    const SymmetricMatrix k = stiffness_at(system, scene.initial().q);
    const auto factors = make_multifrontal(k, system.mass());
    BOOST_TEST_REQUIRE(factors->factorize_positive(1, 1e-4, k));
    FourColumns b = FourColumns::Random(system.size(), 4), x(system.size(), 4);
    b.col(2).setZero();
    factors->solve(b, x);
    for (Index c = 0; c < 4; ++c) {
      Vec alone(system.size());
      factors->solve(b.col(c), alone);
      // Other orders of the same sums, in a matrix of condition 1e4.
      BOOST_TEST(distance(alone, x.col(c)) <= 1e4 * eps * alone.cwiseAbs().maxCoeff());
    }
    BOOST_TEST((x.col(2).array() == 0).all());
    BOOST_TEST(distance(x.col(0), x.col(1)) > 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(without_mass_or_springs_there_is_nothing_to_solve_with) {
  Network network{.dimension = 2, .node_mass = Vec{{1, 0}}};
  const auto loose = make_mass_spring(network);
  BOOST_TEST(!LaplacianMass(*loose).factorize(1e-4));
  network.links = {{0, 1, {100, 1}}};
  const auto tied = make_mass_spring(network);
  BOOST_TEST(LaplacianMass(*tied).factorize(1e-4));
  BOOST_TEST(!LaplacianMass(*tied).factorize(0));
  BOOST_TEST(!LaplacianMass(*tied).factorize(NAN));
}

BOOST_AUTO_TEST_SUITE_END()
