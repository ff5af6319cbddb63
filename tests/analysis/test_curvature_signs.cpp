#include <boost/test/unit_test.hpp>

#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/analysis/stability.hpp"
#include "tests/measure.hpp"
#include "tests/model/differences.hpp"
#include "tests/problems.hpp"
#include "tests/scene/drawn.hpp"

BOOST_AUTO_TEST_SUITE(curvature_signs)

using namespace qddot;

namespace {

using Real = long double;
using Dense = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

// A network's -K, spring by spring, and the sum of the stiffnesses at each node, in 64 bits of
// mantissa.
struct Reference {
  Dense stiff;
  Column at_node;

  Reference(const Problem& p) {
    const auto block = [](const SpringLaw& law, Real l, const Column& n) -> Dense {
      const Dense along = n * n.transpose(), one = Dense::Identity(n.size(), n.size());
      return law.tangent(l) * along + law.tension(l) / l * (one - along);
    };
    const auto everywhere = [](const SpringLaw& law, Real l, const Column& n) -> Dense {
      return law.tangent(l) * Dense::Identity(n.size(), n.size());
    };
    stiff = -sum_of_blocks<Real>(p.network, p.initial.q, block);
    at_node = -sum_of_blocks<Real>(p.network, p.initial.q, everywhere).diagonal();
  }
  // Eigenvalues of D^-1 (-K), ascending.
  Column eigenvalues(const Column& d) const {
    const Column scale = d.cwiseSqrt().cwiseInverse();
    const Dense scaled = scale.asDiagonal() * stiff * scale.asDiagonal();
    return Eigen::SelfAdjointEigenSolver<Dense>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  }
};

// An upright pendulum: k times softer than 1 along the other way, it falls as m g / l says.
Problem pendulum(double ratio, bool upright) {
  const double weight = 0.1;
  Problem p;
  p.network = {.dimension = 2, .node_mass = Vec::Constant(1, 0.01)};
  p.network.gravity[1] = -10;
  const double y = upright ? 1 : -1;
  p.network.anchors = {{0, {0, 0, 0}, {ratio * weight, 1 - weight / (ratio * weight) * -y}}};
  p.initial.q = Vec{{0, y}};
  return p;
}

// Eigenvalues of -K are wrong by some roundings of the largest row sum.
constexpr double tolerance = 1e-13;

// Compares signs and the least eigenvalue of -K with those of a dense decomposition.
void check(const System& system, const Vec& q) {
  const Eigen::MatrixXd stiff = -dense(stiffness_at(system, q));
  const Vec values = qddot::eigenvalues(stiff);
  const double row_sum = stiff.cwiseAbs().rowwise().sum().maxCoeff();
  BOOST_TEST(qddot::curvature_signs(system, q).negative ==
             (values.array() < -1e-9 * row_sum).count());
  const auto [value, direction] = smallest_curvature(system, q);
  BOOST_TEST(std::abs(value - values[0]) < tolerance * row_sum);
  BOOST_TEST(std::abs(direction.norm() - 1) < tolerance);
  const double quotient = direction.dot(stiff * direction);
  BOOST_TEST(std::abs(quotient - value) < tolerance * row_sum);
  BOOST_TEST(std::abs(largest_row_sum(stiffness_at(system, q)) - row_sum) < tolerance * row_sum);
}

}  // namespace

BOOST_AUTO_TEST_CASE(pendulum_on_a_spring_of_any_stiffness_falls_or_hangs) {
  for (double ratio = 10; ratio <= 1e12; ratio *= 10) {
    for (const bool upright : {true, false}) {
      const Problem p = pendulum(ratio, upright);
      const CurvatureSigns signs =
          qddot::curvature_signs(*make_mass_spring(p.network), p.initial.q);
      BOOST_TEST(signs.negative == (upright ? 1 : 0), ratio);
      BOOST_TEST(signs.flat == 0, ratio);
      BOOST_TEST(signs.flat_rate == 0);
    }
  }
}

