#include <set>
#include <utility>

#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(mass_spring)

using namespace qddot;

namespace {

// Balances the truncation h^4 |g^(5)| / 30 with the rounding eps |g| / h in the networks below.
// Their springs of 0.4 to 15 m have fifth derivatives of at most some 1e3 times V and f.
constexpr double step = 1e-3;

// Relative error of differences with that step: 1e-12 * 1e3 / 30 from truncation, ten eps / 1e-3
// from rounding; both well below this.
constexpr double difference_error = 1e-9;

// All springs stretched, all compressed, all at rest.
const auto stretches = {1.4, 0.7, 1.0};

// Networks without anchors, images and gravity.
template <class Check>
void for_networks_without_pins(const Check& check) {
  std::mt19937 random(1);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : stretches) {
      Problem p = random_network(random, dimension, 6, stretch);
      p.network.anchors.clear();
      p.network.gravity.setZero();
      check(p);
    }
  }
}

// The displacement of all nodes together along axis d.
Vec translation(const Problem& p, int d) {
  return Vec::Unit(p.network.dimension, d).replicate(p.network.node_mass.size(), 1);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_potential_is_the_sum_over_springs_weights_and_loads) {
  for_networks(stretches, [](const Network& network, const Vec& q) {
    std::vector<Eigen::Vector3d> x;
    double v = network.constant_energy;
    Index unknown = 0;
    for (int i = 0; i < network.node_mass.size(); ++i) {
      x.push_back(Eigen::Vector3d::Zero());
      for (int d = 0; d < network.dimension; ++d) {
        if (is_unknown(network, i, d)) x[i][d] = q[unknown++];
        if (network.load.size() > 0) v -= network.load[network.dimension * i + d] * x[i][d];
      }
      v -= network.node_mass[i] * network.gravity.dot(x[i]);
    }
    for (const auto& link : network.links) v += link.law.energy((x[link.j] - x[link.i]).norm());
    for (const auto& image : network.image_links)
      v += image.law.energy((image.mirror.cwiseProduct(x[image.j]) - x[image.i]).norm());
    for (const auto& anchor : network.anchors)
      v += anchor.law.energy((anchor.point - x[anchor.i]).norm());
    // Some 60 terms of up to 1e3 J, each rounded a few times.
    BOOST_TEST(std::abs(make_mass_spring(network)->potential(q) - v) < 60 * 4 * eps * 1e3);
  });
}

BOOST_AUTO_TEST_CASE(force_is_minus_the_gradient_of_the_potential) {
  for_networks(stretches, [](const Network& network, const Vec& at) {
    const auto system = make_mass_spring(network);
    const auto v = [&](const Vec& q) { return Vec::Constant(1, system->potential(q)); };
    const Vec gradient = finite_difference_jacobian(v, at, step).transpose();
    const double scale = std::abs(system->potential(at)) + gradient.cwiseAbs().maxCoeff();
    BOOST_TEST(distance(force_at(*system, at), -gradient) < difference_error * scale);
  });
}

// The full K against the differences of f: only if they are symmetric can it agree with them.
BOOST_AUTO_TEST_CASE(stiffness_is_the_symmetric_jacobian_of_the_force) {
  for_networks(stretches, [](const Network& network, const Vec& at) {
    const auto system = make_mass_spring(network);
    const auto force = [&](const Vec& q) { return force_at(*system, q); };
    SymmetricMatrix k = stiffness_at(*system, at);
    BOOST_TEST(distance(dense(k), finite_difference_jacobian(force, at, step)) <
               difference_error * dense(k).cwiseAbs().maxCoeff());
    system->stiffness(1.5 * at, k);  // which is forgotten
    system->stiffness(at, k);
    BOOST_TEST(distance(dense(k), dense(stiffness_at(*system, at))) == 0);
  });
}

BOOST_AUTO_TEST_CASE(pattern_holds_the_lower_blocks_of_nodes_and_joined_pairs_and_no_more) {
  for_networks({1.0}, [](const Network& network, const Vec& q) {
    std::vector<std::vector<int>> unknowns;
    int next = 0;
    for (int i = 0; i < network.node_mass.size(); ++i) {
      unknowns.emplace_back();
      for (int d = 0; d < network.dimension; ++d) {
        if (is_unknown(network, i, d)) unknowns.back().push_back(next++);
      }
    }
    std::set<std::pair<int, int>> expected;  // column, row: in the order of storage
    const auto add_block = [&](int i, int j) {
      for (const int a : unknowns[i]) {
        for (const int b : unknowns[j]) expected.insert(std::minmax(a, b));
      }
    };
    for (int i = 0; i < network.node_mass.size(); ++i) add_block(i, i);
    for (const auto& link : network.links) add_block(link.i, link.j);
    for (const auto& image : network.image_links) add_block(image.i, image.j);
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
    BOOST_TEST((stored == std::vector(expected.begin(), expected.end())));
  });
}

