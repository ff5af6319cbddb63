// Rods in place of stiff springs, as far as an accuracy lets them: what they change falls as 1/k,
// its bound holds, and springs that hold energy or are too many stay.
#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/solve_with_rods.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/rods.hpp"
#include "tests/measure.hpp"

BOOST_AUTO_TEST_SUITE(rods_answers)

using namespace qddot;

namespace {

constexpr double until = 0.1;

Scene hem(double stiffness) {
  return generate(*find_generator("hemmed_cloth"), {{"nodes", 6}, {"hem_stiffness", stiffness}},
                  "hem");
}

// The springs' motion, by a method of order 8 at h w = 1 of the stiffest hem, far below its limit.
std::vector<Node> motion_of_springs(const Scene& scene) {
  const Model model(scene);
  State state = model.initial();
  const double w = std::sqrt(8 * 1e8 * 36 / 0.5), steps = std::ceil(until * w);
  const auto integrator =
      make_integrator(*find_method("kahan_li8"), model.system(), {.step_size = until / steps});
  BOOST_REQUIRE(integrator->advance(state, until).message == "");
  return model.expand(state);
}

// The largest distance of two motions, over the largest displacement.
double apart(const Scene& scene, const std::vector<Node>& a, const std::vector<Node>& b) {
  double distance = 0, displacement = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    distance = std::max(distance, (a[i].position - b[i].position).norm());
    displacement = std::max(displacement, (b[i].position - scene.nodes[i].position).norm());
  }
  return distance / displacement;
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_rods_change_falls_as_one_over_the_stiffness_and_is_bounded) {
  std::vector<double> log_k, log_change;
  for (const double k : {1e6, 1e7, 1e8}) {
    const Scene scene = hem(k);
    const auto with_rods = solve_with_rods(scene, {}, until, {.accuracy = 1e-2});
    BOOST_TEST_REQUIRE(with_rods.has_value());
    BOOST_TEST(with_rods->rods == 15u);
    const auto truth = motion_of_springs(scene);
    const double error = apart(scene, with_rods->answer.nodes, truth);
    BOOST_TEST(error <= with_rods->answer.error_estimate);
    BOOST_TEST(with_rods->answer.error_estimate <= 1e-2);
    // The rods' own motion to many digits.
    const Model& model = *with_rods->model;
    State state = model.initial();
    make_integrator(*find_method("rattle8"), model.system(), {.step_size = until / 200})
        ->advance(state, until);
    const double change = apart(scene, model.expand(state), truth);
    BOOST_TEST_MESSAGE(k << ": " << change << " of at most " << with_rods->change);
    BOOST_TEST(change <= with_rods->change);
    BOOST_TEST(with_rods->change <= 100 * change);  // vibrations count as if all added up
    log_k.push_back(std::log(k));
    log_change.push_back(std::log(change));
  }
  const double order =
      slope(Eigen::Map<const Vec>(log_k.data(), 3), Eigen::Map<const Vec>(log_change.data(), 3));
  BOOST_TEST(std::abs(order + 1) < 0.15);  // vibrations add by chance of their phase
}

BOOST_AUTO_TEST_CASE(springs_stay_where_rods_would_change_too_much_or_are_not_allowed) {
  const Scene scene = hem(1e7);
  const auto is_left = [&](const Scene& drawn, const Wanted& wanted,
                           const Reductions& reductions = {}) {
    return solve_with_rods(drawn, reductions, until, wanted).has_value();
  };
  BOOST_TEST(is_left(scene, {.accuracy = 1e-2}));
  BOOST_TEST(is_left(scene, {.accuracy = 1e-2, .of = AccuracyOf::path}));
  BOOST_TEST(!is_left(scene, {.accuracy = 1e-2}, Reductions().without(Reduction::rods)));
  BOOST_TEST(!is_left(scene, {.accuracy = 1e-2, .of = AccuracyOf::energy}));
  BOOST_TEST(!is_left(scene, {.accuracy = 1e-7}));
  // Too few times as stiff; a start that holds energy; a side that is taut between two pins.
  BOOST_TEST(!is_left(hem(1.5e4), {.accuracy = 1e-2}));
  Scene stretched = scene;
  for (Spring& spring : stretched.springs) {
    if (spring.law.stiffness > 1e6) spring.law.rest_length *= 1 - 1e-6;
  }
  BOOST_TEST(!is_left(stretched, {.accuracy = 1e-2}));
  BOOST_TEST(!is_left(generate(*find_generator("framed_cloth"), {{"nodes", 6}}, "frame"),
                      {.accuracy = 1e-2}));
}

