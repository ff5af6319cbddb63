#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(all_images)

using namespace qddot;

namespace {

// All images of the nodes as nodes of their own, with x_full = P q. Image s of node i has the
// number 2^D i + s; bit d of s says that coordinate d is reversed. Mass, load and each spring are
// divided among as many images: P'M_full P is M, P'f_full is f, and V_full is V.
struct Whole {
  explicit Whole(const Network& half)
      : images(1 << half.dimension),
        network{.dimension = half.dimension, .constant_energy = half.constant_energy} {
    const int dimension = half.dimension;
    Index n = 0;
    for (int i = 0; i < image_nodes; ++i) {
      for (int d = 0; d < dimension; ++d) n += is_unknown(half, i, d);
    }
    network.node_mass = Vec(images * image_nodes);
    network.load = Vec(dimension * images * image_nodes);
    p = Eigen::MatrixXd::Zero(dimension * images * image_nodes, n);
    Index unknown = 0;
    for (int i = 0; i < image_nodes; ++i) {
      for (int s = 0; s < images; ++s)
        network.node_mass[images * i + s] = half.node_mass[i] / images;
      for (int d = 0; d < dimension; ++d) {
        const double pull = half.node_mass[i] * half.gravity[d] + half.load[dimension * i + d];
        for (int s = 0; s < images; ++s) {
          const Index row = dimension * (images * i + s) + d;
          network.load[row] = signs(s)[d] * pull / images;
          if (is_unknown(half, i, d)) p(row, unknown) = signs(s)[d];
        }
        unknown += is_unknown(half, i, d);
      }
    }
    const auto share = [&](SpringLaw law) {
      law.stiffness /= images;
      law.quartic /= images;
      return law;
    };
    for (int s = 0; s < images; ++s) {
      for (const auto& [i, j, law, holds, stiff, direction] : half.links) {
        network.links.push_back({images * i + s, images * j + s, share(law), holds});
      }
      for (const auto& [i, j, mirror, law, holds, stiff, direction] : half.image_links) {
        int turned = 0;
        for (int d = 0; d < dimension; ++d) turned |= mirror[d] < 0 ? 1 << d : 0;
        network.links.push_back({images * i + s, images * j + (s ^ turned), share(law), holds});
      }
      for (const auto& [i, point, law, holds, stiff, direction] : half.anchors) {
        network.anchors.push_back(
            {images * i + s, signs(s).cwiseProduct(point), share(law), holds});
      }
    }
  }
  static Eigen::Vector3d signs(int s) {
    return {s & 1 ? -1. : 1., s & 2 ? -1. : 1., s & 4 ? -1. : 1.};
  }

  int images;
  Network network;
  Eigen::MatrixXd p;
};

// Each node's sums have some 60 springs of up to 1e4 N and 1e4 N/m, each term rounded a few times.
constexpr double round_off = 500 * eps;

}  // namespace

BOOST_AUTO_TEST_CASE(the_network_is_the_one_of_all_images_seen_from_one_side) {
  for_random_images([](const ImageSample& s) {
    const Whole whole(s.network);
    const auto system = make_mass_spring(s.network), full = make_mass_spring(whole.network);
    const Eigen::MatrixXd& p = whole.p;
    const Vec x = p * s.q, f = force_at(*system, s.q), f_full = force_at(*full, x);
    const Eigen::MatrixXd k = dense(stiffness_at(*system, s.q));
    const Eigen::MatrixXd mass = p.transpose() * full->mass().asDiagonal() * p;
    const double v = system->potential(s.q), largest = f.cwiseAbs().maxCoeff();
    BOOST_TEST(std::abs(full->potential(x) - v) < round_off * (std::abs(v) + largest));
    // Eight shares of at most 2 kg.
    BOOST_TEST(distance(mass, Eigen::MatrixXd(system->mass().asDiagonal())) < 8 * 2 * eps);
    BOOST_TEST(distance(p.transpose() * f_full, f) < round_off * largest);
    BOOST_TEST(distance(p.transpose() * dense(stiffness_at(*full, x)) * p, k) <
               round_off * k.cwiseAbs().maxCoeff());
    // The images move as images do, unless a node on a plane has images that leave it.
    if (!s.network.zero_coordinates.empty()) return;
    const Vec pushed = p * f.cwiseQuotient(system->mass());
    BOOST_TEST(distance(f_full.cwiseQuotient(full->mass()), pushed) <
               round_off * pushed.cwiseAbs().maxCoeff());
  });
}

BOOST_AUTO_TEST_SUITE_END()
