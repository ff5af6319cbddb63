#include <limits>

#include <boost/test/unit_test.hpp>

#include "qddot/algebra/factors.hpp"
#include "qddot/algebra/laplacian_mass.hpp"
#include "qddot/model/block_diagonal_system.hpp"
#include "qddot/model/constrained_system.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(laplacian_mass)

using namespace qddot;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

Scene cloth(int nodes) { return generate(*find_generator("cloth"), {{"nodes", nodes}}, "test"); }

// |(M + s L) x - b| over |M + s L| |x| + |b|.
double backward_error(const System& system, double s) {
  LaplacianMass matrix(system);
  BOOST_TEST_REQUIRE(matrix.factorize(s));
  SymmetricMatrix l = system.stiffness_pattern();
  offered<Laplacian>(system).laplacian(l);
  const SymmetricMatrix both = l.selfadjointView<Eigen::Lower>();
  const Vec b = Vec::LinSpaced(system.size(), -1, 2).array().sin();
  Vec x = Vec::Constant(system.size(), NAN);
  matrix.solve(b, x);
  const Vec product = system.mass().cwiseProduct(x) + s * (both * x);
  const double norm = (system.mass() + s * (both.cwiseAbs() * Vec::Ones(system.size()))).maxCoeff();
  return distance(product, b) / (norm * x.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}

// As in the suite `multifrontal`.
double tolerance(const System& system) {
  return 10 * eps * std::sqrt(static_cast<double>(system.size() + 1));
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_solves_on_networks_with_images_anchors_and_nodes_on_planes) {
  for_random_images([](const ImageSample& sample) {
    const auto system = make_mass_spring(sample.network);
    for (const double s : {0.0, 1e-4, 1e4}) {
      BOOST_TEST(backward_error(*system, s) < tolerance(*system));
    }
  });
}

BOOST_AUTO_TEST_CASE(it_solves_on_cloths_as_they_are_and_reduced_held_or_in_parts) {
  for (const int nodes : {3, 10, 30}) {
    const Scene scene = cloth(nodes);
    for (const Reductions& reductions :
         {Reductions(), Reductions().without(Reduction::mirror),
          Reductions().without(Reduction::pins), Reductions::only({Reduction::pins})}) {
      const ReducedScene reduced(scene, reductions);
      BOOST_TEST(backward_error(reduced.system(), 1e-4) < tolerance(reduced.system()));
    }
  }
  // Five times the same: fifteen columns in four solves.
  std::vector<std::unique_ptr<System>> parts;
  for (int i = 0; i < 5; ++i) parts.push_back(make_mass_spring(hammock(3).network));
  const BlockDiagonalSystem divided(std::move(parts));
  BOOST_TEST(backward_error(divided, 1e-2) < tolerance(divided));
  BOOST_TEST((LaplacianMass(divided).sizes() == std::vector<Index>{4}));
}

BOOST_AUTO_TEST_CASE(axes_that_are_alike_have_one_matrix) {
  const Scene scene = cloth(11);
  const ReducedScene whole(scene, Reductions().without(Reduction::mirror));
  BOOST_TEST((LaplacianMass(whole.system()).sizes() == std::vector<Index>{11 * 11 - 2}));
  // The middle column has no x in the mirror x = 0.5, and links to images have another sign there.
  const ReducedScene half(scene);
  BOOST_TEST((LaplacianMass(half.system()).sizes() == std::vector<Index>{11 * 6 - 1, 11 * 5 - 1}));
}

BOOST_AUTO_TEST_CASE(four_columns_are_solved_for_as_each_by_itself) {
  for (const int nodes : {2, 3, 9, 40}) {
    const ReducedScene scene(cloth(nodes), Reductions().without(Reduction::mirror));
    const System& system = scene.system();
    SymmetricMatrix k = system.stiffness_pattern();
    system.stiffness(scene.initial().q, k);
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
