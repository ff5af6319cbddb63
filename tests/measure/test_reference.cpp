#include <boost/test/unit_test.hpp>

#include "experiments/kit/plain_motion.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/reference/reference_path.hpp"
#include "qddot/measure/reference/reference_ways.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/fragments.hpp"
#include "tests/measure/clocks.hpp"
#include "tests/measure/drawn_scenes.hpp"

BOOST_AUTO_TEST_SUITE(reference)

using namespace qddot;

namespace {

// The time limit of a reference: more than any of these takes, also on a slow machine.
constexpr double seconds = 100;
// The factor by which an error may exceed its certified bound; and the best bound.
constexpr double slack = 10;
constexpr double tight = 1e-12;

// Seven masses on a line in a plane, ends pinned, the springs compressed by a tenth, each pushed
// along the line.
Scene compressed_strut() {
  Scene scene{.name = "strut", .dimension = 2};
  for (int i = 0; i < 7; ++i) {
    scene.nodes.push_back({.position = {0.9 * i, 0, 0},
                           .velocity = {i % 2 == 0 ? 0.1 : -0.2, 0, 0},
                           .mass = 0.1,
                           .pinned = i == 0 || i == 6});
    if (i == 0) continue;
    const auto own = static_cast<std::size_t>(i);
    scene.springs.push_back({{own - 1, own}, {.stiffness = 1000, .rest_length = 1}});
  }
  return scene;
}

// A mass between two pins whose springs are compressed by a fiftieth, and a spring at rest across
// them. Their stiffnesses across nearly cancel: 78 - 2 40/1 N/m. So the mass leaves its place as
// exp(4.5 t), and a force of 1e-14 N moves it a thousand times as far as across a single spring.
Scene nearly_critical_column() {
  Scene scene{.name = "column", .dimension = 2};
  scene.nodes = {{.position = {0.6, 0.8, 0}, .pinned = true},
                 {.position = {-0.6, -0.8, 0}, .pinned = true},
                 {.position = {-0.8, 0.6, 0}, .pinned = true},
                 {.position = {3e-10, 9e-10, 0}, .mass = 0.1}};
  scene.springs = {{{0, 3}, {.stiffness = 2000, .rest_length = 1.02}},
                   {{1, 3}, {.stiffness = 2000, .rest_length = 1.02}},
                   {{2, 3}, {.stiffness = 78, .rest_length = 1}}};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_oscillator_ends_where_its_closed_form_does) {
  for (const double until : {0.01, 2.0, 10.0}) {
    const Model scene(drawn("oscillator", {{"mass", 4}, {"stiffness", 25}, {"velocity", -3}}));
    const Reference made = make_reference(scene, until, seconds);
    const long double w = 2.5, t = until;
    const double x = static_cast<double>(std::cos(w * t) - 3 / w * std::sin(w * t));
    const double v = static_cast<double>(-w * std::sin(w * t) - 3 * std::cos(w * t));
    BOOST_TEST(made.end.t == until);
    BOOST_TEST(made.certified.position < tight);
    BOOST_TEST(made.certified.velocity < tight);
    BOOST_TEST(std::abs(made.end.q[0] - x) <=
               slack * made.certified.position * made.scales.displacement);
    BOOST_TEST(std::abs(made.end.v[0] - v) <= slack * made.certified.velocity * made.scales.speed);
  }
}

BOOST_AUTO_TEST_CASE(the_oscillator_is_known_along_its_way) {
  const Model scene(drawn("oscillator", {{"mass", 4}, {"stiffness", 25}, {"velocity", -3}}));
  const Reference made = make_reference(scene, 10, seconds);
  const std::vector<double> times{0, 0.3, 1, 7.77, 10};
  const ReferencePath path = path_of(scene, made, times, seconds);
  BOOST_TEST_REQUIRE(path.states.size() == times.size());
  const long double w = 2.5;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const long double t = times[i];
    const double x = static_cast<double>(std::cos(w * t) - 3 / w * std::sin(w * t));
    BOOST_TEST(path.states[i].t == times[i]);
    BOOST_TEST(path.certified[i] < tight);
    BOOST_TEST(std::abs(path.states[i].q[0] - x) <=
               slack * path.certified[i] * made.scales.displacement);
  }
  BOOST_TEST(path.states.back().q == made.end.q);
  BOOST_TEST(path.certified.back() == made.certified.position);
  Reference slow = made;
  slow.step_size = 1e-8;  // 10^9 steps: no processor takes them in a hundredth of a second
  BOOST_CHECK_THROW(path_of(scene, slow, times, 0.01), NoReference);
}

