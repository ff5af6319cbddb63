// Systems with unknowns held, and systems of blocks, against the systems in them.
#include <boost/test/unit_test.hpp>

#include "qddot/model/constrained_system.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(wrappers)

using namespace qddot;

namespace {

using Eigen::MatrixXd;

// The values of all functions of a system at q, and of its discrete gradient from q to 1.1 q.
struct Said {
  double v;
  std::vector<Vec> vectors;
  std::vector<MatrixXd> matrices;

  Said(const System& system, const Vec& q) : v(system.potential(q)) {
    vectors = {force_at(system, q), mean_force_between(system, q, 1.1 * q)};
    const auto& parts = offered(system.split_stiffness());
    const auto add = [&](const auto& write) {
      SymmetricMatrix k = system.stiffness_pattern();
      k.coeffs().setConstant(NAN);  // whatever was in it before
      write(k);
      matrices.push_back(dense(k));
    };
    add([&](SymmetricMatrix& k) { system.stiffness(q, k); });
    add([&](SymmetricMatrix& k) { parts.weighted_stiffness(q, 0.5, k); });
    add([&](SymmetricMatrix& k) { parts.material_stiffness(q, k); });
    add([&](SymmetricMatrix& k) { offered(system.laplacian()).assemble_laplacian(k); });
  }
};

// A mass on one spring to the origin, on a line.
Network tied(const SpringLaw& law, Holds holds = Holds::always) {
  Network network{.dimension = 1, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {0, 0, 0}, law, holds}};
  return network;
}

