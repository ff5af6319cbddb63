// K is made of what the first question for it leaves behind. Whoever asks first, and how many at
// once, it is the same.
#include <barrier>
#include <functional>
#include <thread>

#include <boost/test/unit_test.hpp>

#include "qddot/model/constrained_system.hpp"
#include "tests/measure.hpp"
#include "tests/model/random_images.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(late_stiffness)

using namespace qddot;

namespace {

// A network with links, some of them between the same nodes, image links, and nodes with fewer
// coordinates.
Problem tangled(int dimension, int nodes) {
  std::mt19937 random(static_cast<unsigned>(31 * dimension + nodes));
  Problem p = random_network(random, dimension, nodes, 1.1);
  for (std::size_t e = 0; e < 5; ++e) p.network.links.push_back(p.network.links[e]);
  return p;
}

using Ask = std::function<std::vector<double>(const System&, const Vec&)>;

std::vector<double> numbers(const Vec& x) { return {x.begin(), x.end()}; }

// All that K's parts answer.
std::vector<Ask> questions() {
  const auto matrix = [](const auto& write) {
    return [write](const System& system, const Vec& q) {
      SymmetricMatrix k = system.stiffness_pattern();
      write(system, q, k);
      return numbers(k.coeffs().matrix());
    };
  };
  return {
      matrix([](const System& s, const Vec& q, SymmetricMatrix& k) { s.stiffness(q, k); }),
      matrix([](const System& s, const Vec& q, SymmetricMatrix& k) {
        s.split_stiffness()->material_stiffness(q, k);
      }),
      matrix([](const System& s, const Vec&, SymmetricMatrix& k) {
        s.laplacian()->assemble_laplacian(k);
      }),
      [](const System& s, const Vec& q) { return std::vector{s.potential(q)}; },
      [](const System& s, const Vec& q) {
        Vec f(q.size());
        s.force(q, f);
        return numbers(f);
      },
      [](const System& s, const Vec& q) {
        std::vector<double> lengths;
        if (!s.kinks()) return lengths;
        Vec all(s.kinks()->kink_count());
        s.kinks()->kink_lengths(q, all);
        return numbers(all);
      },
  };
}

std::unique_ptr<System> make(const Problem& p, int kind) {
  if (kind == 0) return make_mass_spring(p.network);
  if (kind == 1) {
    std::vector<bool> is_held(static_cast<std::size_t>(p.initial.q.size()), false);
    for (std::size_t i = 0; i < is_held.size(); i += 3) is_held[i] = true;
    return std::make_unique<ConstrainedSystem>(make_mass_spring(p.network), is_held);
  }
  return std::make_unique<BlockDiagonalSystem>(parts_of(p.network, p.network));
}

}  // namespace

