// Work beside a force, part by part of the unknowns: it is done once for each unknown, q is made
// before it is read, and the force has the same bits.
#include <omp.h>
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/model/beside_force.hpp"
#include "qddot/model/capabilities.hpp"
#include "qddot/model/vector_updates.hpp"
#include "tests/measure.hpp"
#include "tests/model/grids.hpp"

BOOST_AUTO_TEST_SUITE(beside_force)

using namespace qddot;

namespace {

// Makes q out of another vector, and v if there is one, and keeps f as it is when it is called
// written.
class Copies final : public BesideForce {
 public:
  Copies(const Vec& from, Vec& q, const Vec& f, const Vec& v_from = {}, Vec* v = nullptr)
      : from_(from),
        v_from_(v_from),
        v_(v),
        q_(q),
        f_(f),
        seen_f_(Vec::Constant(f.size(), NAN)),
        made_(Eigen::VectorXi::Zero(q.size())),
        seen_(made_) {}

  void before(Index first, Index end) override {
    q_.segment(first, end - first) = from_.segment(first, end - first);
    if (v_) v_->segment(first, end - first) = v_from_.segment(first, end - first);
    made_.segment(first, end - first).array() += 1;
  }
  double after(Index first, Index end) override {
    seen_f_.segment(first, end - first) = f_.segment(first, end - first);
    seen_.segment(first, end - first) += made_.segment(first, end - first);
    return squared_norm(f_.segment(first, end - first));
  }

  const Vec& seen_f() const { return seen_f_; }
  bool saw_each_once() const { return (made_.array() == 1).all() && (seen_.array() == 1).all(); }

 private:
  const Vec& from_;
  const Vec v_from_;
  Vec* v_;
  Vec& q_;
  const Vec& f_;
  Vec seen_f_;
  Eigen::VectorXi made_, seen_;
};

void check_beside(const System& system, const Vec& q) {
  const int threads_before = omp_get_max_threads();
  omp_set_num_threads(1);
  const Vec expected = force_at(system, q);
  double sum = NAN;
  for (const int threads : {1, 2, 3, 8, 50}) {
    omp_set_num_threads(threads);
    // So no thread finds what it must make where it left it before.
    force_at(system, Vec(-2 * q));
    Vec made = Vec::Constant(q.size(), NAN), f = made;
    Copies copies(q, made, f);
    const double total = system.force_beside({0, made}, f, copies);
    BOOST_TEST((f == expected));
    BOOST_TEST((copies.seen_f() == expected));
    BOOST_TEST(copies.saw_each_once());
    if (threads == 1) sum = total;
    BOOST_TEST(total == sum);
    BOOST_TEST(total == expected.squaredNorm(), boost::test_tools::tolerance(1e-12));  // 1e5 sums
  }
  omp_set_num_threads(threads_before);
}

// The same with dashpots, whose velocities are made beside the force too.
void check_damped_beside(Network network, const Vec& q) {
  int dashpots = 0;
  for (auto& link : network.links) link.law.damping = 0.3 * (++dashpots % 4);
  for (auto& link : network.image_links) link.law.damping = 0.3 * (++dashpots % 4);
  for (auto& anchor : network.anchors) anchor.law.damping = 0.3 * (++dashpots % 4);
  const auto system = make_mass_spring(network, Forces::by_vectors);
  const Damping& damping = offered(system->damping());
  const Vec v = q.array().cos();
  const int threads_before = omp_get_max_threads();
  omp_set_num_threads(1);
  Vec friction = Vec::Constant(q.size(), NAN), f = friction, expected_f = f, expected = f;
  BOOST_TEST_REQUIRE(damping.damped_force({0, q, v}, expected_f, expected, nullptr).has_value());
  // A dozen springs a node of up to 4 N/m, 0.6 N s/m, 2 m and 1 m/s, each with a few roundings.
  damping.friction({0, q, v}, friction);
  BOOST_TEST((friction - expected).lpNorm<Eigen::Infinity>() <= 12 * 2 * 0.6 * 8 * eps);
  f = force_at(*system, q) + friction;
  const double size = 12 * (100 + 4) * 2;
  BOOST_TEST((f - expected_f).lpNorm<Eigen::Infinity>() <= size * 8 * eps);
  for (const int threads : {1, 2, 3, 8, 50}) {
    omp_set_num_threads(threads);
    // So no thread finds what it must make where it left it before.
    damping.damped_force({0, Vec(-2 * q), Vec(3 * v)}, f, friction, nullptr);
    Vec made = Vec::Constant(q.size(), NAN), made_v = made;
    f = friction = made;
    Copies copies(q, made, f, v, &made_v);
    const auto sum = damping.damped_force({0, made, made_v}, f, friction, &copies);
    BOOST_TEST_REQUIRE(sum.has_value());
    BOOST_TEST((f == expected_f));
    BOOST_TEST((friction == expected));
    BOOST_TEST((copies.seen_f() == expected_f));
    BOOST_TEST(copies.saw_each_once());
    BOOST_TEST(*sum == f.squaredNorm(), boost::test_tools::tolerance(1e-12));  // 1e5 sums
  }
  omp_set_num_threads(threads_before);
}

// Nodes in a row with springs to some of the next `reach` nodes and, here and there, to any other,
// to fixed points and to images of all nodes in its neighbourhood.
Network random_strip(std::mt19937& random, int dimension, int nodes, int reach, int far, int images,
                     int anchors) {
  const auto number = [&](int low, int high) {
    return std::uniform_int_distribution(low, high)(random);
  };
  const auto law = [&] {
    return SpringLaw{.stiffness = 1.0 + number(0, 3), .rest_length = 0.1 * number(0, 3)};
  };
  Network network{.dimension = dimension};
  network.gravity = {1, -2, 3};
  network.node_mass = Vec::LinSpaced(nodes, 1, 2);
  const auto link = [&](int i, int j) {
    if (i != j && j < nodes) network.links.push_back({i, j, law()});
  };
  for (int i = 0; i < nodes; ++i) {
    if (far == 0) link(i, i + 1);
    link(i, i + number(2, reach));
    // Without lines, rows are sorted by number of springs.
    for (int e = 0; i % 13 == 0 && e < 12; ++e) link(i, i + number(1, reach));
  }
  for (int i = 0; i < far; ++i) link(number(0, nodes - 1), number(0, nodes - 1));
  for (int i = 0; i < images; ++i) {
    const int a = number(0, nodes - 1), b = std::min(nodes - 1, a + number(0, reach));
    Eigen::Vector3d mirror = Eigen::Vector3d::Ones();
    mirror[number(0, dimension - 1)] = -1;
    network.image_links.push_back({a, b, mirror, law()});
  }
  for (int i = 0; i < anchors; ++i) {
    network.anchors.push_back({number(0, nodes - 1), Eigen::Vector3d::Constant(i % 3), law()});
  }
  return network;
}

}  // namespace

