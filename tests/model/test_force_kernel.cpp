#include <algorithm>
#include <limits>
#include <numeric>
#include <omp.h>

#include <boost/test/unit_test.hpp>

#include "qddot/model/kernels/neighbour_slices.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(force_kernel)

using namespace qddot;
using namespace qddot::kernels;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// The size that the rounding of a spring's force is relative to. The force itself is a difference.
double size_of(const SpringLaw& law, double length) {
  const double sum = length + law.rest_length;
  return sum * (law.stiffness + law.quartic * sum * sum);
}

// The largest difference of the two sums, in roundings of all springs of a network whose points are
// at most `extent` apart.
double difference(const Network& network, const Vec& q, double extent) {
  double size = 0;
  for (const auto& link : network.links) size += size_of(link.law, extent);
  for (const auto& link : network.image_links) size += size_of(link.law, extent);
  for (const auto& anchor : network.anchors) size += size_of(anchor.law, extent);
  const Vec plain = force_at(*make_mass_spring(network, Forces::spring_by_spring), q);
  const Vec fast = force_at(*make_mass_spring(network, Forces::by_vectors), q);
  return (plain - fast).lpNorm<Eigen::Infinity>() / (eps * size);
}

// A grid of `nodes` a side, spacing 1 m, springs of 100 N/m along its lines and diagonals whose
// rest lengths differ; its nodes in the order given.
struct Grid {
  Network network;
  Vec q;
};
Grid grid(int dimension, int side, std::vector<int> place) {
  Grid g{{.dimension = dimension, .node_mass = Vec::Ones(side * side)},
         Vec::Zero(dimension * side * side)};
  g.network.uses_constant_stiffness = false;
  const auto join = [&](int i, int j, int i2, int j2) {
    if (i2 >= side || j2 >= side || j2 < 0) return;
    const double rest = 0.8 + 0.01 * ((i * 7 + j * 3) % 11);
    g.network.links.push_back({place[i * side + j], place[i2 * side + j2], {100, rest}});
  };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double x[] = {i + 0.1 * std::sin(j), j + 0.1 * std::cos(3 * i), 0.2 * std::sin(i * j)};
      std::copy_n(x, dimension, g.q.data() + dimension * place[i * side + j]);
      join(i, j, i + 1, j);
      join(i, j, i, j + 1);
      join(i, j, i + 1, j + 1);
      join(i, j, i + 1, j - 1);
    }
  }
  return g;
}

std::vector<int> in_order(int count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  return order;
}
std::vector<int> shuffled(int count) {
  std::vector<int> order = in_order(count);
  std::ranges::shuffle(order, std::mt19937(5));
  return order;
}

std::vector<std::vector<Neighbour>> neighbours_in(const Network& network) {
  std::vector<std::vector<Neighbour>> neighbours(network.node_mass.size());
  for (const auto& link : network.links) {
    neighbours[link.i].push_back({link.j, link.law});
    neighbours[link.j].push_back({link.i, link.law});
  }
  return neighbours;
}

}  // namespace

// Each spring's force has some ten roundings, and the two sums add in different orders.
BOOST_AUTO_TEST_CASE(it_is_the_plain_sum_on_networks_of_all_kinds) {
  std::mt19937 random(3);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.7, 1.3}) {
      for (const int nodes : {1, 2, 7, 8, 9, 40}) {
        const Problem p = random_network(random, dimension, nodes, stretch);
        const double extent = p.initial.q.maxCoeff() - p.initial.q.minCoeff() + 2;
        BOOST_TEST(difference(p.network, p.initial.q, extent) < 1);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_plain_sum_with_images_and_planes) {
  for_random_images([](const ImageSample& s) {
    BOOST_TEST(difference(s.network, s.q, 2 * s.q.lpNorm<Eigen::Infinity>() + 2) < 1);
  });
}

// Node by node: a node of a grid has eight springs of up to 100 N/m times 3 m, of ten roundings
// each.
BOOST_AUTO_TEST_CASE(it_is_the_plain_sum_on_grids_in_any_order_of_their_nodes) {
  for (const int dimension : {2, 3}) {
    for (const int side : {3, 8, 21}) {
      for (const auto& order : {in_order(side * side), shuffled(side * side)}) {
        const Grid g = grid(dimension, side, order);
        const Vec plain = force_at(*make_mass_spring(g.network, Forces::spring_by_spring), g.q);
        const Vec fast = force_at(*make_mass_spring(g.network, Forces::by_vectors), g.q);
        BOOST_TEST((plain - fast).lpNorm<Eigen::Infinity>() < 8 * 300 * 10 * eps);
        BOOST_TEST(plain.lpNorm<Eigen::Infinity>() > 1);
      }
    }
  }
}

// The rounding of an energy is a few roundings of each spring's energy, or eps l^2 k if that is
// less. That of a mean force is that of a force with twice as many operations.
BOOST_AUTO_TEST_CASE(energies_and_mean_forces_are_the_plain_sums_as_well) {
  const auto check = [](const Network& network, const Vec& q) {
    const auto plain = make_mass_spring(network, Forces::spring_by_spring),
               fast = make_mass_spring(network, Forces::by_vectors);
    const double extent = 2 * q.lpNorm<Eigen::Infinity>() + 2;
    double size = 0, energy = std::abs(network.constant_energy);
    const auto add = [&](const SpringLaw& law) {
      size += size_of(law, extent);
      energy += size_of(law, extent) * (extent + law.rest_length);
    };
    for (const auto& link : network.links) add(link.law);
    for (const auto& link : network.image_links) add(link.law);
    for (const auto& anchor : network.anchors) add(anchor.law);
    BOOST_TEST(std::abs(plain->potential(q) - fast->potential(q)) <= 10 * eps * energy);
    const Vec other = q + 0.1 * Vec::LinSpaced(q.size(), 1, 9).array().sin().matrix();
    Vec one(q.size()), two(q.size());
    offered<DiscreteGradient>(*plain).discrete_gradient(q, other, one);
    offered<DiscreteGradient>(*fast).discrete_gradient(q, other, two);
    BOOST_TEST((one - two).lpNorm<Eigen::Infinity>() <= 2 * eps * size);
  };
  std::mt19937 random(7);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.7, 1.3}) {
      for (const int nodes : {1, 2, 7, 8, 9, 40}) {
        const Problem p = random_network(random, dimension, nodes, stretch);
        check(p.network, p.initial.q);
      }
    }
  }
  for_random_images([&](const ImageSample& s) { check(s.network, s.q); });
}