ConstrainedSystem held(const Network& network, std::vector<bool> is_held) {
  return {make_mass_spring(network), std::move(is_held)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(held_unknowns_have_zeros_and_all_else_is_the_systems) {
  std::mt19937 random(21);
  for_networks({1.2, 0.7}, [&](const Network& network, const Vec& q) {
    const auto free = make_mass_spring(network);
    for (const unsigned odds : {3u, 1u, 1000u}) {  // a third, all, hardly any
      std::vector<bool> is_held(static_cast<std::size_t>(q.size()));
      Vec kept(q.size());
      for (Index i = 0; i < q.size(); ++i) {
        is_held[static_cast<std::size_t>(i)] = random() % odds == 0;
        kept[i] = !is_held[static_cast<std::size_t>(i)];
      }
      const MatrixXd s = kept.asDiagonal();
      const ConstrainedSystem system = held(network, is_held);
      const Said inner(*free, q), outer(system, q);
      BOOST_TEST((system.mass() == free->mass()));
      BOOST_TEST(same_pattern(system.stiffness_pattern(), free->stiffness_pattern()));
      BOOST_TEST(outer.v == inner.v);
      for (std::size_t i = 0; i < inner.vectors.size(); ++i)
        BOOST_TEST((outer.vectors[i] == s * inner.vectors[i]));
      for (std::size_t i = 0; i < inner.matrices.size(); ++i)
        BOOST_TEST((outer.matrices[i] == s * inner.matrices[i] * s));
    }
  });
}

// Blocks of other dimensions, some within another, some without unknowns.
BOOST_AUTO_TEST_CASE(blocks_follow_one_another) {
  std::mt19937 random(5);
  const Problem line = random_network(random, 1, 4, 1.3), space = random_network(random, 3, 3, 0.8);
  const ImageSample images = random_images(random, 2, 0.7, true);
  const Network nothing{.dimension = 3, .constant_energy = 64};
  std::vector<std::unique_ptr<System>> blocks;
  blocks.push_back(make_mass_spring(line.network));
  blocks.push_back(
      std::make_unique<BlockDiagonalSystem>(parts_of(space.network, nothing, images.network)));
  blocks.push_back(std::make_unique<BlockDiagonalSystem>(parts_of()));
  const BlockDiagonalSystem whole(std::move(blocks));
  BOOST_TEST(whole.blocks().size() == 3);

  Vec q(whole.size()), mass(whole.size());
  q << line.initial.q, space.initial.q, images.q;
  const Said said(whole, q);
  double v = 64;
  Index at = 0, entries = 0;
  std::vector<MatrixXd> rest = said.matrices;
  for (const Network& network : {line.network, space.network, images.network}) {
    const auto block = make_mass_spring(network);
    const Index n = block->size();
    const Said own(*block, q.segment(at, n));
    v += own.v;
    mass.segment(at, n) = block->mass();
    entries += block->stiffness_pattern().nonZeros();
    const SymmetricMatrix& pattern = whole.stiffness_pattern();
    BOOST_TEST(
        same_pattern(SymmetricMatrix(pattern.block(at, at, n, n)), block->stiffness_pattern()));
    for (std::size_t i = 0; i < own.vectors.size(); ++i)
      BOOST_TEST((said.vectors[i].segment(at, n) == own.vectors[i]));
    for (std::size_t i = 0; i < own.matrices.size(); ++i) {
      BOOST_TEST((said.matrices[i].block(at, at, n, n) == own.matrices[i]));
      rest[i].block(at, at, n, n).setZero();
    }
    at += n;
  }
  BOOST_TEST(at == whole.size());
  BOOST_TEST((whole.mass() == mass));
  // Some 60 terms, summed in another order.
  BOOST_TEST(std::abs(said.v - v) < 60 * eps * (std::abs(v) + 1000));
  for (const MatrixXd& outside : rest) BOOST_TEST(outside.cwiseAbs().maxCoeff() == 0);
  BOOST_TEST(whole.stiffness_pattern().nonZeros() == entries);
  BOOST_TEST(whole.stiffness_pattern().isCompressed());
  BOOST_TEST(whole.stiffness_pattern().coeffs().abs().maxCoeff() == 0);
}

BOOST_AUTO_TEST_CASE(stiffness_is_constant_where_it_is_in_every_system_within) {
  const Network constant = tied({.stiffness = 2}), varying = tied({2, 1});
  BOOST_TEST(in_parts().stiffness_is_constant());
  BOOST_TEST(in_parts(constant, constant).stiffness_is_constant());
  BOOST_TEST(!in_parts(constant, varying).stiffness_is_constant());
  BOOST_TEST(!in_parts(varying, constant).stiffness_is_constant());
  BOOST_TEST(!in_parts(varying, varying).stiffness_is_constant());
  BOOST_TEST(held(constant, {false}).stiffness_is_constant());
  BOOST_TEST(!held(varying, {true}).stiffness_is_constant());
}

BOOST_AUTO_TEST_CASE(it_holds_where_every_system_within_holds) {
  const Network string = tied({1, 1}, Holds::in_tension);
  const BlockDiagonalSystem system = in_parts(string, tied({1, 1}), string);
  BOOST_TEST(is_valid_at(system, Vec{{1.5, 0.1, 1.5}}));
  BOOST_TEST(!is_valid_at(system, Vec{{0.5, 3, 1.5}}));
  BOOST_TEST(!is_valid_at(system, Vec{{1.5, 3, 0.5}}));
  BOOST_TEST(is_valid_at(in_parts(), Vec()));
  BOOST_TEST(is_valid_at(held(string, {false}), Vec{{1.5}}));
  BOOST_TEST(!is_valid_at(held(string, {true}), Vec{{0.5}}));
}

BOOST_AUTO_TEST_CASE(the_laplacian_bounds_the_stiffness_where_each_one_within_does) {
  const Network bounded = tied({2, 1}), quartic = tied({2, 1, 1});
  BOOST_TEST(in_parts(bounded, bounded).bounds_stiffness());
  BOOST_TEST(!in_parts(quartic, bounded).bounds_stiffness());
  BOOST_TEST(held(bounded, {true}).bounds_stiffness());
  BOOST_TEST(!held(quartic, {true}).bounds_stiffness());
}

BOOST_AUTO_TEST_SUITE_END()
