#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <boost/test/unit_test.hpp>

#include "experiments/advice/hard_worth.hpp"
#include "experiments/advice/true_motion.hpp"
#include "experiments/kit/plain_motion.hpp"

using namespace qddot;
using namespace qddot::judged_advice;

BOOST_AUTO_TEST_SUITE(hard_case)

namespace {

constexpr std::array forms = {PairLaw::Form::lennard_jones, PairLaw::Form::morse,
                              PairLaw::Form::gravity};

// Three bodies, one of them drawn to the origin, too.
HardCase three_bodies(PairLaw::Form form) {
  HardCase c{.scene = {.dimension = 3}, .until = 1};
  c.scene.nodes = {{.position = {0.9, 0.3, -0.2}, .velocity = {0.1, 0.2, 0}, .mass = 2},
                   {.position = {-0.4, 1.1, 0.3}, .mass = 0.5},
                   {.position = {0.2, -0.9, 0.7}, .velocity = {0, 0, -0.3}, .mass = 1}};
  const PairLaw law{form, 0.7, 1.1};
  c.pairs = {{0, 1, law}, {1, 2, law}, {2, {}, law}};
  return c;
}

}  // namespace

BOOST_AUTO_TEST_CASE(own_forces_are_derivatives_of_their_energy) {
  for (const PairLaw::Form form : forms) {
    const Model model = three_bodies(form).model();
    const System& system = model.system();
    const Vec q = model.initial().q;
    // Central differences of step d: errors of d^2 times third derivatives of some 1e3, and of the
    // rounding 1e-16/d.
    constexpr double d = 1e-6, tolerance = 1e-8;
    Vec f(q.size()), ahead(q.size()), behind(q.size());
    system.force(q, f);
    SymmetricMatrix k = system.stiffness_pattern();
    system.stiffness(q, k);
    const Eigen::MatrixXd full = Eigen::MatrixXd(k).selfadjointView<Eigen::Lower>();
    for (Index i = 0; i < q.size(); ++i) {
      Vec there = q, here = q;
      there[i] += d, here[i] -= d;
      const double slope = (system.potential(there) - system.potential(here)) / (2 * d);
      BOOST_TEST(std::abs(f[i] + slope) < tolerance * (1 + f.norm()));
      system.force(there, ahead), system.force(here, behind);
      const double worst = ((ahead - behind) / (2 * d) - full.col(i)).cwiseAbs().maxCoeff();
      BOOST_TEST(worst < tolerance * (1 + full.norm()));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_truth_of_own_forces_has_the_same_forces) {
  for (const PairLaw::Form form : forms) {
    HardCase c = three_bodies(form);
    for (const bool gives_stiffness : {true, false}) {
      c.gives_stiffness = gives_stiffness;
      const Model model = c.model();
      const PlainPairs<long double> plain(c.scene, c.pairs);
      std::vector<long double> a;
      plain.acceleration(plain.positions(), a);
      Vec f(9);
      model.system().force(model.initial().q, f);
      for (std::size_t i = 0; i < 9; ++i) {
        const auto own = static_cast<double>(a[i]) * c.scene.nodes[i / 3].mass;
        BOOST_TEST(std::abs(own - f[static_cast<Index>(i)]) < 1e-14 * (1 + f.norm()));  // rounding
      }
      const auto energy = static_cast<double>(plain.energy(plain.positions(), plain.velocities()));
      BOOST_TEST(std::abs(energy - model.energy(model.initial())) < 1e-14);  // rounding
    }
  }
}

BOOST_AUTO_TEST_CASE(the_truth_is_the_same_far_from_zero) {
  // A turning pair of masses. The places are multiples of 2^-20, so that no move rounds them. Both
  // truths have positions from the first mass, and so the same numbers.
  Scene scene{.dimension = 3, .gravity = {0, -1, 0}};
  scene.nodes = {{.velocity = {1e-6, 0, 2e-6}, .mass = 1},
                 {.position = {1, 0.5, 0x1p-20}, .velocity = {0, 3e-6, 0}, .mass = 0.5}};
  scene.springs = {{{0, 1}, {.stiffness = 40, .rest_length = 1}}};
  Scene far = scene;
  for (Node& node : far.nodes) node.position += Eigen::Vector3d{0x1p20, -0x1p19, 0x1p20};
  PlainMotion<long double> near_zero(scene, 1e-17L), elsewhere(far, 1e-17L);
  BOOST_TEST_REQUIRE((near_zero.advance(20) && elsewhere.advance(20)));
  const auto expected = near_zero.state(), found = elsewhere.state();
  for (std::size_t c = 0; c < 6; ++c) {
    BOOST_TEST((found.v[c] == expected.v[c]));
    const long double shift = elsewhere.model().positions()[c] - near_zero.model().positions()[c];
    BOOST_TEST(std::abs(static_cast<double>(found.x[c] - shift - expected.x[c])) < 1e-12);  // 2^-43
  }
}

BOOST_AUTO_TEST_CASE(the_true_motion_is_that_of_known_solutions) {
  // Three periods of a planet that comes within a hundredth of its distance, back at its start.
  HardCase planet{.scene = {.dimension = 2}, .until = 6 * std::numbers::pi};
  constexpr double e = 0.98;
  planet.scene.nodes = {
      {.position = {1 + e, 0, 0}, .velocity = {0, std::sqrt((1 - e) / (1 + e)), 0}, .mass = 1}};
  planet.pairs = {{0, {}, {PairLaw::Form::gravity, 1, 1}}};
  const TrueMotion orbit = true_motion(planet);
  BOOST_TEST_REQUIRE(orbit.is_known());
  // A rounding of the start changes the period by some roundings, and the place by the way in that
  // time.
  const double off = (orbit.path.back()[0].position - planet.scene.nodes[0].position).norm();
  BOOST_TEST(off < 1e-12);
  BOOST_TEST(orbit.conditioning_at_end < 1e-12);
  BOOST_TEST(orbit.conditioning > 10 * orbit.conditioning_at_end);  // near the centre it is fast

  // On a line through its pin: x'' = -w^2 (x - l0) where x > 0, and -w^2 (x + l0) where x < 0.
  HardCase through{.scene = {.dimension = 1}};
  constexpr double l0 = 0.5, w = 2, start = 1.2, speed = 3;
  through.scene.nodes = {{.pinned = true},
                         {.position = {start, 0, 0}, .velocity = {-speed, 0, 0}, .mass = 1}};
  through.scene.springs = {{{0, 1}, {.stiffness = w * w, .rest_length = l0}}};
  // x - l0 = a cos(w t + p) until x = 0; then half-swings follow, on either side in turn.
  const double a = std::hypot(start - l0, speed / w), p = std::atan2(speed / w, start - l0);
  const double to_zero = (std::acos(-l0 / a) - p) / w, half = 2 * std::acos(-l0 / a) / w;
  through.until = to_zero + 4 * half + to_zero;
  const TrueMotion swings = true_motion(through);
  BOOST_TEST_REQUIRE(swings.is_known());
  // Then it is at zero and goes on to the other side, -x - l0 = a cos(w t - acos(-l0/a)).
  const double expected = -(l0 + a * std::cos(w * to_zero - std::acos(-l0 / a)));
  BOOST_TEST(std::abs(swings.path.back()[1].position[0] - expected) < 1e-12);
}

BOOST_AUTO_TEST_CASE(cases_are_valid_small_and_of_all_kinds) {
  std::set<std::string> kinds;
  for (std::uint64_t number = 0; number < 6 * hard_kinds(); ++number) {
    const HardCase c = judged_advice::hard_case(number);
    BOOST_TEST_CONTEXT(c.scene.name) {
      kinds.insert(c.kind);
      if (c.pairs.empty()) validate(c.scene, "case");
      BOOST_TEST((c.until > 0 && std::isfinite(c.until)));
      BOOST_TEST((c.accuracy >= 1e-10 && c.accuracy <= 0.1));
      BOOST_TEST(c.as_drawn().system().size() <= 80);
      const HardCase again = judged_advice::hard_case(number);
      BOOST_TEST(content_hash(again.scene) == content_hash(c.scene));
      BOOST_TEST(again.until == c.until);
    }
  }
  BOOST_TEST(kinds.size() == hard_kinds());
}

BOOST_AUTO_TEST_CASE(commensurate_cases_end_where_the_radial_motion_began) {
  int seen = 0;
  for (std::uint64_t number = 0; number < 100 * hard_kinds(); ++number) {
    // Positions only: a third of the cases has each scene's kind.
    if (number % 3 != 0) continue;
    const HardCase c = judged_advice::hard_case(number);
    if (c.kind != "commensurate" || c.scene.springs.size() > 1 || c.scene.dimension == 1) continue;
    const TrueMotion truth = true_motion(c);
    BOOST_TEST_REQUIRE(truth.is_known(), truth.unknown_because);
    const Node &begin = c.scene.nodes[1], &end = truth.path.back()[1];
    BOOST_TEST_CONTEXT(c.scene.name) {
      // The period has some digits fewer than rounding.
      BOOST_TEST(std::abs(end.position.norm() / begin.position.norm() - 1) < 1e-9);
      BOOST_TEST(std::abs(end.velocity.dot(end.position)) <
                 1e-6 * end.velocity.norm() * end.position.norm());
    }
    ++seen;
  }
  BOOST_TEST(seen >= 10);
}

BOOST_AUTO_TEST_CASE(figures_count_what_their_names_say) {
  HardResult within{.kind = "a", .of = "path", .accuracy = 1e-3, .is_claimed = true};
  within.error_estimate = 5e-4, within.error = 4e-4, within.conditioning = 1e-6;
  HardResult beyond_bar = within, false_one = within, refused = within, ill_posed = within,
             lost = within;
  beyond_bar.error = 6e-4;
  false_one.error = 2e-3;
  refused.is_claimed = false;
  ill_posed.conditioning = 1e-2, ill_posed.error = 1e-2;
  lost.left_out = "no truth";
  lost.error = 1;
  const std::vector<HardResult> results = {within, beyond_bar, false_one, refused, ill_posed, lost};
  const auto value = [figures = judged_advice::worth_of(results)](const std::string& name) {
    const auto found =
        std::ranges::find_if(figures, [&](const Figure& f) { return f.name == name; });
    BOOST_TEST_REQUIRE((found != figures.end()));
    return found->value;
  };
  BOOST_TEST(value("within_accuracy") == 2. / 3);
  BOOST_TEST(value("within_bar") == 1. / 3);
  BOOST_TEST(value("refused") == 1. / 4);
  BOOST_TEST(value("refused_within_bar") == 1);
  BOOST_TEST(value("claimed_beyond_rounding") == 1);
  BOOST_TEST(value("bar_over_error_50") == 5. / 6);
  // One line for each of: bar, false, refused, beyond.
  BOOST_TEST(lines_of(results, false).size() == 4);
  BOOST_TEST(lines_of(results, true).size() == results.size());
}

BOOST_AUTO_TEST_SUITE_END()