BOOST_AUTO_TEST_CASE(several_threads_that_ask_at_once_get_what_one_gets) {
  const std::vector<Ask> all = questions();
  constexpr int threads = 8;
  for (const int dimension : {1, 2, 3}) {
    for (const int nodes : {6, 40}) {  // by a loop over springs, and by vectors
      const Problem p = tangled(dimension, nodes);
      for (const int kind : {0, 1, 2}) {
        Vec q = p.initial.q;
        if (kind == 2) q = q.replicate(2, 1).eval();
        const auto known = make(p, kind);
        std::vector<std::vector<double>> expected;
        for (const Ask& ask : all) expected.push_back(ask(*known, q));
        for (int round = 0; round < 10; ++round) {
          const auto fresh = make(p, kind);
          BOOST_TEST(fresh->has_stiffness());
          std::vector<std::vector<std::vector<double>>> found(threads);
          std::barrier start(threads);
          std::vector<std::jthread> running;
          for (std::size_t t = 0; t < threads; ++t) {
            running.emplace_back([&, t] {
              found[t].resize(all.size());
              start.arrive_and_wait();
              // Each begins with another question.
              for (std::size_t i = 0; i < all.size(); ++i) {
                const std::size_t which = (i + t) % all.size();
                found[t][which] = all[which](*fresh, q);
              }
            });
          }
          running.clear();
          for (const auto& own : found) BOOST_TEST((own == expected));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(forces_and_energies_stay_the_same_when_k_is_made) {
  for (const int nodes : {6, 40}) {
    const Problem p = tangled(3, nodes);
    const auto system = make(p, 0);
    const auto said = [&] {
      Vec f(p.initial.q.size());
      system->force(p.initial.q, f);
      return std::pair(numbers(f), system->potential(p.initial.q));
    };
    const auto before = said();
    BOOST_TEST(system->stiffness_pattern().nonZeros() > 0);
    BOOST_TEST((said() == before));
  }
}

namespace {

Eigen::MatrixXd whole_k(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  return dense(k);
}

void check_products(const System& system, const Vec& q) {
  const Vec x = Vec::Random(q.size());
  Vec y = Vec::Constant(q.size(), NAN);
  BOOST_TEST_REQUIRE(system.multiply_stiffness(q, x, y));
  const Eigen::MatrixXd k = whole_k(system, q);
  // Sums of some products in another order. Blocks of opposite signs may cancel in K.
  const double size = k.cwiseAbs().rowwise().sum().maxCoeff();
  BOOST_TEST((k * x - y).lpNorm<Eigen::Infinity>() <= 50 * eps * size);
  // More of them where springs join the same nodes, or coordinates are no unknowns.
  BOOST_TEST(system.stiffness_entries() >= system.stiffness_pattern().nonZeros());
}

}  // namespace

BOOST_AUTO_TEST_CASE(row_sums_are_bounded_without_k) {
  for (const int dimension : {1, 2, 3}) {
    for (const int nodes : {6, 40}) {
      const Problem p = tangled(dimension, nodes);
      for (const int kind : {0, 1, 2}) {
        Vec q = p.initial.q, bounds;
        if (kind == 2) q = q.replicate(2, 1).eval();
        const auto system = make(p, kind);
        const bool has_bounds = nodes > 16;  // fewer have K at once
        BOOST_TEST_REQUIRE(system->bound_row_sums(q, bounds) == has_bounds);
        if (!has_bounds) continue;
        const Vec sums = whole_k(*system, q).cwiseAbs().rowwise().sum();
        BOOST_TEST(bounds.size() == sums.size());
        // Sums of a few positive numbers.
        BOOST_TEST((sums.array() <= (1 + 1e-14) * bounds.array()).all());
        // A block's row is at most as long as its diagonal entry times the root of three, so that
        // little is lost where no spring is compressed.
        if (kind != 1) BOOST_TEST((bounds.array() <= 4 * sums.array()).all());
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(products_without_k_are_those_with_k) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = tangled(dimension, 40);
    for (const int kind : {0, 1, 2}) {
      Vec q = p.initial.q;
      if (kind == 2) q = q.replicate(2, 1).eval();
      check_products(*make(p, kind), q);
    }
    std::mt19937 random(static_cast<unsigned>(dimension));
    for (const double stretch : {1.2, 0.7}) {  // taut and compressed
      for (const bool on_planes : {false, true}) {
        if (on_planes && dimension < 3) continue;
        const ImageSample s = random_images(random, dimension, stretch, on_planes);
        check_products(*make_mass_spring(s.network, Forces::by_vectors), s.q);
      }
    }
  }
  // Two nodes in one place: there B is the tangent in all directions, as in spring.hpp.
  Network joined{.dimension = 3, .node_mass = Vec::Ones(20)};
  for (int i = 1; i < 20; ++i)
    joined.links.push_back({i - 1, i, {.stiffness = 3, .rest_length = i % 2 * 0.5}});
  Vec q = Vec::LinSpaced(60, 0, 2);
  q.segment(3, 3) = q.head(3);
  check_products(*make_mass_spring(joined), q);
}

BOOST_AUTO_TEST_SUITE_END()