BOOST_AUTO_TEST_CASE(soft_spring_beside_a_stiff_one_is_not_loose) {
  for (const double soft : {1e3, 1.0, 1e-3, 1e-9, 1e-15}) {
    const auto system =
        make_mass_spring({.dimension = 1,
                          .node_mass = Vec::Ones(2),
                          .links = {{0, 1, {soft, 1}}},
                          .anchors = {{0, {0, 0, 0}, {.stiffness = 1e9, .rest_length = 1}}}});
    BOOST_TEST(qddot::curvature_signs(*system, Vec{{1, 2}}).negative == 0, soft);
    BOOST_TEST(qddot::curvature_signs(*system, Vec{{1, 2}}).flat == 0, soft);
  }
}

BOOST_AUTO_TEST_CASE(signs_of_random_networks_are_those_of_more_digits_at_all_ratios_of_stiffness) {
  std::mt19937 random(19);
  int negative = 0, flat = 0, all = 0;
  for (const double decades : {0.0, 3.0, 6.0, 9.0, 12.0}) {
    for (const double stretch : {1.2, 1.0, 0.98, 0.7}) {
      for (const int dimension : {1, 2, 3}) {
        for (const int nodes : {1, 4, 12}) {
          Problem p = random_network(random, dimension, nodes, stretch);
          for_springs(p.network, [&](auto& spring) {
            const double factor =
                std::pow(10, std::uniform_real_distribution<>(0, decades)(random));
            spring.law.stiffness *= factor;
            spring.law.quartic *= factor;
          });
          const auto system = make_mass_spring(p.network);
          const CurvatureSigns signs = qddot::curvature_signs(*system, p.initial.q);
          const Reference reference(p);
          const Column values = reference.eigenvalues(reference.at_node);
          const auto below = [&](Real value) { return (values.array() < value).count(); };
          BOOST_TEST(signs.negative <= below(0));
          BOOST_TEST(signs.negative + signs.flat >= below(0));
          // Roundings come from two rows of K with up to 40 springs each (32 eps of both and of k)
          // and from positions. All of them are below 1e-12 of the stiffness at the place.
          BOOST_TEST(signs.flat <= below(1e-12L) - below(-1e-12L));
          if (signs.flat > 0) {
            const Column rates = reference.eigenvalues(system->mass().cast<Real>());
            BOOST_TEST(rates[signs.negative] >= -std::pow(signs.flat_rate, 2));
          }
          if (decades == 0) {
            check(*system, p.initial.q);
            for (int i = 0; i < nodes; i += 2) p.network.node_mass[i] = 0;
            check(*make_mass_spring(p.network), p.initial.q);
          }
          negative += signs.negative;
          flat += signs.flat;
          all += static_cast<int>(values.size());
        }
      }
    }
  }
  // There was something to count, and little that could not be: mechanisms at rest lengths.
  BOOST_TEST(negative > all / 20);
  BOOST_TEST(flat < all / 10);
}

BOOST_AUTO_TEST_CASE(what_is_loose_is_flat_and_hardly_grows) {
  // A free pair in space at its rest length: translations, and turns about two axes.
  const auto pair =
      make_mass_spring({.dimension = 3, .node_mass = Vec::Ones(2), .links = {{0, 1, {100, 1}}}});
  const CurvatureSigns signs = qddot::curvature_signs(*pair, Vec{{0, 0, 0, 0.6, 0.8, 0}});
  BOOST_TEST(signs.negative == 0);
  BOOST_TEST(signs.flat == 5);
  // Some 100 roundings of the row sums, 400 N/m, over 1 kg.
  BOOST_TEST(signs.flat_rate < 1e-5);
  // Nothing holds a chain at rest lengths across, and nothing pushes it there.
  for (const double pins : {0.0, 1.0, 2.0}) {
    const Model chain(draw("chain", {{"nodes", 40}, {"pinned_ends", pins}}),
                      Reductions::all_directions());
    BOOST_TEST(qddot::curvature_signs(chain.system(), chain.initial().q).negative == 0);
  }
  // Without springs nothing is known to rise, nor to grow.
  const auto nothing = make_mass_spring({.dimension = 2, .node_mass = Vec::Ones(2)});
  BOOST_TEST(qddot::curvature_signs(*nothing, Vec::Ones(4)).flat == 4);
  BOOST_TEST(qddot::curvature_signs(*nothing, Vec::Ones(4)).flat_rate == 0);
}