BOOST_AUTO_TEST_CASE(without_pins_a_translation_changes_no_force_and_forces_cancel) {
  for_networks_without_pins([](const Problem& p) {
    const auto system = make_mass_spring(p.network);
    const Eigen::MatrixXd k = dense(stiffness_at(*system, p.initial.q));
    const Vec f = force_at(*system, p.initial.q);
    for (int d = 0; d < p.network.dimension; ++d) {
      const Vec shift = translation(p, d);
      // Sums of up to 20 terms, each rounded.
      BOOST_TEST((k * shift).cwiseAbs().maxCoeff() < 20 * eps * k.cwiseAbs().maxCoeff());
      BOOST_TEST(std::abs(f.dot(shift)) <= 20 * eps * f.cwiseAbs().maxCoeff());
    }
  });
}

BOOST_AUTO_TEST_CASE(rotation_keeps_the_potential_and_turns_the_force) {
  for_networks_without_pins([](const Problem& p) {
    const auto system = make_mass_spring(p.network);
    const int dimension = p.network.dimension;
    // A reflection in 1D, a rotation in 2D and 3D, as a product of two reflections.
    const auto reflection = [&](const Vec& x) -> Eigen::MatrixXd {
      const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(dimension, dimension);
      return identity - 2 * x * x.transpose() / x.squaredNorm();
    };
    Eigen::MatrixXd turn = reflection(Vec::Ones(dimension));
    if (dimension > 1) turn *= reflection(Vec::LinSpaced(dimension, -1, 2));
    const auto turned = [&](const Vec& x) -> Vec {
      return (turn * x.reshaped(dimension, x.size() / dimension)).reshaped();
    };
    // Lengths near 1 m have 16 digits. k of 200 and c of 50 at strains of 3 m make that at most 1e4
    // eps of energy and force.
    BOOST_TEST(std::abs(system->potential(turned(p.initial.q)) - system->potential(p.initial.q)) <=
               1e4 * eps);
    BOOST_TEST(distance(force_at(*system, turned(p.initial.q)),
                        turned(force_at(*system, p.initial.q))) <= 1e4 * eps);
  });
}

BOOST_AUTO_TEST_CASE(gravity_alone_pulls_each_mass_down) {
  const Network network = {.dimension = 2, .gravity = {1, -9.5, 0}, .node_mass = Vec{{2, 3}}};
  const auto system = make_mass_spring(network);
  const Vec q{{0.5, 4, -1, 2}};
  BOOST_TEST((force_at(*system, q) == Vec{{2, -19, 3, -28.5}}));
  BOOST_TEST(system->potential(q) == -(2 * (0.5 - 38) + 3 * (-1 - 19)));
  BOOST_TEST(dense(stiffness_at(*system, q)).cwiseAbs().maxCoeff() == 0);
  BOOST_TEST(system->stiffness_is_constant());
}

BOOST_AUTO_TEST_CASE(energies_of_the_oscillator_are_those_of_the_closed_form) {
  const Oscillator o;
  const auto [network, initial] = o.problem();
  const auto system = make_mass_spring(network);
  BOOST_TEST(system->kinetic(initial.v) == 0.5 * 2 * 1.5 * 1.5);
  for (const double t : {0.0, 0.3, 1.7}) {
    const State state = {t, Vec::Constant(1, o.position(t)), Vec::Constant(1, o.velocity(t))};
    BOOST_TEST(std::abs(total_energy(*system, state) - o.energy()) < 10 * eps * o.energy());
  }
}

BOOST_AUTO_TEST_CASE(a_spring_to_the_own_image_is_twice_as_long_as_the_way_to_the_plane) {
  const double k = 30, l0 = 1.5, x = 0.9;
  for (const int dimension : {1, 2, 3}) {
    for (int d = 0; d < dimension; ++d) {
      Network network{.dimension = dimension, .node_mass = Vec::Ones(1)};
      network.image_links = {
          {0, 0, Eigen::Vector3d::Ones() - 2 * Eigen::Vector3d::Unit(d), {k, l0}}};
      const auto system = make_mass_spring(network);
      const Vec q = Vec::Constant(dimension, x), normal = Vec::Unit(dimension, d);
      BOOST_TEST(std::abs(system->potential(q) - 0.5 * k * std::pow(2 * x - l0, 2)) < 1e-14);
      BOOST_TEST(distance(force_at(*system, q), -2 * k * (2 * x - l0) * normal) < 1e-13);
      // Along the plane it keeps its length.
      BOOST_TEST(distance(dense(stiffness_at(*system, q)), -4 * k * normal * normal.transpose()) <
                 1e-12);
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
  const SpringLaw at_rest = {.stiffness = 3, .rest_length = 0.5}, quartic = {.quartic = 1};
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
