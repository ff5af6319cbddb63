// Forces, stiffnesses and energies of springs by vectors, against the sums spring by spring.
#include <algorithm>
#include <numeric>
#include <omp.h>
#include <tuple>

#include <boost/test/unit_test.hpp>

#include "qddot/model/kernels/neighbour_slices.hpp"
#include "tests/measure.hpp"
#include "tests/model/grids.hpp"
#include "tests/model/random_images.hpp"

BOOST_AUTO_TEST_SUITE(spring_kernels)

using namespace qddot;
using namespace qddot::kernels;

namespace {

// The size that the rounding of a spring's force is relative to. The force itself is a difference.
double size_of(const SpringLaw& law, double length) {
  const double sum = length + law.rest_length;
  return sum * (law.stiffness + law.quartic * sum * sum);
}

// The entries that write(parts, K) writes.
template <class Write>
Vec entries(const System& system, const Write& write) {
  SymmetricMatrix k = system.stiffness_pattern();
  k.coeffs().setConstant(NAN);  // every one must be written
  write(offered(system.split_stiffness()), k);
  return k.coeffs();
}
Vec weighted(const System& system, const Vec& q, double compression) {
  return entries(system, [&](const SplitStiffness& parts, SymmetricMatrix& k) {
    parts.weighted_stiffness(q, compression, k);
  });
}
Vec material(const System& system, const Vec& q) {
  return entries(system, [&](const SplitStiffness& parts, SymmetricMatrix& k) {
    parts.material_stiffness(q, k);
  });
}

// Each spring's force has some ten roundings, and the two sums add in different orders. A mean
// force has twice as many. An energy has a few roundings of each spring's energy, or eps l^2 k if
// that is less. tau/l of a spring at least 0.3 m long is rounded ten times in proportion to
// (l + l0)/l <= 10.
void check_against_plain(const Network& network, const Vec& q) {
  const auto plain = make_mass_spring(network, Forces::spring_by_spring),
             fast = make_mass_spring(network, Forces::by_vectors);
  // Points are at most so far apart.
  const double width =
      network.image_links.empty() ? q.maxCoeff() - q.minCoeff() : 2 * q.lpNorm<Eigen::Infinity>();
  const double extent = width + 2;
  const double size =
      sum_of_springs(network, [&](const SpringLaw& law) { return size_of(law, extent); });
  BOOST_TEST(distance(force_at(*plain, q), force_at(*fast, q)) < eps * size);
  const Vec other = q + 0.1 * Vec::LinSpaced(q.size(), 1, 9).array().sin().matrix();
  BOOST_TEST(distance(mean_force_between(*plain, q, other), mean_force_between(*fast, q, other)) <=
             2 * eps * size);

  const double energy = sum_of_springs(network, [&](const SpringLaw& law) {
    return size_of(law, extent) * (extent + law.rest_length);
  });
  BOOST_TEST(std::abs(plain->potential(q) - fast->potential(q)) <=
             10 * eps * (energy + std::abs(network.constant_energy)));

  const double stiffest = sum_of_springs(network, [&](const SpringLaw& law) {
    return law.stiffness + 3 * law.quartic * std::pow(extent - 1 + law.rest_length, 2);
  });
  for (const double compression : {1.0, 0.3, 0.0}) {
    BOOST_TEST(distance(weighted(*plain, q, compression), weighted(*fast, q, compression)) <=
               100 * eps * stiffest);
  }
  BOOST_TEST(distance(material(*plain, q), material(*fast, q)) <= 100 * eps * stiffest);
}

Neighbours neighbours_in(const Network& network) {
  return neighbours_of(static_cast<int>(network.node_mass.size()), [&](const auto& see) {
    for (const auto& link : network.links) {
      see(link.i, link.j, link.law.plain());
      see(link.j, link.i, link.law.plain());
    }
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(they_are_the_plain_sums_on_networks_of_all_kinds) {
  std::mt19937 random(3);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.7, 1.3}) {
      for (const int nodes : {1, 2, 7, 8, 9, 40}) {
        const Problem p = random_network(random, dimension, nodes, stretch);
        check_against_plain(p.network, p.initial.q);
      }
    }
  }
  for_networks({1.4, 0.7}, check_against_plain);
}

// Node by node: a node of a grid has eight springs of up to 100 N/m times 3 m, of ten roundings
// each.
BOOST_AUTO_TEST_CASE(they_are_the_plain_sums_on_grids_in_any_order_of_their_nodes) {
  for (const int dimension : {2, 3}) {
    for (const int side : {3, 8, 21}) {
      for (const auto& order : {in_order(side * side), shuffled(side * side)}) {
        const Grid g = grid(dimension, side, order);
        const Vec plain = force_at(*make_mass_spring(g.network, Forces::spring_by_spring), g.q);
        const Vec fast = force_at(*make_mass_spring(g.network, Forces::by_vectors), g.q);
        BOOST_TEST(distance(plain, fast) < 8 * 300 * 10 * eps);
        BOOST_TEST(plain.lpNorm<Eigen::Infinity>() > 1);
        check_against_plain(g.network, g.q);
      }
    }
  }
}

// It pulls nowhere and, as in spring.hpp, is stiff as along it in every direction.
BOOST_AUTO_TEST_CASE(a_spring_of_no_length_has_no_direction) {
  for (const int dimension : {1, 2, 3}) {
    for (const double quartic : {0.0, 10.0}) {
      for (const double rest : {0.0, 0.5}) {
        Network network{.dimension = dimension, .node_mass = Vec::Ones(2)};
        network.links = {{0, 1, {100, rest, quartic}}};
        const Vec same = Vec::Constant(2 * dimension, 0.3);
        BOOST_TEST(force_at(*make_mass_spring(network, Forces::by_vectors), same).norm() == 0);
        check_against_plain(network, same);
      }
    }
  }
}

// Every other slice has no springs.
BOOST_AUTO_TEST_CASE(nodes_without_springs_are_not_pulled) {
  for (const int dimension : {2, 3}) {
    constexpr int nodes = 12 * 2 * slice_rows;
    Network network{.dimension = dimension, .node_mass = Vec::Ones(nodes)};
    for (int i = 0; i + 2 * slice_rows < nodes; ++i) {
      if (i / slice_rows % 2 == 0) network.links.push_back({i, i + 2 * slice_rows, {100, 0.5}});
    }
    check_against_plain(network, Vec::LinSpaced(dimension * nodes, 0, 40));
  }
}

// Weights are read for one slice alone if they are the same for all nodes, and node by node if one
// differs. Its force is its weight where no spring pulls.
BOOST_AUTO_TEST_CASE(every_node_has_its_own_weight) {
  for (const int dimension : {2, 3}) {
    for (const Index heavy : {-1, 0, 70, 440}) {
      Grid g = grid(dimension, 21, in_order(21 * 21));
      g.network.gravity = {1, -2, 3};
      if (heavy >= 0) g.network.node_mass[heavy] = 5;
      check_against_plain(g.network, g.q);
      for (auto& link : g.network.links) link.law = {.stiffness = 0};
      const Vec f = force_at(*make_mass_spring(g.network, Forces::by_vectors), g.q);
      for (Index i = 0; i < f.size(); ++i) {
        BOOST_TEST(f[i] == g.network.node_mass[i / dimension] * g.network.gravity[i % dimension]);
      }
    }
  }
}

// Weights repeat after D unknowns here, too, but they begin with the second axis.
BOOST_AUTO_TEST_CASE(a_node_with_fewer_unknowns_shifts_no_weights) {
  for (const int dimension : {2, 3}) {
    Grid g = grid(dimension, 21, in_order(21 * 21));
    g.network.gravity = {1, -2, 3};
    g.network.zero_coordinates.assign(21 * 21, 0);
    g.network.zero_coordinates[0] = 1;
    g.q[0] = 0;
    check_against_plain(g.network, g.q.tail(g.q.size() - 1));
    for (auto& link : g.network.links) link.law = {.stiffness = 0};
    const Vec f =
        force_at(*make_mass_spring(g.network, Forces::by_vectors), Vec(g.q.tail(g.q.size() - 1)));
    for (Index i = 0; i < f.size(); ++i) {
      BOOST_TEST(f[i] == g.network.gravity[(i + 1) % dimension]);
    }
  }
}

// Dashpots beside the springs, also where a spring has no length in the midst of a grid: there its
// dashpot resists in all directions.
BOOST_AUTO_TEST_CASE(damped_forces_are_the_plain_sums_on_grids) {
  for (const int dimension : {2, 3}) {
    for (const auto& order : {in_order(21 * 21), shuffled(21 * 21)}) {
      for (const bool folds : {false, true}) {
        for (const double quartic : {0.0, 10.0}) {
          Grid g = grid(dimension, 21, order);
          for (std::size_t e = 0; e < g.network.links.size(); ++e) {
            g.network.links[e].law.damping = static_cast<double>(e % 3);
            g.network.links[e].law.quartic = quartic;
          }
          const auto& link = g.network.links[g.network.links.size() / 2 + 1];
          if (folds) {
            g.q.segment(dimension * link.j, dimension) = g.q.segment(dimension * link.i, dimension);
          }
          const Vec v = 3 * (7 * g.q).array().sin();
          const auto plain = make_mass_spring(g.network, Forces::spring_by_spring),
                     fast = make_mass_spring(g.network, Forces::by_vectors);
          Vec f(v.size()), friction = f, expected_f = f, expected = f;
          BOOST_TEST(
              (offered(fast->damping()).damped_force({0, g.q, v}, f, friction, nullptr) == 0.0));
          plain->force({0, g.q, v}, expected_f);
          offered(plain->damping()).friction({0, g.q, v}, expected);
          // Eight springs of 3 m: 100 N/m and 90 N, and dashpots of 2 N s/m and 10 m/s, or of 20
          // m/s where the spring is shorter.
          BOOST_TEST(distance(friction, expected) < 8 * 40 * 10 * eps);
          BOOST_TEST(distance(f, expected_f) < 8 * (340 + 40 * quartic) * 10 * eps);
          BOOST_TEST(expected.lpNorm<Eigen::Infinity>() > 1);
          const double around = friction.segment(dimension * link.i, dimension).norm();
          BOOST_TEST(around > 0);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(they_are_the_same_to_the_bit_with_any_number_of_threads) {
  const int before = omp_get_max_threads();
  for (const auto& order : {in_order(150 * 150), shuffled(150 * 150)}) {
    const Grid g = grid(3, 150, order);
    const auto system = make_mass_spring(g.network, Forces::by_vectors);
    omp_set_num_threads(1);
    const Vec alone = force_at(*system, g.q), stiffness = weighted(*system, g.q, 0.5);
    for (const int threads : {2, 3, 8}) {
      omp_set_num_threads(threads);
      BOOST_TEST((force_at(*system, g.q) == alone));
      BOOST_TEST((weighted(*system, g.q, 0.5) == stiffness));
    }
  }
  omp_set_num_threads(before);
}

// Ends of springs, as (node, point, k, l0), of nodes and of slots: grids whose lines end or whose
// nodes miss springs here and there, which share plans of slots and numbers of laws, and a mesh.
BOOST_AUTO_TEST_CASE(slots_hold_every_spring_once_from_each_end) {
  std::mt19937 random(7);
  using End = std::tuple<int, int, double, double>;
  for (const auto& order : {in_order(40 * 40), shuffled(40 * 40)}) {
    for (const int missing : {0, 1, 5, 300}) {
      Network network = grid(3, 40, order).network;
      for (int i = 0; i < missing; ++i) {
        network.links.erase(network.links.begin() +
                            static_cast<Index>(random() % network.links.size()));
      }
      for (std::size_t e = 0; e < network.links.size(); e += 7) network.links[e].law = {50, 1, 0};
      const Neighbours neighbours = neighbours_in(network);
      std::vector<End> expected, listed, found;
      for (const auto& link : network.links) {
        expected.emplace_back(link.i, link.j, link.law.stiffness, link.law.rest_length);
        expected.emplace_back(link.j, link.i, link.law.stiffness, link.law.rest_length);
      }
      for (int i = 0; i < neighbours.nodes(); ++i) {
        for (int e = neighbours.first[i]; e < neighbours.first[i + 1]; ++e) {
          const PlainLaw& law = neighbours.laws[neighbours.ends[e].law];
          listed.emplace_back(i, neighbours.ends[e].point, law.stiffness, law.rest_length);
        }
      }
      const NeighbourSlices slices = slice_neighbours(neighbours, 0);
      for (int slice = 0; slice < slices.count(); ++slice) {
        const Slice begin = slices.slices[slice], end = slices.slices[slice + 1];
        const SlotLaw* law = slices.slot_laws.data() + begin.slot();
        const auto take = [&](const auto& place_of) {
          for (int t = 0; t < slice_rows; ++t) {
            const double stiffness = slices.laws[law->stiffness + t];
            if (stiffness == 0) continue;
            found.emplace_back(slices.node[slice * slice_rows + t], slices.node[place_of(t)],
                               stiffness, slices.laws[law->rest_length + t]);
          }
          ++law;
        };
        for (int s = begin.shift; s < end.shift; ++s) {
          take([&](int t) { return slice * slice_rows + t + slices.shifts[s]; });
        }
        for (int s = begin.gather; s < end.gather; s += slice_rows) {
          take([&](int t) { return slices.gathers[s + t]; });
        }
        BOOST_TEST((law == slices.slot_laws.data() + end.slot()));
      }
      for (auto* ends : {&expected, &listed, &found}) std::ranges::sort(*ends);
      BOOST_TEST((listed == expected));
      BOOST_TEST((found == expected));
    }
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
    BOOST_TEST(slices.law_vectors == 2);  // no spring has a quartic part
    // Two of 64 nodes on each line have neighbours on one side only.
    BOOST_TEST(slots + gathers < 1.05 * least);
    BOOST_TEST((is_grid ? gathers : slots) < 0.05 * least);
  }
}

BOOST_AUTO_TEST_SUITE_END()
