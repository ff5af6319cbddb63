#include <boost/test/unit_test.hpp>

#include "integrators/sundials/additive_tables.hpp"
#include "integrators/sundials/arkode.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "tests/integrators/nystrom_trees.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(split_stability)

using namespace qddot;

namespace {

using namespace qddot::sundials;

using Eigen::Matrix2d;

constexpr double growth = 1e-3, resolution = 0.01;  // of the limits

Method imex(const AdditiveTable& table) {
  return method_named("arkode_imex" + std::to_string(table.order));
}

struct Pair {
  explicit Pair(const AdditiveTable& table)
      : explicit_table(check(ARKodeButcherTable_LoadERK(table.explicit_id))),
        implicit_table(check(ARKodeButcherTable_LoadDIRK(table.implicit_id))) {}

  // The spectral radius of a step h on q'' = -(w_f^2 + w_s^2) q, y_f = h w_f, y_s = h w_s:
  //   R = I + sum b_i z_i,   z_i = (I - a_ii stiff)^-1 (I + sum_j<i a_ij z_j),
  // where b_i and a_ij stand for the sums of explicit times soft and implicit times stiff, in the
  // variables (q, v/w), w^2 = w_f^2 + w_s^2, whose length is the energy's.
  double amplification(double y_f, double y_s) const {
    const double y = std::hypot(y_f, y_s);
    if (y == 0) return 1;
    const Matrix2d soft{{0, 0}, {-y_f * y_f / y, 0}}, stiff{{0, y}, {-y_s * y_s / y, 0}};
    const auto weighted = [&](double of_soft, double of_stiff) -> Matrix2d {
      return of_soft * soft + of_stiff * stiff;
    };
    std::vector<Matrix2d> stages;
    Matrix2d end = Matrix2d::Identity();
    for (int i = 0; i < implicit_table->stages; ++i) {
      Matrix2d known = Matrix2d::Identity();
      for (int j = 0; j < i; ++j) {
        known += weighted(explicit_table->A[i][j], implicit_table->A[i][j]) *
                 stages[static_cast<std::size_t>(j)];
      }
      const Matrix2d matrix = Matrix2d::Identity() - weighted(0, implicit_table->A[i][i]);
      stages.push_back(matrix.inverse() * known);
      end += weighted(explicit_table->b[i], implicit_table->b[i]) * stages.back();
    }
    return spectral_radius(end);
  }

  // Over all y_s. A resonance near 3.3, where both eigenvalues are -1, is 1 % wide; from 5 on all
  // is damped.
  double largest_amplification(double y_f) const {
    double largest = 0;
    for (double y_s = 0; y_s < 5; y_s += 1e-3) {
      largest = std::max(largest, amplification(y_f, y_s));
    }
    for (double y_s = 5; y_s < 1e4; y_s *= 1.01) {
      largest = std::max(largest, amplification(y_f, y_s));
    }
    return largest;
  }

  ButcherTable explicit_table, implicit_table;
};

}  // namespace

BOOST_AUTO_TEST_CASE(up_to_its_limit_no_vibration_grows_and_beyond_it_one_does) {
  for (const AdditiveTable& table : additive_tables) {
    BOOST_TEST_CONTEXT(table.name) {
      const Pair pair(table);
      for (int i = 0; i <= 44; ++i) {
        const double y_f = table.limit * i / 44;
        BOOST_TEST(pair.largest_amplification(y_f) < 1 + growth, "grows at " << y_f);
      }
      BOOST_TEST(pair.largest_amplification(table.limit + resolution) > 1 + growth);
    }
  }
}

BOOST_AUTO_TEST_CASE(steps_are_held_to_the_limit_of_the_soft_springs) {
  const Model scene = framed_cloth(10);
  const System& system = scene.system();
  const State& start = scene.initial();
  const double until = 0.1;
  // Seven steps a period of the frame's fastest mode, and hundreds a period of moving modes: exact
  // to 1e-12.
  const Vec end = run(method_named("kahan_li8"), system, start, until, {.step_size = 1e-5}).state.q;
  const double motion = distance(end, start.q);
  BOOST_TEST(3 * system.split()->stiff->stiffness_pattern().nonZeros() <
             system.stiffness_pattern().nonZeros());
  const double soft_bound = frequency_bound(*system.split()->soft, start.q);
  for (const AdditiveTable& table : additive_tables) {
    const double least = until * soft_bound / table.limit;
    for (const double rtol : {1e-2, 1e-3}) {
      BOOST_TEST_CONTEXT(table.name << " at " << rtol) {
        const Run r = run(imex(table), system, start, until, {.rtol = rtol});
        const Counts& c = r.summary.counts;
        BOOST_TEST(r.summary.message == "");
        // The bound of the frequency varies by some percent on the way.
        BOOST_TEST(static_cast<double>(c.steps) > 0.9 * least);
        BOOST_TEST(static_cast<double>(c.steps) < 1.2 * least);
        BOOST_TEST(c.stability_limited_steps > 0.9 * static_cast<double>(c.steps));
        BOOST_TEST(c.rejected == 0);
        // Steps twenty times as long are off by 3e-4 m and more.
        BOOST_TEST(distance(r.state.q, end) < 1e-3 * motion);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