// A hem that starts with a stretch vibrates. Dashpots on it end that, and springs without stay.
BOOST_AUTO_TEST_CASE(a_vibration_that_damping_ends_is_left_out) {
  const double stiffness = 1e7, mass = 0.5 / 36;
  const auto stretched = [&](double zeta) {
    Scene scene = hem(stiffness);
    for (Spring& spring : scene.springs) {
      if (spring.law.stiffness < stiffness) continue;
      spring.law.rest_length *= 1 - 1e-4;
      spring.law.damping = 2 * zeta * std::sqrt(stiffness * mass);
    }
    return scene;
  };
  for (const double zeta : {0.1, 1.0}) {
    const Scene scene = stretched(zeta);
    const auto found = solve_with_rods(scene, {}, until, {.accuracy = 1e-2});
    BOOST_TEST_REQUIRE(found.has_value());
    BOOST_TEST(found->has_vibration);
    BOOST_TEST(found->in_words().find("a vibration that damping ends") != std::string::npos);
    const Model model(scene);
    State state = model.initial();
    // Its tolerance is far below the change.
    make_integrator(*find_method("arkode_erk8"), model.system(), {.rtol = 1e-10})
        ->advance(state, until);
    const double error = apart(scene, found->answer.nodes, model.expand(state));
    BOOST_TEST(error <= found->answer.error_estimate);
    BOOST_TEST(found->answer.error_estimate <= 1e-2);
    // The vibration itself is on the way.
    BOOST_TEST(
        !solve_with_rods(scene, {}, until, {.accuracy = 1e-2, .of = AccuracyOf::path}).has_value());
  }
  // So little damping leaves it to the end.
  BOOST_TEST(!solve_with_rods(stretched(1e-6), {}, until, {.accuracy = 1e-3}).has_value());
}

BOOST_AUTO_TEST_CASE(it_says_what_is_left_out) {
  const auto with_rods = solve_with_rods(hem(1e7), {}, until, {.accuracy = 1e-2});
  BOOST_TEST_REQUIRE(with_rods.has_value());
  const std::string words = with_rods->in_words();
  BOOST_TEST(words.find("left out: 15 stiff springs are rods here; that changes positions by") ==
             0);
}

// Rods that stretch by tau/k at once have the slow motion of the springs: what is left is their
// vibration, and is not the change of order 1/k.
BOOST_AUTO_TEST_CASE(rods_that_stretch_are_nearer_to_the_springs) {
  Scene scene = generate(*find_generator("chain"), {{"nodes", 6}, {"stiffness", 1e5}}, "chain");
  Scene rigid = scene, compliant = scene;
  for (std::size_t e = 0; e < scene.springs.size(); ++e) {
    rigid.springs[e].law = {.rest_length = scene.springs[e].law.rest_length, .rigid = true};
    compliant.springs[e].law = rigid.springs[e].law;
    compliant.springs[e].law.stiffness = 1e5;
  }
  const auto end_of = [&](const Scene& drawn, const char* method, double h) {
    const Model model(drawn);
    State state = model.initial();
    const Summary summary = make_integrator(*find_method(method), model.system(), {.step_size = h})
                                ->advance(state, 0.3);
    BOOST_TEST_REQUIRE(summary.message == "");
    return model.expand(state);
  };
  const auto truth = end_of(scene, "kahan_li8", 2e-5);
  const double of_rods = apart(scene, end_of(rigid, "rattle", 2e-4), truth),
               of_stretch = apart(scene, end_of(compliant, "rattle", 2e-4), truth);
  BOOST_TEST_MESSAGE(of_rods << " " << of_stretch);
  BOOST_TEST(of_stretch < of_rods / 2);
}

BOOST_AUTO_TEST_SUITE_END()
