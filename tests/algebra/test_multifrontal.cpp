#include <algorithm>
#include <omp.h>

#include <boost/test/unit_test.hpp>

#include "qddot/algebra/factors.hpp"
#include "qddot/algebra/multifrontal/fronts.hpp"
#include "qddot/algebra/symbolic_factorization.hpp"
#include "tests/algebra/matrices.hpp"

BOOST_AUTO_TEST_SUITE(multifrontal)

using namespace qddot;
using qddot::multifrontal::Branch, qddot::multifrontal::Entry, qddot::multifrontal::Front,
    qddot::multifrontal::Fronts, qddot::multifrontal::strip_height;

namespace {

// D - K with the entries of K at the given places below the diagonal, dominated by a diagonal of
// either sign. Eliminating a pivot keeps it so: no entry grows to more than twice the largest, and
// each pivot has the sign of its diagonal entry.
Matrix dominated(const std::string& name, int n, const std::vector<std::pair<int, int>>& places,
                 double share_negative) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Triplet<double>> entries;
  Vec sums = Vec::Zero(n);
  for (const auto& [i, j] : places) {
    const double value = uniform(random);
    entries.emplace_back(std::max(i, j), std::min(i, j), value);
    sums[i] += std::abs(value);
    sums[j] += std::abs(value);
  }
  Vec diagonal(n);
  for (int i = 0; i < n; ++i) {
    const bool negative = 0.5 * (uniform(random) + 1) < share_negative;
    diagonal[i] = (negative ? -1 : 1) * (1 + sums[i]);
    entries.emplace_back(i, i, 0.0);
  }
  SymmetricMatrix k(n, n);
  k.setFromTriplets(entries.begin(), entries.end());
  return {name, diagonal, k};
}

// Patterns with one kind of front each, and with many.
std::vector<Matrix> patterns(double share_negative) {
  std::vector<Matrix> all;
  const auto add = [&](const std::string& name, int n, const auto& joined) {
    std::vector<std::pair<int, int>> places;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        if (joined(i, j)) places.emplace_back(i, j);
      }
    }
    all.push_back(dominated(name, n, places, share_negative));
  };
  const auto none = [](int, int) { return false; };
  const auto every = [](int, int) { return true; };
  for (const int n : {0, 1, 2, 7, 8, 9, 100}) add("diagonal", n, none);
  // All fillings of a strip of 8, and more pivots than a panel has.
  for (int n = 2; n <= 34; ++n) add("dense", n, every);
  for (const int n : {95, 96, 97, 104, 195, 250}) add("dense", n, every);
  for (const int n : {9, 40, 300}) {
    add("arrow", n, [=](int i, int) { return i == n - 1; });
    add("arrow backwards", n, [](int, int j) { return j == 0; });
    add("chain", n, [](int i, int j) { return i == j + 1; });
    add("band", n, [](int i, int j) { return i - j <= 11; });
    add("ring", n, [=](int i, int j) { return i == j + 1 || (i == n - 1 && j == 0); });
  }
  add("dense islands", 200, [](int i, int j) { return i / 37 == j / 37; });
  add("two of 120 and 130 that share 20", 230, [](int i, int j) { return i < 120 || j >= 100; });
  std::mt19937 random(11);
  for (const double mean : {0.5, 1.0, 2.0, 5.0, 30.0}) {
    for (const int n : {30, 150, 400}) {
      std::bernoulli_distribution chosen(std::min(1.0, mean / n));
      add("random", n, [&](int, int) { return chosen(random); });
    }
  }
  return all;
}

// Scenes are moved from their starts by this part of their size: springs are compressed and
// stretched.
constexpr double away = 1e-2;

// The number of negative pivots of a matrix that `threads` threads factorise, or -1 if they gave
// up, and the solution for a right-hand side.
struct Solved {
  Index negative = -1;
  Vec x;
};

Solved solve_with(int threads, Factors& factors, const Matrix& m, double s, bool only_positive) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  Solved solved;
  if (!only_positive || factors.factorize_positive(1, s, m.k)) {
    if (!only_positive) factors.factorize(1, s, m.k);
    solved.negative = factors.negative_pivots();
    factors.solve(Vec::LinSpaced(m.diagonal.size(), -1, 2), solved.x);
  }
  omp_set_num_threads(before);
  return solved;
}

