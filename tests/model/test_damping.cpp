// Dashpots and air in a network: R = 1/2 sum c l'^2 + 1/2 alpha v'Mv, f_d = -dR/dv = -C v.
#include <boost/test/unit_test.hpp>

#include "qddot/model/constrained_system.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(damping)

using namespace qddot;

namespace {

// A network with dashpots beside most of its springs.
Network damped(Network network, std::mt19937& random, double air) {
  std::uniform_real_distribution<double> uniform(-0.3, 1);
  for_springs(network, [&](auto& spring) { spring.law.damping = std::max(0.0, uniform(random)); });
  network.air_damping = air;
  return network;
}

Vec random_vector(Index n, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vec v(n);
  for (double& x : v) x = uniform(random);
  return v;
}

// R at q and v, with l' by a central difference of l along v: exact up to e^2 l''' and eps/e.
double rayleigh(const Network& network, const System& system, const Vec& q, const Vec& v) {
  constexpr double e = 1e-5;
  double r = network.air_damping * system.kinetic(v);
  std::vector<Vec> before;
  for_differences<double>(network, q - e * v, [&](const SpringLaw&, const auto& d, const auto&) {
    before.push_back(d);
  });
  auto last = before.begin();
  for_differences<double>(
      network, q + e * v, [&](const SpringLaw& law, const auto& d, const auto&) {
        const Vec from = *last++, to = d;
        const double rate = law.rest_length > 0 ? (to.norm() - from.norm()) / (2 * e)
                                                : (to - from).norm() / (2 * e);
        r += 0.5 * law.damping * rate * rate;
      });
  return r;
}

SymmetricMatrix damping_at(const System& system, const Vec& q) {
  SymmetricMatrix c = system.stiffness_pattern();
  offered(system.damping()).damping_matrix(q, c);
  return c;
}

Vec friction_at(const System& system, const Vec& q, const Vec& v) {
  Vec f(q.size());
  offered(system.damping()).friction({0, q, v}, f);
  return f;
}

// Calls check(network, system, q, v) for networks of all kinds, summed spring by spring and by
// vectors.
template <class Check>
void for_networks(const Check& check) {
  std::mt19937 random(7);
  for (int sample = 0; sample < 24; ++sample) {
    const int dimension = 1 + sample % 3;
    Network network;
    Vec q;
    if (sample % 2 == 0) {
      const Problem p = random_network(random, dimension, 20, 1.1);
      network = p.network, q = p.initial.q;
    } else {
      const ImageSample s = random_images(random, dimension, 1.1, sample % 4 == 1);
      network = s.network, q = s.q;
    }
    if (sample % 5 == 0) network = without_rest_lengths(network);
    network = damped(network, random, sample % 3 == 0 ? 0 : 0.7);
    const Vec v = random_vector(q.size(), random);
    for (const Forces forces : {Forces::spring_by_spring, Forces::by_vectors}) {
      check(network, *make_mass_spring(network, forces), q, v);
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(friction_is_the_derivative_of_rayleighs_function) {
  for_networks([](const Network& network, const System& system, const Vec& q, const Vec& v) {
    const Vec f = friction_at(system, q, v);
    const Eigen::MatrixXd slope = finite_difference_jacobian(
        [&](const Vec& w) { return Vec(Vec::Constant(1, rayleigh(network, system, q, w))); }, v,
        1e-2);
    // R is quadratic in v: only l' errs, by 1e-10 of truncation and 1e-11 of rounding.
    BOOST_TEST((f + slope.transpose()).norm() <= 1e-8 * (1 + f.norm()));
  });
}

BOOST_AUTO_TEST_CASE(the_force_has_both_parts_and_without_velocities_one) {
  for_networks([](const Network& network, const System& system, const Vec& q, const Vec& v) {
    Network undamped = network;
    undamped.air_damping = 0;
    for_springs(undamped, [](auto& spring) { spring.law.damping = 0; });
    const Vec elastic = force_at(*make_mass_spring(undamped), q);
    Vec f(q.size());
    system.force(q, f);
    BOOST_TEST((f - elastic).norm() <= 64 * eps * (1 + elastic.norm()));
    system.force({0, q, v}, f);
    BOOST_TEST((f - elastic - friction_at(system, q, v)).norm() <= 64 * eps * (1 + f.norm()));
    BOOST_TEST(!system.is_conservative());
  });
}

BOOST_AUTO_TEST_CASE(c_is_symmetric_has_the_pattern_of_k_and_takes_energy) {
  for_networks([](const Network&, const System& system, const Vec& q, const Vec& v) {
    const SymmetricMatrix c = damping_at(system, q);
    BOOST_TEST(same_pattern(c, system.stiffness_pattern()));
    const Eigen::MatrixXd full = dense(c);
    const Vec friction = friction_at(system, q, v);
    BOOST_TEST((full * v + friction).norm() <= 64 * eps * (1 + full.norm() * v.norm()));
    BOOST_TEST(smallest_eigenvalue(full) >= -64 * eps * full.norm());
    SymmetricMatrix bound = system.stiffness_pattern();
    BOOST_TEST(offered(system.damping()).bound_damping(bound));
    BOOST_TEST(smallest_eigenvalue(dense(bound) - full) >= -64 * eps * full.norm());
  });
}

// Links alone: no pin takes momentum, and springs with rest lengths no angular momentum.
BOOST_AUTO_TEST_CASE(dashpots_neither_push_nor_turn_the_whole_and_let_it_turn) {
  std::mt19937 random(11);
  for (int sample = 0; sample < 10; ++sample) {
    Problem p = random_network(random, 3, 20, 1.2);
    p.network.anchors.clear();
    for_springs(p.network, [](auto& spring) { spring.law.rest_length += 0.1; });
    const auto system = make_mass_spring(damped(p.network, random, 0));
    const Vec& q = p.initial.q;
    const Vec f = friction_at(*system, q, random_vector(q.size(), random));
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
    for (Index i = 0; i < q.size(); i += 3) {
      force += f.segment<3>(i);
      torque += Eigen::Vector3d(q.segment<3>(i)).cross(Eigen::Vector3d(f.segment<3>(i)));
    }
    BOOST_TEST(force.norm() <= 64 * eps * f.norm());
    BOOST_TEST(torque.norm() <= 64 * eps * f.norm() * q.norm());
    Vec rigid(q.size());
    const Eigen::Vector3d spin(0.3, -1.1, 0.7), drift(2, 1, -1);
    for (Index i = 0; i < q.size(); i += 3) {
      rigid.segment<3>(i) = spin.cross(Eigen::Vector3d(q.segment<3>(i))) + drift;
    }
    BOOST_TEST(friction_at(*system, q, rigid).norm() <= 256 * eps * rigid.norm());
  }
}

BOOST_AUTO_TEST_CASE(a_dashpot_of_length_zero_resists_in_all_directions) {
  for (const double rest_length : {0.0, 0.5}) {
    for (const Forces forces : {Forces::spring_by_spring, Forces::by_vectors}) {
      Network network{.dimension = 3, .node_mass = Vec::Ones(2)};
      network.links = {{0, 1, {.stiffness = 3, .rest_length = rest_length, .damping = 2}}};
      const auto system = make_mass_spring(network, forces);
      const Vec q = Vec::Zero(6), v{{1, 2, 3, 0, 0, 0}};
      BOOST_TEST((friction_at(*system, q, v) - Vec{{-2, -4, -6, 2, 4, 6}}).norm() == 0);
      const Vec apart{{0, 0, 0, 0, 2, 0}};
      const Vec along = rest_length > 0 ? Vec{{0, -4, 0, 0, 4, 0}} : Vec{{-2, -4, -6, 2, 4, 6}};
      BOOST_TEST((friction_at(*system, apart, v) - along).norm() == 0);
    }
  }
}

// By the rates of lengths, which are zero where the whole turns; those by velocities are not.
BOOST_AUTO_TEST_CASE(friction_by_lengths_has_a_potential_and_lets_the_whole_turn) {
  for_networks([](const Network&, const System& system, const Vec& q, const Vec& v) {
    const Damping& damping = offered(system.damping());
    const Vec q1 = q - 0.05 * v, q2 = q - 0.13 * v;
    const double a0 = 7, a2 = 1.5, a1 = -a0 - a2;
    const Vec at_rest = Vec::Zero(q.size());  // no air
    const auto power = [&](const Vec& x) {
      Vec f(x.size());
      return damping.secant_friction({x, q1, q2, a0, a1, a2}, at_rest, f).value();
    };
    Vec f(q.size());
    if (!damping.has_dashpots()) {
      BOOST_TEST(!damping.secant_friction({q, q1, q2, a0, a1, a2}, v, f).has_value());
      return;
    }
    damping.secant_friction({q, q1, q2, a0, a1, a2}, at_rest, f);
    const Eigen::MatrixXd slope = finite_difference_jacobian(
        [&](const Vec& x) { return Vec(Vec::Constant(1, power(x) / (2 * a0))); }, q, 1e-5);
    // Central differences of 1e-5 err by their square and by rounding over them.
    BOOST_TEST((f + slope.transpose()).norm() <= 1e-7 * (1 + f.norm()));
    // As the instants come together it is friction by velocities.
    const double h = 1e-6;
    const Vec near1 = q - h * v;
    const Vec by_velocities = friction_at(system, q, v);
    const BackwardRate rate{q, near1, near1, 1 / h, -1 / h, 0};
    const double taken = damping.secant_friction(rate, v, f).value();
    // Curvature of lengths times h, and rounding over h.
    BOOST_TEST((f - by_velocities).norm() <= 1e-4 * (1 + by_velocities.norm()));
    BOOST_TEST(std::abs(taken + by_velocities.dot(v)) <= 1e-4 * (1 + taken));
  });
  std::mt19937 random(23);
  Problem p = random_network(random, 3, 20, 1.2);
  p.network.anchors.clear();
  for_springs(p.network, [](auto& spring) { spring.law.rest_length += 0.1; });
  const auto system = make_mass_spring(damped(p.network, random, 0));
  const Vec& q = p.initial.q;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  Vec turned(q.size()), f(q.size());
  for (Index i = 0; i < q.size(); i += 3) turned.segment<3>(i) = turn * q.segment<3>(i);
  const Damping& damping = offered(system->damping());
  const double power = damping.secant_friction({turned, q, q, 10, -10, 0}, q, f).value();
  BOOST_TEST(power <= 1e-24);  // of 20 springs whose lengths are rounded: (10 eps)^2
  BOOST_TEST(f.norm() <= 1e-12);
  BOOST_TEST(friction_at(*system, turned, 10 * (turned - q)).norm() > 0.1);
}

BOOST_AUTO_TEST_CASE(damping_in_proportion_to_stiffness_is_known) {
  std::mt19937 random(13);
  Network network = random_network(random, 2, 20, 1.1).network;
  for_springs(network, [](auto& spring) { spring.law.quartic = 0; });
  const auto damping_time = [](const Network& n) {
    return offered(make_mass_spring(n)->damping()).damping_time();
  };
  for_springs(network, [](auto& spring) { spring.law.damping = 3e-4 * spring.law.stiffness; });
  network.air_damping = 0.2;
  const auto system = make_mass_spring(network);
  const Damping& damping = offered(system->damping());
  BOOST_TEST_REQUIRE(damping.damping_time().has_value());
  BOOST_TEST(std::abs(*damping.damping_time() - 3e-4) <= 8 * eps * 3e-4);
  BOOST_TEST(damping.has_dashpots());
  BOOST_TEST(damping.air_damping() == 0.2);
  const Vec q = random_network(random, 2, 20, 1.1).initial.q;
  const Eigen::MatrixXd c = dense(damping_at(*system, q));
  const Eigen::MatrixXd expected = 0.2 * Eigen::MatrixXd(system->mass().asDiagonal()) -
                                   3e-4 * dense(material_stiffness_at(*system, q));
  BOOST_TEST((c - expected).norm() <= 64 * eps * c.norm());

  Network other = network;
  other.links[0].law.damping *= 1 + 1e-10;
  BOOST_TEST(!damping_time(other).has_value());
  other = network;
  other.anchors[0].law.damping = 0;
  BOOST_TEST(!damping_time(other).has_value());
  other = network;
  other.links[0].law.quartic = 1;
  BOOST_TEST(!damping_time(other).has_value());
  for_springs(other, [](auto& spring) { spring.law.damping = 0; });
  BOOST_TEST(damping_time(other).value() == 0);  // air alone
  other.air_damping = 0;
  BOOST_TEST(!make_mass_spring(other)->damping());
  BOOST_TEST(make_mass_spring(other)->is_conservative());
}

BOOST_AUTO_TEST_CASE(c_is_constant_on_a_line_and_without_rest_lengths) {
  std::mt19937 random(17);
  for (const int dimension : {1, 2, 3}) {
    const Network network = damped(random_network(random, dimension, 8, 1.1).network, random, 0);
    const auto is_constant = [](const Network& n) {
      return offered(make_mass_spring(n)->damping()).damping_is_constant();
    };
    BOOST_TEST(is_constant(network) == (dimension == 1));
    BOOST_TEST(is_constant(without_rest_lengths(network)));
  }
}

BOOST_AUTO_TEST_CASE(wrappers_have_the_damping_of_what_they_wrap) {
  std::mt19937 random(19);
  const Problem p = random_network(random, 2, 20, 1.1);
  const Network network = damped(p.network, random, 0.4);
  const Vec v = random_vector(p.initial.q.size(), random);
  const std::shared_ptr<const System> system = make_mass_spring(network);
  std::vector<bool> is_held(static_cast<std::size_t>(system->size()), false);
  is_held[3] = is_held[8] = true;
  const ConstrainedSystem held(system, is_held);
  Vec free_v = v;
  free_v[3] = free_v[8] = 0;
  Vec expected = friction_at(*system, p.initial.q, free_v);
  expected[3] = expected[8] = 0;
  BOOST_TEST((friction_at(held, p.initial.q, free_v) - expected).norm() == 0);
  const Eigen::MatrixXd c = dense(damping_at(held, p.initial.q));
  BOOST_TEST(c.row(3).norm() + c.col(8).norm() == 0);
  BOOST_TEST((c * free_v + expected).norm() <= 64 * eps * c.norm() * v.norm());

  const BlockDiagonalSystem both = in_parts(network, p.network);
  Vec two_q(2 * v.size()), two_v(2 * v.size());
  two_q << p.initial.q, p.initial.q;
  two_v << v, v;
  BOOST_TEST(!both.is_conservative());
  const Vec f = friction_at(both, two_q, two_v);
  BOOST_TEST((f.head(v.size()) - friction_at(*system, p.initial.q, v)).norm() == 0);
  BOOST_TEST(f.tail(v.size()).norm() == 0);
  const Vec near_q = two_q - 1e-6 * two_v;
  const BackwardRate rate{two_q, near_q, near_q, 1e6, -1e6, 0};
  Vec by_lengths(two_q.size());
  BOOST_TEST((offered(both.damping()).secant_friction(rate, two_v, by_lengths).has_value()));
  BOOST_TEST((by_lengths - f).norm() <= 1e-4 * (1 + f.norm()));  // as above
  BOOST_TEST(dense(damping_at(both, two_q)).bottomRightCorner(v.size(), v.size()).norm() == 0);
  BOOST_TEST(!in_parts(p.network, p.network).damping());
}

BOOST_AUTO_TEST_SUITE_END()