BOOST_AUTO_TEST_CASE(soft_modes_beside_stiff_ones_have_their_own_digits) {
  // Two rows of masses between walls, w_j = 2 sqrt(k/m) sin(j pi / (2 (n+1))), small and large.
  for (const int n : {20, 250}) {
    const double soft = 1e-3, stiff = 1e9;
    const auto system =
        in_parts(row_of_masses(1, n, 1, {soft, 1}), row_of_masses(1, n, 1, {stiff, 1}));
    const Vec q = Vec::LinSpaced(n, 1, n).replicate(2, 1);
    BOOST_TEST(qddot::curvature_signs(system, q).flat == 0);
    const NaturalModes modes = lowest_modes(system, q, 3);
    for (Index j = 0; j < 3; ++j) {
      const double w = 2 * std::sqrt(soft) * std::sin(double(j + 1) * M_PI / (2 * (n + 1)));
      // Roundings of the soft row's k: its lowest w^2 is 4e-5 of them.
      BOOST_TEST(std::abs(modes.squares[j] / (w * w) - 1) < 1e-10);
    }
  }
}

BOOST_AUTO_TEST_CASE(large_cloth_is_counted_as_a_small_one_is) {
  for (const double stretch : {1.1, 1.0, 0.9}) {
    const Model reduced(stretched(draw("cloth", {{"nodes", 13}}), stretch),
                        Reductions::all_directions());
    check(reduced.system(), reduced.initial().q);
  }
}

BOOST_AUTO_TEST_CASE(strut_between_two_forces_buckles_in_two_directions) {
  // One node between two pins, on springs compressed by 10 %: -K is 2 tau / l < 0 across the line
  // and 2 k along it.
  const auto system =
      make_mass_spring({.dimension = 3,
                        .node_mass = Vec::Ones(1),
                        .anchors = {{0, {-0.9, 0, 0}, {10, 1}}, {0, {0.9, 0, 0}, {10, 1}}}});
  BOOST_TEST(qddot::curvature_signs(*system, Vec::Zero(3)).negative == 2);
  const auto [value, direction] = smallest_curvature(*system, Vec::Zero(3));
  BOOST_TEST(std::abs(value + 2 * 10 * 0.1 / 0.9) < tolerance * 20);
  BOOST_TEST(std::abs(direction[0]) < tolerance);
}

BOOST_AUTO_TEST_CASE(zeros_of_the_metric_become_the_mean_mass) {
  const auto metric = [](const Vec& mass) {
    return metric_of_all(*make_mass_spring({.dimension = 1, .node_mass = mass}));
  };
  BOOST_TEST((metric(Vec{{1, 0, 3}}) == Vec{{1, 2, 3}}));
  BOOST_TEST((metric(Vec{{0, 0}}) == Vec{{1, 1}}));
}

BOOST_AUTO_TEST_CASE(stiffness_that_overflows_is_no_endless_loop) {
  const auto system = make_mass_spring(
      {.dimension = 1, .node_mass = Vec::Ones(1), .anchors = {{0, {0, 0, 0}, {.quartic = 1e300}}}});
  BOOST_CHECK_THROW(qddot::curvature_signs(*system, Vec::Constant(1, 1e10)), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(nothing_is_stable) {
  const auto system = make_mass_spring({.dimension = 3});
  BOOST_TEST(qddot::curvature_signs(*system, Vec()).negative == 0);
  BOOST_TEST(largest_row_sum(system->stiffness_pattern()) == 0);
  BOOST_CHECK_THROW(smallest_curvature(*system, Vec()), std::invalid_argument);
  const auto loose = make_mass_spring({.dimension = 1, .node_mass = Vec::Ones(2)});
  BOOST_TEST(qddot::curvature_signs(*loose, Vec{{0, 1}}).negative == 0);
  BOOST_TEST(smallest_curvature(*loose, Vec{{0, 1}}).value == 0);
}

BOOST_AUTO_TEST_SUITE_END()