// Cases large enough for several threads: with one separator or thousands of parts, in the plane
// and in space, and with a front at the top that takes several panels.
std::vector<Matrix> large_cases() {
  std::vector<Matrix> all = {
      displaced(draw("cloth", {{"nodes", 45}}), only_pins, away),
      displaced(draw("lattice", {{"nodes_x", 16}, {"nodes_y", 9}, {"nodes_z", 9}}), only_pins,
                away),
  };
  std::vector<std::pair<int, int>> places;
  const int n = 2400, block = 60;
  for (int i = 0; i < n; ++i) {
    for (int j = i / block * block; j < i; ++j) places.emplace_back(i, j);
  }
  all.push_back(dominated("dense islands", n, places, 0.4));
  for (int i = n - 20; i < n; ++i) {
    for (int j = 0; j < n - block; ++j) places.emplace_back(i, j);
  }
  all.push_back(dominated("islands with 20 in common", n, places, 0.4));
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(any_number_of_threads_makes_the_same_factors) {
  int indefinite = 0, given_up = 0;
  std::vector<Matrix> all = large_cases();
  for (const Generator& generator : generators())
    all.push_back(displaced(draw(generator.name), {}, away));
  for (const Matrix& m : all) {
    const auto factors = make_multifrontal(m.k, m.diagonal);
    for (const double s : {1e-8, 1e-4, 1.0}) {
      for (const bool only_positive : {false, true}) {
        const Solved alone = solve_with(1, *factors, m, s, only_positive);
        indefinite += alone.negative > 0;
        given_up += alone.negative < 0;
        for (const int threads : {2, 3, 2, 1}) {
          BOOST_TEST_CONTEXT(m.name << " of " << m.diagonal.size() << " unknowns, s = " << s << ", "
                                    << threads << " threads") {
            const Solved together = solve_with(threads, *factors, m, s, only_positive);
            BOOST_TEST(together.negative == alone.negative);
            BOOST_TEST_REQUIRE(together.x.size() == alone.x.size());
            BOOST_TEST((together.x.array() == alone.x.array()).all());
          }
        }
      }
    }
  }
  BOOST_TEST(indefinite >= 4);
  BOOST_TEST(given_up >= 4);
}

// Threads divide a front's columns by strips, and put into them the entries of K from the first
// that begins in a strip to the last.
BOOST_AUTO_TEST_CASE(every_entry_of_the_matrix_has_one_place_and_none_leaves_its_strip) {
  std::vector<Matrix> all = large_cases();
  for (Matrix& m : patterns(0)) all.push_back(std::move(m));
  for (const Matrix& m : all) {
    BOOST_TEST_CONTEXT(m.name << " of " << m.diagonal.size() << " unknowns") {
      const Fronts fronts(m.k, analyse(m.k));
      std::vector<std::pair<int, int>> columns_and_rows;  // in the order of elimination
      for (int j = 0; j < m.k.cols(); ++j) {
        for (SymmetricMatrix::InnerIterator entry(m.k, j); entry; ++entry)
          columns_and_rows.push_back(std::minmax({fronts.place()[entry.row()], fronts.place()[j]}));
      }
      std::vector<int> places(columns_and_rows.size());
      Index misplaced = 0;
      for (const Front& f : fronts) {
        const auto strip = [&](int target) { return target / f.height() / strip_height; };
        const auto strip_of = [&](const Entry& e) { return strip(e.target); };
        BOOST_TEST(std::ranges::is_sorted(fronts.entries(f), {}, strip_of));
        for (const Entry& e : fronts.entries(f)) {
          for (int i = 0; i < e.length; ++i) {
            const int target = e.target + i * (e.across ? f.height() : 1);
            const int column = target / f.height(), row = target % f.height();
            const std::pair found(f.first + column, row < f.pivots
                                                        ? f.first + row
                                                        : fronts.rows(f)[row - f.pivot_height()]);
            misplaced += found != columns_and_rows[e.source + i] || strip(target) != strip_of(e);
            ++places[e.source + i];
          }
        }
      }
      BOOST_TEST(misplaced == 0);
      BOOST_TEST(std::ranges::count(places, 1) == std::ssize(places));
    }
  }
}

// Kernels read vectors at the ends of an update's columns whole, up to a strip's height beyond it.
// Branches make their updates at the same time: no two may come so close.
BOOST_AUTO_TEST_CASE(branches_never_write_to_the_same_place) {
  std::size_t neighbours = 0;
  for (const Matrix& m : large_cases()) {
    BOOST_TEST_CONTEXT(m.name << " of " << m.diagonal.size() << " unknowns") {
      const Fronts fronts(m.k, analyse(m.k));
      std::vector<std::pair<Index, Index>> written;
      for (const Branch& branch : fronts.branches()) {
        for (int i = branch.start; i < branch.end; ++i) {
          const Front& f = fronts.all()[i];
          const Index size = Index{f.below_height()} * f.below_height();
          if (f.kept) written.emplace_back(f.update, f.update + size + strip_height);
        }
      }
      std::ranges::sort(written);
      for (std::size_t i = 1; i < written.size(); ++i, ++neighbours) {
        BOOST_TEST(written[i].first >= written[i - 1].second);
      }
      for (const auto& [from, end] : written) BOOST_TEST(end <= fronts.top_sizes.updates);
    }
  }
  BOOST_TEST(neighbours >= 10);
}

// The last pivot of all fails, in a front that the threads have divided among themselves: whoever
// learns of it first must not leave the others waiting. Which one that is changes from run to run.
BOOST_AUTO_TEST_CASE(threads_give_up_together) {
  for (Matrix& m : large_cases()) {
    const std::vector<int> place = analyse(m.k).place;
    m.diagonal[std::ranges::max_element(place) - place.begin()] = -1e9;
    const auto factors = make_multifrontal(m.k, m.diagonal);
    for (int i = 0; i < 100; ++i) {
      BOOST_TEST_REQUIRE(solve_with(3, *factors, m, 1e-8, true).x.size() == 0);
    }
  }
}

// Experiments run scenes side by side, each in one of their own threads.
BOOST_AUTO_TEST_CASE(inside_other_threads_each_works_by_itself) {
  const Matrix m = large_cases().front();
  const auto factors = make_multifrontal(m.k, m.diagonal);
  const Solved alone = solve_with(1, *factors, m, 1e-4, false);
  std::vector<Solved> inside(3);
#pragma omp parallel for num_threads(3)
  for (int i = 0; i < 3; ++i) {
    const auto own = make_multifrontal(m.k, m.diagonal);
    inside[i] = solve_with(2, *own, m, 1e-4, false);
  }
  for (const Solved& solved : inside) {
    BOOST_TEST_REQUIRE(solved.x.size() == alone.x.size());
    BOOST_TEST((solved.x.array() == alone.x.array()).all());
  }
}

BOOST_AUTO_TEST_CASE(solves_every_pattern_with_pivots_of_one_and_of_either_sign) {
  for (const double share_negative : {0.0, 0.4}) {
    for (const Matrix& m : patterns(share_negative)) {
      BOOST_TEST_CONTEXT(m.name << " of " << m.diagonal.size()) {
        const auto factors = make_multifrontal(m.k, m.diagonal);
        const SymmetricMatrix a = m.whole(1, 1);
        const Index negative = (m.diagonal.array() < 0).count();
        BOOST_TEST(factors->factorize_positive(1, 1, m.k) == (negative == 0));
        if (negative == 0) BOOST_TEST(backward_error(*factors, a) < tolerance_of(a));
        BOOST_TEST(factors->factorize(1, 1, m.k) ==
                   (negative > 0 ? Definiteness::indefinite : Definiteness::positive));
        BOOST_TEST(factors->negative_pivots() == negative);
        BOOST_TEST(backward_error(*factors, a) < tolerance_of(a));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_zero_or_infinite_pivot_anywhere_is_singular) {
  for (const double bad : {0.0, double(INFINITY), double(NAN)}) {
    for (const int n : {1, 8, 9, 40}) {
      for (int at = 0; at < n; ++at) {
        Matrix m = dominated("diagonal", n, {}, 0.4);
        const auto factors = make_multifrontal(m.k, Vec::Ones(n));
        SymmetricMatrix k = m.k;
        for (int i = 0; i < n; ++i) k.coeffRef(i, i) = i == at ? bad : m.diagonal[i];
        BOOST_TEST(factors->factorize(0, -1, k) == Definiteness::singular);
        BOOST_TEST(!factors->factorize_positive(0, -1, k));
        // And nothing of it is left.
        BOOST_TEST(factors->factorize_positive(1, 0, m.k));
        BOOST_TEST(
            backward_error(*factors, m.whole(0, 0) + SymmetricMatrix(Vec::Ones(n).asDiagonal())) <
            tolerance_of(k));
      }
    }
  }
}

// Large ones by two threads.
BOOST_AUTO_TEST_CASE(every_matrix_is_solved_as_by_cholmod) {
  std::vector<Matrix> all = large_cases();
  const std::size_t large = all.size();
  for (const Generator& generator : generators()) {
    for (const auto& reductions : {Reductions{}, only_pins})
      all.push_back(displaced(draw(generator.name), reductions, away));
  }
  int indefinite = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Matrix& m = all[i];
    const auto factors = make_multifrontal(m.k, m.diagonal);
    const auto reference = make_cholmod_factors(m.k, m.diagonal);
    for (const double s : {0.0, 1e-8, 1e-6, 1e-4, 1e-2, 1.0}) {
      BOOST_TEST_CONTEXT(m.name << " of " << m.diagonal.size() << " unknowns, s = " << s) {
        const Definiteness signs = reference->factorize(1, s, m.k);
        BOOST_TEST(signs != Definiteness::singular);
        BOOST_TEST(factors->factorize(1, s, m.k) == signs);
        const Solved solved = solve_with(i < large ? 2 : 1, *factors, m, s, false);
        BOOST_TEST(solved.negative == reference->negative_pivots());
        const SymmetricMatrix a = m.whole(1, s);
        const bool positive = signs == Definiteness::positive;
        indefinite += !positive;
        const double allowed = positive ? tolerance_of(a) : indefinite_tolerance;
        BOOST_TEST(backward_error(*factors, a) < allowed);
        BOOST_TEST(backward_error(*reference, a) < allowed);
        BOOST_TEST(factors->factorize_positive(1, s, m.k) == positive);
      }
    }
  }
  BOOST_TEST(indefinite >= 10);
}

BOOST_AUTO_TEST_SUITE_END()