BOOST_AUTO_TEST_CASE(a_spring_of_no_length_pulls_nowhere) {
  for (const int dimension : {1, 2, 3}) {
    for (const double quartic : {0.0, 10.0}) {
      Network network{.dimension = dimension, .node_mass = Vec::Ones(2)};
      network.links = {{0, 1, {100, 0.5, quartic}}};
      const Vec same = Vec::Constant(2 * dimension, 0.3);
      BOOST_TEST(force_at(*make_mass_spring(network, Forces::by_vectors), same).norm() == 0);
    }
  }
}

// A spring whose length is exactly its rest length is without force, as drawn scenes at rest are.
BOOST_AUTO_TEST_CASE(a_spring_at_rest_along_an_axis_has_no_force_at_all) {
  for (const double length : {0.1, 1.0 / 3, 0.7, 1e-3, 123.456}) {
    Network network{.dimension = 3, .node_mass = Vec::Ones(2)};
    network.links = {{0, 1, {1e6, length}}};
    Vec q = Vec::Zero(6);
    q[4] = length;
    BOOST_TEST(force_at(*make_mass_spring(network, Forces::by_vectors), q).norm() == 0);
  }
}

BOOST_AUTO_TEST_CASE(it_is_the_same_to_the_bit_with_any_number_of_threads) {
  const int before = omp_get_max_threads();
  for (const auto& order : {in_order(150 * 150), shuffled(150 * 150)}) {
    const Grid g = grid(3, 150, order);
    const auto system = make_mass_spring(g.network, Forces::by_vectors);
    omp_set_num_threads(1);
    const Vec alone = force_at(*system, g.q);
    for (const int threads : {2, 3, 8}) {
      omp_set_num_threads(threads);
      BOOST_TEST((force_at(*system, g.q).array() == alone.array()).all());
    }
  }
  omp_set_num_threads(before);
}

// Slices, read back row by row, have the neighbours that they were made of.
BOOST_AUTO_TEST_CASE(slices_hold_every_neighbour_once) {
  const Network network = grid(2, 13, shuffled(13 * 13)).network;
  auto neighbours = neighbours_in(network);
  constexpr int lanes = slice_rows;
  const NeighbourSlices slices = slice_neighbours(neighbours, 0);
  BOOST_TEST(slices.law_vectors == 2);
  std::vector<std::vector<std::pair<int, double>>> found(neighbours.size());
  for (int s = 0; s < slices.count(); ++s) {
    const auto &begin = slices.slices[s], &end = slices.slices[s + 1];
    const double* law = slices.laws.data() + begin.law;
    const auto take = [&](const auto& place_of) {
      for (int t = 0; t < lanes; ++t) {
        if (law[t] == 0) continue;
        const int node = slices.node[s * lanes + t];
        BOOST_REQUIRE(node >= 0);
        found[node].emplace_back(slices.node[place_of(t)], law[lanes + t]);
      }
      law += slices.law_vectors * lanes;
    };
    for (int i = begin.shift; i < end.shift; ++i) {
      take([&](int t) { return s * lanes + t + slices.shifts[i]; });
    }
    for (int i = begin.gather; i < end.gather; i += lanes) {
      take([&](int t) { return slices.gathers[i + t]; });
    }
    BOOST_TEST(law == slices.laws.data() + end.law);
  }
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    std::vector<std::pair<int, double>> expected;
    for (const auto& [point, law] : neighbours[i]) expected.emplace_back(point, law.rest_length);
    std::ranges::sort(expected);
    std::ranges::sort(found[i]);
    BOOST_TEST((expected == found[i]));
  }
}

// A grid's slots have one shift, except at the ends of its lines. If its nodes have no order, slots
// gather; rows sorted by their number of springs leave hardly any slot half empty.
BOOST_AUTO_TEST_CASE(slots_of_a_grid_are_of_one_shift_and_no_slot_is_wasted) {
  constexpr int side = 64;
  for (const bool is_grid : {true, false}) {
    const auto order = is_grid ? in_order(side * side) : shuffled(side * side);
    const Network network = grid(3, side, order).network;
    constexpr int lanes = slice_rows;
    const NeighbourSlices slices = slice_neighbours(neighbours_in(network), 0);
    const double slots = static_cast<double>(slices.shifts.size()),
                 gathers = static_cast<double>(slices.gathers.size()) / lanes;
    const double least = 2.0 * static_cast<double>(network.links.size()) / lanes;
    // Two of 64 nodes on each line have neighbours on one side only.
    BOOST_TEST(slots + gathers < 1.05 * least);
    BOOST_TEST((is_grid ? gathers : slots) < 0.05 * least);
  }
}

BOOST_AUTO_TEST_SUITE_END()