// Forces are summed in parts from 4,096 nodes on, and in several threads from some more on.
BOOST_AUTO_TEST_CASE(parts_are_made_before_they_are_read) {
  std::mt19937 random(5);
  for (const int dimension : {1, 2, 3}) {
    for (const int nodes : {20, 4095, 4097, 30011}) {
      for (const int kind : {0, 1, 2, 3}) {
        Network network = random_strip(random, dimension, nodes, kind == 2 ? 900 : 20,
                                       kind == 1 ? 5 : 0, kind == 3 ? 300 : 0, kind * 4);
        if (kind == 2) {
          network.zero_coordinates.assign(static_cast<std::size_t>(nodes), 0);
          network.zero_coordinates[static_cast<std::size_t>(nodes / 2)] = 1;
        }
        const auto system = make_mass_spring(network, Forces::by_vectors);
        Vec q(system->size());
        for (double& x : q) x = std::uniform_real_distribution(-1.0, 1.0)(random);
        check_beside(*system, q);
        check_damped_beside(network, q);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(rings_go_on_from_part_to_part) {
  for (const auto& order : {in_order(150 * 150), shuffled(150 * 150)}) {
    const Grid g = grid(3, 150, order);
    check_beside(*make_mass_spring(g.network, Forces::by_vectors), g.q);
    check_damped_beside(g.network, g.q);
  }
}

BOOST_AUTO_TEST_CASE(other_systems_do_it_before_and_after) {
  const Grid g = grid(3, 12, in_order(12 * 12));
  check_beside(*make_mass_spring(g.network, Forces::spring_by_spring), g.q);
}

BOOST_AUTO_TEST_SUITE_END()
