#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(discrete_gradient)

using namespace qddot;

namespace {

Vec random_vector(std::mt19937& random, Index n, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return Vec::NullaryExpr(n, [&] { return uniform(random); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(its_work_is_exactly_what_the_potential_loses_however_far_the_way) {
  std::mt19937 random(31);
  for_networks({0.7, 1.3}, [&](const Network& network, const Vec& a) {
    const auto system = make_mass_spring(network);
    for (const double size : {1e-6, 0.1, 3.0}) {
      const Vec b = a + random_vector(random, a.size(), size);
      const double va = system->potential(a), vb = system->potential(b);
      const double work = mean_force_between(*system, a, b).dot(b - a);
      // V is a sum of some 50 terms, each rounded.
      BOOST_TEST(std::abs(work + vb - va) <
                 50 * eps * (std::abs(va) + std::abs(vb) + std::abs(work)));
    }
  });
}

BOOST_AUTO_TEST_CASE(it_is_the_force_where_both_ends_are_one_and_the_same_in_both_directions) {
  std::mt19937 random(31);
  for_networks({0.7, 1.3}, [&](const Network& network, const Vec& a) {
    const auto own = make_mass_spring(network);
    const System& system = *own;
    const double scale = force_at(system, a).lpNorm<Eigen::Infinity>();
    BOOST_TEST(distance(mean_force_between(system, a, a), force_at(system, a)) < 50 * eps * scale);
    const Vec b = a + random_vector(random, a.size(), 0.3);
    BOOST_TEST(distance(mean_force_between(system, a, b), mean_force_between(system, b, a)) <
               50 * eps * mean_force_between(system, a, b).lpNorm<Eigen::Infinity>());
  });
}

BOOST_AUTO_TEST_CASE(without_pins_it_has_no_sum_and_no_moment_about_the_way_s_middle) {
  std::mt19937 random(32);
  for (int sample = 0; sample < 5; ++sample) {
    Problem p = random_network(random, 3, 6, 1.2);
    p.network.anchors.clear();
    p.network.gravity.setZero();
    const auto system = make_mass_spring(p.network);
    const Vec a = p.initial.q, b = a + random_vector(random, a.size(), 0.5);
    const Vec f = mean_force_between(*system, a, b);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = sum;
    for (Index i = 0; i < a.size(); i += 3) {
      sum += f.segment<3>(i);
      moment += ((a + b) / 2).segment<3>(i).head<3>().cross(f.segment<3>(i).head<3>());
    }
    const double scale = f.lpNorm<1>();
    BOOST_TEST(sum.norm() < 50 * eps * scale);
    BOOST_TEST(moment.norm() < 50 * eps * scale * a.lpNorm<Eigen::Infinity>());
  }
}

BOOST_AUTO_TEST_SUITE_END()
