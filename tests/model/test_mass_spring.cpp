#include <utility>

#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(mass_spring)

using namespace qddot;

namespace {

// All springs stretched, all compressed, all at rest.
const auto stretches = {1.4, 0.7, 1.0};

}  // namespace

// A spring's force and block are the derivatives of its energy and force, see the suite `spring`; K
// is the sum of the blocks, see `split_stiffness`.
BOOST_AUTO_TEST_CASE(potential_force_and_mass_are_the_sums_over_springs_weights_and_loads) {
  for_networks(stretches, [](const Network& network, const Vec& q) {
    double v = network.constant_energy;
    Vec f = Vec::Zero(q.size()), mass = f;
    const Coordinates<double> nodes(network, q);
    const int dimension = network.dimension;
    for (int i = 0; i < network.node_mass.size(); ++i) {
      Vec pull = network.node_mass[i] * network.gravity.head(dimension);
      if (network.load.size() > 0) pull += network.load.segment(dimension * i, dimension);
      v -= pull.dot(nodes.x[i]);
      f += nodes.slope[i].transpose() * pull;
      mass += network.node_mass[i] * nodes.slope[i].colwise().sum().transpose();
    }
    for_differences<double>(network, q,
                            [&](const SpringLaw& law, const Vec& d, const Eigen::MatrixXd& slope) {
                              v += law.energy(d.norm());
                              f -= law.tension(d.norm()) * slope.transpose() * d.normalized();
                            });
    const auto system = make_mass_spring(network);
    // Some 60 terms of up to 1e3 J, each rounded a few times. Forces add up to 1e4 N at a node.
    BOOST_TEST(std::abs(system->potential(q) - v) < 60 * 4 * eps * 1e3);
    BOOST_TEST(distance(force_at(*system, q), f) < 500 * eps * f.cwiseAbs().maxCoeff());
    BOOST_TEST((system->mass() == mass));
  });
}

BOOST_AUTO_TEST_CASE(pattern_holds_the_lower_blocks_of_nodes_and_joined_pairs_and_no_more) {
  for_networks({1.0}, [](const Network& network, const Vec& q) {
    Eigen::MatrixXd joined = Eigen::MatrixXd::Zero(q.size(), q.size());
    const auto join = [&](const Eigen::MatrixXd& slope) {
      const Vec any = slope.cwiseAbs().colwise().sum();
      joined += any * any.transpose();
    };
    for (const auto& slope : Coordinates<double>(network, q).slope) join(slope);
    for_differences<double>(network, q,
                            [&](const auto&, const auto&, const auto& slope) { join(slope); });
    std::vector<std::pair<int, int>> expected;  // column, row: in the order of storage
    for (int column = 0; column < q.size(); ++column) {
      for (int row = column; row < q.size(); ++row) {
        if (joined(row, column) > 0) expected.emplace_back(column, row);
      }
    }
    const auto system = make_mass_spring(network);
    const SymmetricMatrix& pattern = system->stiffness_pattern();
    std::vector<std::pair<int, int>> stored;
    for (int column = 0; column < pattern.cols(); ++column) {
      for (SymmetricMatrix::InnerIterator entry(pattern, column); entry; ++entry) {
        stored.push_back({column, static_cast<int>(entry.row())});
        BOOST_TEST(entry.value() == 0);
      }
    }
    BOOST_TEST(pattern.isCompressed());
    BOOST_TEST(pattern.cols() == q.size());
    BOOST_TEST((stored == expected));
  });
}

BOOST_AUTO_TEST_CASE(without_pins_a_translation_changes_no_force_and_forces_cancel) {
  std::mt19937 random(1);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : stretches) {
      Problem p = random_network(random, dimension, 6, stretch);
      p.network.anchors.clear();
      p.network.gravity.setZero();
      const auto system = make_mass_spring(p.network);
      const Eigen::MatrixXd k = dense(stiffness_at(*system, p.initial.q));
      const Vec f = force_at(*system, p.initial.q);
      for (int d = 0; d < dimension; ++d) {
        const Vec shift = Vec::Unit(dimension, d).replicate(6, 1);
        // Sums of up to 20 terms, each rounded.
        BOOST_TEST((k * shift).cwiseAbs().maxCoeff() < 20 * eps * k.cwiseAbs().maxCoeff());
        BOOST_TEST(std::abs(f.dot(shift)) <= 20 * eps * f.cwiseAbs().maxCoeff());
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(stiffness_is_constant_exactly_where_every_law_is_linear) {
  const SpringLaw linear = {.stiffness = 3};
  const auto is_constant = [&](const SpringLaw& link, const SpringLaw& anchor,
                               const SpringLaw& image, bool may_be = true) {
    const Network network = {.node_mass = Vec::Ones(2),
                             .links = {{0, 1, linear}, {1, 0, link}},
                             .anchors = {{0, {1, 0, 0}, anchor}, {1, {0, 1, 0}, linear}},
                             .image_links = {{1, 0, {-1, 1, 1}, image}},
                             .uses_constant_stiffness = may_be};
    const auto system = make_mass_spring(network);
    const Vec a = Vec::LinSpaced(6, 0, 1), b = Vec::LinSpaced(6, 3, -1).cwiseAbs2();
    const auto there = dense(stiffness_at(*system, a)), here = dense(stiffness_at(*system, b));
    // k nn' + k (I - nn') is k I to round-off.
    const bool is_same = distance(here, there) < 30 * eps;
    BOOST_TEST(system->stiffness_is_constant() == (is_same && may_be));
    return system->stiffness_is_constant();
  };
  const SpringLaw at_rest = {.stiffness = 3, .rest_length = 1e-9}, quartic = {.quartic = 1e-9};
  BOOST_TEST(make_mass_spring({.node_mass = Vec::Ones(2)})->stiffness_is_constant());
  BOOST_TEST(is_constant(linear, linear, linear));
  BOOST_TEST(!is_constant(linear, linear, linear, false));
  for (const SpringLaw& law : {at_rest, quartic}) {
    BOOST_TEST(!is_constant(law, linear, linear));
    BOOST_TEST(!is_constant(linear, law, linear));
    BOOST_TEST(!is_constant(linear, linear, law));
  }
}

BOOST_AUTO_TEST_CASE(network_without_nodes_has_only_its_constant_energy) {
  for (const int dimension : {1, 2, 3}) {
    const auto system = make_mass_spring({.dimension = dimension, .constant_energy = 2});
    BOOST_TEST(system->size() == 0);
    BOOST_TEST(system->potential(Vec()) == 2);
    BOOST_TEST(system->kinetic(Vec()) == 0);
    BOOST_TEST(force_at(*system, Vec()).size() == 0);
    BOOST_TEST(stiffness_at(*system, Vec()).size() == 0);
  }
}

BOOST_AUTO_TEST_CASE(massless_node_has_springs_but_no_weight_and_no_kinetic_energy) {
  const auto system = make_mass_spring({.dimension = 2,
                                        .gravity = {0, -9.81, 0},
                                        .node_mass = Vec{{0, 2}},
                                        .links = {{0, 1, {.stiffness = 7}}}});
  BOOST_TEST(system->has_massless());
  BOOST_TEST((system->mass() == Vec{{0, 0, 2, 2}}));
  BOOST_TEST(system->kinetic(Vec{{100, 100, 3, 4}}) == 25);
  BOOST_TEST((force_at(*system, Vec{{0, 0, 1, 0}}).head(2) == Vec{{7, 0}}));
}

BOOST_AUTO_TEST_SUITE_END()
