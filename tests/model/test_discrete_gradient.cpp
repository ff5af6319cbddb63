#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(discrete_gradient)

using namespace qddot;

namespace {

Vec discrete_gradient_at(const System& system, const Vec& a, const Vec& b) {
  Vec f(system.size());
  offered<DiscreteGradient>(system).discrete_gradient(a, b, f);
  return f;
}

Vec random_vector(std::mt19937& random, Index n, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return Vec::NullaryExpr(n, [&] { return uniform(random); });
}

// |f.(b - a) + V(b) - V(a)| in units of its rounding: of V, sums of some 50 terms.
double work_error(const System& system, const Vec& a, const Vec& b) {
  const double va = system.potential(a), vb = system.potential(b);
  const double work = discrete_gradient_at(system, a, b).dot(b - a);
  return std::abs(work + vb - va) / (50 * eps * (std::abs(va) + std::abs(vb) + std::abs(work)));
}

// Checks systems of all kinds: links, images, nodes on mirrors, quartic springs, in each dimension.
template <class Check>
void for_systems(const Check& check) {
  std::mt19937 random(31);
  for_networks({0.7, 1.3}, [&](const Network& network, const Vec& q) {
    check(*make_mass_spring(network), q, random);
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(its_work_is_exactly_what_the_potential_loses_however_far_the_way) {
  for_systems([](const System& system, const Vec& a, std::mt19937& random) {
    for (const double size : {1e-6, 0.1, 3.0}) {
      const Vec b = a + random_vector(random, a.size(), size);
      BOOST_TEST(work_error(system, a, b) < 1);
    }
  });
}

BOOST_AUTO_TEST_CASE(it_is_the_force_where_both_ends_are_one_and_the_same_in_both_directions) {
  for_systems([](const System& system, const Vec& a, std::mt19937& random) {
    const double scale = force_at(system, a).lpNorm<Eigen::Infinity>();
    BOOST_TEST(distance(discrete_gradient_at(system, a, a), force_at(system, a)) <
               50 * eps * scale);
    const Vec b = a + random_vector(random, a.size(), 0.3);
    BOOST_TEST(distance(discrete_gradient_at(system, a, b), discrete_gradient_at(system, b, a)) <
               50 * eps * discrete_gradient_at(system, a, b).lpNorm<Eigen::Infinity>());
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
    const Vec f = discrete_gradient_at(*system, a, b);
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