// The first step tried is a thousandth of the end, many periods here. Its stages grow by the
// cube of the displacement, until they are no numbers.
BOOST_AUTO_TEST_CASE(a_step_too_long_for_numbers_is_shortened) {
  Scene scene{.name = "quartic", .dimension = 1};
  scene.nodes = {{.position = {0, 0, 0}, .pinned = true}, {.position = {1.8, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 100, .rest_length = 1, .quartic = 100}}};
  const Model model(scene);
  const double until = 5000;  // s
  Scales scales;
  extend(scales, model, model.initial());
  const auto end = fehlberg(model, until, 1e-11, scales, seconds);
  BOOST_TEST_REQUIRE(end.has_value());
  // The tolerance, in some 10^5 steps.
  BOOST_TEST(std::abs(model.energy(end->end) / model.energy(model.initial()) - 1) < 1e-5);
  BOOST_TEST(make_reference(model, 20, seconds).certified.position < 1e-7);
}

BOOST_AUTO_TEST_CASE(scales_are_the_extremes_of_the_whole_motion) {
  // x = cos 10 t: from 1 to -1 and back, with the speed 10 between.
  const Model scene(load_scene("oscillator"));
  const Scales scales = make_reference(scene, 2, seconds).scales;
  constexpr double sampling = 1e-2;  // extremes are seen at steps
  BOOST_TEST(scales.displacement == 2, boost::test_tools::tolerance(sampling));
  BOOST_TEST(scales.speed == 10, boost::test_tools::tolerance(sampling));
  BOOST_TEST(scales.kinetic == 50, boost::test_tools::tolerance(sampling));
  // A tenth of a turn reaches none of them.
  const double t = M_PI / 50;
  const Scales early = make_reference(scene, t, seconds).scales;
  BOOST_TEST(early.displacement == 1 - std::cos(10 * t), boost::test_tools::tolerance(1e-9));
  BOOST_TEST(early.speed == 10 * std::sin(10 * t), boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(both_ways_are_named) {
  const auto made_by = [](const char* name) {
    return make_reference(Model(load_scene(name)), 0.1, seconds).made_by;
  };
  BOOST_TEST(contains(made_by("oscillator"), {"modal", "kahan_li8 at h = "}));
  BOOST_TEST(contains(made_by("pair"), {"kahan_li8 at h = ", "Fehlberg"}));
}

BOOST_AUTO_TEST_CASE(free_flight_without_springs_is_a_parabola) {
  Scene scene{.name = "thrown", .dimension = 2, .gravity = {0, -8, 0}};
  scene.nodes = {{.velocity = {3, 4, 0}, .mass = 2}};
  for (const Reductions& reductions : {Reductions(), Reductions::only({Reduction::pins})}) {
    const Model thrown(scene, reductions);
    const Reference made = make_reference(thrown, 0.5, seconds);
    const Node end = thrown.expand(made.end).front();
    BOOST_TEST(made.end.t == 0.5);
    BOOST_TEST(end.position.x() == 1.5, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(end.position.y() == 1.0, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(end.velocity.x() == 3.0, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(std::abs(end.velocity.y()) < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(one_rounding_of_the_start_does_little_to_a_regular_motion) {
  for (const char* name : {"oscillator", "pair", "orbit", "pendulum"}) {
    const Model scene(load_scene(name));
    const Reference made = make_reference(scene, 2, seconds);
    BOOST_TEST(made.certified.position < tight, name);
    BOOST_TEST(made.certified.energy < tight, name);
    BOOST_TEST(made.energy == scene.energy(scene.initial()), name);
    BOOST_TEST(std::abs(scene.energy(made.end) - made.energy) <=
                   made.certified.energy * made.scales.kinetic,
               name);
    BOOST_TEST(make_reference(scene, 0.5, seconds).rounding_effect < 1e-13, name);
    BOOST_TEST((made.perturbation_growth > 0 && made.perturbation_growth < 1e3), name);
    BOOST_TEST((!made.is_chaotic() && !made.is_beyond_horizon()), name);
    BOOST_TEST(std::isinf(made.horizon), name);
    BOOST_TEST(made.lyapunov == 0, name);
    BOOST_TEST(made.modal_shares.size() == 0, name);
  }
}

BOOST_AUTO_TEST_CASE(rounding_of_a_frequency_counts_in_proportion_to_time) {
  // w = sqrt(k/m) has an error of about one rounding, and the phase w t has it w t times. A
  // reference moves w by two and certifies twice the effect; h rounds by up to a half.
  const Scene start = drawn("oscillator", {{"mass", 3}, {"stiffness", 25}, {"velocity", -3}});
  const Model scene(start);
  for (const double until : {200.0, 1000.0}) {
    const Reference made = make_reference(scene, until, seconds, &start);
    const double phase = std::sqrt(25 / 3.0) * until * machine_epsilon;
    BOOST_TEST(std::max(made.certified.position, made.certified.velocity) >= 2.5 * phase);
    BOOST_TEST(worse(made.certified) < slack * phase);
  }
}

BOOST_AUTO_TEST_CASE(rounding_of_pins_counts_where_forces_nearly_cancel) {
  const Scene scene = nearly_critical_column();
  const Model model(scene);
  const double until = 2;
  const Reference alone = make_reference(model, until, seconds),
                  made = make_reference(model, until, seconds, &scene);
  // The mass itself is near the origin, so that its own rounding is far smaller.
  BOOST_TEST(made.rounding_effect > 1e3 * alone.rounding_effect);
  PlainMotion<Quadruple> truth(scene, Quadruple(1e-24));
  BOOST_TEST_REQUIRE(truth.advance(until));
  const auto expected = truth.state();
  const Node end = model.expand(made.end).back();
  const double x = static_cast<double>(Quadruple(end.position.x()) - expected.x[9]),
               y = static_cast<double>(Quadruple(end.position.y()) - expected.x[10]);
  BOOST_TEST(std::hypot(x, y) <= made.certified.position * made.scales.displacement);
  BOOST_TEST(made.certified.position < 1e-3);
}

BOOST_AUTO_TEST_CASE(far_from_zero_a_position_is_known_to_its_rounding) {
  // One spring from a pin at x, pulled by 2^-10 m: x(t) = x + 1 + cos(w t)/1024.
  constexpr double x = 1 << 20, part = 1.0 / 1024;
  Scene scene{.name = "far", .dimension = 1};
  scene.nodes = {{.position = {x, 0, 0}, .pinned = true},
                 {.position = {x + 1 + part, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 4, .rest_length = 1}}};
  for (const double until : {0.3, 2.0, 7.0}) {
    const Model model(scene);
    const Reference made = make_reference(model, until, seconds, &scene);
    const double rounding = machine_epsilon * x / made.scales.displacement;
    BOOST_TEST((made.certified.position >= rounding && made.certified.position < slack * rounding));
    const double moved = model.expand(made.end).back().position.x() - (x + 1);
    BOOST_TEST(std::abs(moved - part * std::cos(2 * until)) <=
               made.certified.position * made.scales.displacement);
  }
}

BOOST_AUTO_TEST_CASE(a_chaotic_motion_has_one_before_and_after_it_is_reached) {
  // Four masses in a row on soft springs, let go from the horizontal: one rounding is all of the
  // motion after some nine seconds.
  const Model scene(drawn("chain", {{"nodes", 4}, {"stiffness", 1000}}));
  const Reference early = make_reference(scene, 6, seconds),
                  late = make_reference(scene, 12, seconds);
  BOOST_TEST(!early.is_beyond_horizon());
  BOOST_TEST((early.certified.position < 1e-4 && early.horizon > 6));
  BOOST_TEST((late.is_beyond_horizon() && late.is_chaotic()));
  BOOST_TEST(late.certified.position > far_apart);
  // Growth is uneven, so that it is foreseen but roughly.
  BOOST_TEST(early.horizon == late.horizon, boost::test_tools::tolerance(0.25));
  BOOST_TEST(early.lyapunov == late.lyapunov, boost::test_tools::tolerance(0.5));
  BOOST_TEST(early.modal_shares.size() == 0);
  BOOST_TEST(late.modal_shares.sum() == 1, boost::test_tools::tolerance(1e-12));
  // Another run than those it was found by: half a horizon's error of the start is apart sooner.
  State near = scene.initial(), far = near;
  far.q[0] += 1e-8;
  const auto end = [&](State state, double until) {
    const auto run =
        make_integrator(*find_method("kahan_li8"), scene.system(), {.step_size = 1e-3});
    BOOST_TEST((run->advance(state, until).outcome == Outcome::reached_end));
    return state;
  };
  const double soon = 0.8 * late.horizon;
  BOOST_TEST(errors_between(scene, end(far, soon), end(near, soon), 0, late.scales).position >
             far_apart);
}

BOOST_AUTO_TEST_CASE(refinement_goes_on_while_steps_are_too_coarse_for_its_order) {
  // A rosette that comes near the spring's other end: the first changes do not shrink at all.
  const Model scene(drawn("orbit", {{"rest_length", 0.3}, {"speed", 1}}));
  const Reference made = make_reference(scene, 20, seconds);
  BOOST_TEST(made.certified.position < 1e-7);
  BOOST_TEST(made.certified.velocity < 1e-7);
}

BOOST_AUTO_TEST_CASE(a_motion_in_exact_symmetry_is_known_and_known_to_be_alone) {
  // Masses m on springs that push with F over the length l move sideways exponentially, the fastest
  // at (2 sin(5 pi/12)) sqrt(F/(l m)) = 66/s. One rounding becomes a hundredth after half a second.
  const Scene strut = compressed_strut();
  const Model scene(strut);
  const Reference early = make_reference(scene, 0.2, seconds, &strut),
                  late = make_reference(scene, 0.7, seconds, &strut);
  for (const Reference& made : {early, late}) {
    BOOST_TEST(made.is_reduced_by_symmetry);
    BOOST_TEST(made.certified.position < 1e-10);
    BOOST_TEST((!made.is_chaotic() && std::isinf(made.horizon)));
    BOOST_TEST_REQUIRE(made.out_of_symmetry.has_value());
  }
  BOOST_TEST(!early.is_only_symmetric());
  BOOST_TEST(late.is_only_symmetric());
  BOOST_TEST(late.out_of_symmetry->effect > far_apart);
  BOOST_TEST((late.out_of_symmetry->horizon > 0.3 && late.out_of_symmetry->horizon < 0.6));
  // The motion along the line changes F by some.
  BOOST_TEST(late.out_of_symmetry->lyapunov == 66, boost::test_tools::tolerance(0.25));
  // Without any reduction it is chaotic, and of the same horizon.
  const Model whole(strut, Reductions::only({Reduction::pins}));
  const Reference plain = make_reference(whole, 0.7, seconds);
  BOOST_TEST(plain.is_beyond_horizon());
  BOOST_TEST(plain.horizon == late.out_of_symmetry->horizon, boost::test_tools::tolerance(0.2));
}

BOOST_AUTO_TEST_CASE(a_push_out_of_a_stable_symmetry_does_nothing) {
  Scene stretched = compressed_strut();
  for (Spring& spring : stretched.springs) spring.law.rest_length = 0.8;
  const Reference made = make_reference(Model(stretched), 0.7, seconds, &stretched);
  BOOST_TEST_REQUIRE(made.out_of_symmetry.has_value());
  BOOST_TEST(std::isinf(made.out_of_symmetry->horizon));
  // It is a rounding of the start, whose effect is seen in one run as well; two runs of thousands
  // of steps add theirs.
  BOOST_TEST(made.out_of_symmetry->effect < 10 * made.rounding_effect);
  BOOST_TEST(made.rounding_effect < 1e-10);
  BOOST_TEST(!made.is_only_symmetric());
}

BOOST_AUTO_TEST_CASE(without_symmetry_there_is_nothing_to_be_pushed_out_of) {
  Scene bent = compressed_strut();
  bent.nodes[3].position.y() = 0.1;
  bent.nodes[2].position.y() = 0.2;
  const Reference made = make_reference(Model(bent), 0.1, seconds, &bent);
  BOOST_TEST(!made.is_reduced_by_symmetry);
  BOOST_TEST(!made.out_of_symmetry.has_value());
  // Nor is anything known of it where the drawn scene is not.
  const Reference unasked = make_reference(Model(compressed_strut()), 0.1, seconds);
  BOOST_TEST((unasked.is_reduced_by_symmetry && !unasked.out_of_symmetry));
}

BOOST_AUTO_TEST_CASE(a_certificate_sees_changes_and_roundings_and_not_the_difference_alone) {
  const Model scene(load_scene("oscillator"));
  const Scales scales{.displacement = 2, .speed = 10, .kinetic = 50};
  Solution one{.end = {0.1, Vec::Constant(1, 0.5), Vec::Constant(1, 1)}, .scales = scales},
      other = one;
  other.end.q[0] += 2e-9;  // 1e-9 of the scale
  BOOST_TEST(joined(scene, one, other).certified.position == 2e-9,
             boost::test_tools::tolerance(1e-6));
  one.change.position = 3e-9;
  BOOST_TEST(joined(scene, one, other).certified.position == 6e-9);
  other.change.position = 4e-9;
  BOOST_TEST(joined(scene, one, other).certified.position == 8e-9);
  BOOST_TEST(joined(scene, one, other, {.position = 5e-9}).certified.position == 1e-8);
  BOOST_TEST(joined(scene, one, other, {.velocity = 7e-9}).certified.velocity == 1.4e-8);
}

BOOST_AUTO_TEST_CASE(what_two_unlike_methods_agree_on_is_as_good_as_needed) {
  for (const char* name : {"oscillator", "orbit", "pendulum"}) {
    const Model scene(load_scene(name));
    const Reference best = make_reference(scene, 0.5, seconds);
    for (const double needed : {1e-5, 1e-8}) {
      const Reference agreed = agreed_reference(scene, 0.5, needed, 10);
      BOOST_TEST(agreed.certified.position <= needed, name);
      BOOST_TEST(errors_between(scene, agreed.end, best.end, best.energy, best.scales).position <=
                     slack * needed,
                 name);
      // A tenth of a turn shows more than its ends.
      BOOST_TEST(agreed.scales.displacement == best.scales.displacement,
                 boost::test_tools::tolerance(1e-2));
      BOOST_TEST(contains(agreed.made_by, {" at h = ", "; ", " at "}));
      BOOST_TEST(agreed.energy == best.energy);
    }
  }
}

BOOST_AUTO_TEST_CASE(where_time_is_up_the_nearest_two_say_how_far_they_differ) {
  const Model scene(load_scene("pendulum"));
  BOOST_CHECK_THROW(agreed_reference(scene, 0.5, 1e-8, 0), NoReference);
  const Reference best = make_reference(scene, 0.5, seconds);
  const Reference agreed = agreed_reference(scene, 0.5, 0, 0.2);
  const double off = errors_between(scene, agreed.end, best.end, best.energy, best.scales).position;
  BOOST_TEST(agreed.certified.position > 0);
  BOOST_TEST(off <= slack * agreed.certified.position + tight);
}

BOOST_AUTO_TEST_CASE(an_end_too_late_is_refused_with_what_it_would_take) {
  // w = 10 rad/s needs at least 5e10 steps; a core takes some millions a second.
  const Model scene(load_scene("pendulum"));
  for (const double until : {1e9, 1e300}) {
    const ProcessorClock clock;
    const auto start = clock_now();
    BOOST_CHECK_EXCEPTION(make_reference(scene, until, 5), NoReference, [](const auto& error) {
      return std::string(error.what()).find("earlier end (--until)") != std::string::npos;
    });
    BOOST_TEST(seconds_since(start) < 5);
  }
}

BOOST_AUTO_TEST_CASE(a_vibration_too_fast_for_numbers_has_no_reference) {
  // w = sqrt(k / m) of the least positive mass overflows where it is bounded by k / m.
  Scene light = drawn("pendulum");
  light.nodes.back().mass = 5e-324;
  BOOST_CHECK_EXCEPTION(make_reference(Model(light), 1e-3, 5), NoReference, [](const auto& error) {
    return contains(error.what(), {"too fast for numbers"});
  });
}

BOOST_AUTO_TEST_SUITE_END()
