// The bounds that a search knows of its runs; its results are tested in test_solve.cpp.
#include <algorithm>
#include <cmath>
#include <random>

#include <boost/test/unit_test.hpp>

#include "experiments/advice/hard_case.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/failure.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "tests/measure/clocks.hpp"
#include "tests/measure/drawn_scenes.hpp"

using namespace qddot;

BOOST_FIXTURE_TEST_SUITE(search, ProcessorClock)

namespace {

// Long enough for whatever is begun.
constexpr double seconds = 100;

// A mass that passes a pinned node at a small distance, on a spring to it; and one that follows.
Scene near_miss(double distance) {
  Scene scene{.name = "near miss", .dimension = 3};
  scene.nodes = {{.pinned = true},
                 {.position = {1, distance, 0}, .velocity = {-12, 0, 0}, .mass = 1},
                 {.position = {1.4, 1.2, -0.9}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 48, .rest_length = 0.4}},
                   {{1, 2}, {.stiffness = 10, .rest_length = 1.6}}};
  return scene;
}

struct Searched {
  Scene scene;
  double until, accuracy;
};

// Motions that are judged in closed form, with error control, and by a forecast.
std::vector<Searched> motions() {
  return {{drawn("oscillator"), 7, 1e-9},
          {drawn("orbit"), 20, 1e-6},
          {drawn("orbit", {{"radius", 2.5}, {"speed", 0.01}}), 2, 1e-2},
          {near_miss(3e-3), 3, 1e-4},
          {drawn("cloth", {{"nodes", 20}}), 0.2, 1e-5},
          {drawn("lattice"), 0.05, 1e-7}};
}

double error_of(const Trial& trial, const Search& search, const Reference& reference) {
  return errors_between(search.runs().stage().model(), trial.path.back(), reference.end,
                        reference.energy, search.runs().stage().scales())
      .position;
}

void bounds_hold(const Search& search, const Reference& reference) {
  for (const Trial& trial : search.runs().all()) {
    const auto bound = search.check().bound(trial);
    if (!bound) continue;
    BOOST_TEST(error_of(trial, search, reference) <= bound->error + reference.certified.position,
               trial.method->name << " at " << trial.value);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_bound_holds) {
  for (const auto& [scene, until, accuracy] : motions()) {
    const Model model(scene);
    const Reference reference = make_reference(model, until, 10);
    Search search(model, until, AccuracyOf::positions, seconds, &scene);
    const Trial* found = search.find(accuracy);
    BOOST_TEST_CONTEXT(scene.name) {
      BOOST_TEST_REQUIRE((found != nullptr));
      BOOST_TEST(search.check().is_known(*found, accuracy));
      BOOST_TEST_REQUIRE(search.check().conditioning().has_value());
      // The motions are regular. A run with error control chooses other steps after a push, so
      // that its own error is seen, too; and so is that of a pair, whose distance counts four
      // times.
      const double part = search.is_judged_by_forecast() ? 0.25 : 0.01;
      BOOST_TEST(search.check().conditioning()->effect < part * accuracy);
      bounds_hold(search, reference);
      // The runs of a race are seen at their ends alone, and later questions meet them.
      Search again(model, until, AccuracyOf::positions, seconds, &scene);
      for (const double asked : {1e3 * accuracy, 30 * accuracy, accuracy}) {
        const Trial* best = again.find(asked);
        BOOST_TEST_REQUIRE((best != nullptr), asked);
        BOOST_TEST(again.check().is_known(*best, asked));
      }
      bounds_hold(again, reference);
      const auto& differences = again.check().conditioning()->differences;
      BOOST_TEST(
          (differences.empty() || differences.size() == again.runs().stage().times().size()));
    }
  }
}

// A mass passes its pin within a step that suits a stiff spring elsewhere. Each run misses another
// part of the turning force, so that runs may be near each other by chance.
BOOST_AUTO_TEST_CASE(pairs_that_pass_a_turning_force_are_known_no_better_than_their_energy) {
  std::mt19937 bits(1);
  const auto between = [&](double low, double high) {
    return low + (high - low) * bits() / 4294967296.0;
  };
  Rules rules;
  rules.little_work = rules.short_cut = 0;     // no error control before a forecast
  rules.unnoticed = rules.part_of_answer = 0;  // no race, which times decide
  int by_forecast = 0, false_bounds = 0;
  for (int i = 0; i < 150; ++i) {
    Scene scene = near_miss(std::pow(10, between(-6, -3)));
    scene.nodes[1].velocity.x() = between(-16, -4);
    scene.nodes.push_back({.position = {2.4, 1.2, -0.9}, .mass = 1});
    scene.springs.push_back({{2, 3}, {.stiffness = std::pow(10, between(4, 7)), .rest_length = 1}});
    const double until = between(1, 4), accuracy = std::pow(10, between(-4, -2));
    const Model model(scene);
    Search search(model, until, AccuracyOf::positions, seconds, &scene, rules);
    const Trial* found = search.find(accuracy);
    if (!found || !search.is_judged_by_forecast()) continue;
    ++by_forecast;
    const Stage& stage = search.runs().stage();
    const Trial exact = stage.run(*find_method("dprkn12"), 1e-13, {});
    false_bounds += stage.distance(*found, exact) > search.check().bound(*found)->error ? 1 : 0;
  }
  BOOST_TEST(by_forecast > 20);
  // Energy errors may fall by chance, too: one of 61 bounds is false. Without them it is nine.
  BOOST_TEST(false_bounds <= 1);
}

// Short motions on stiff springs that hardly vibrate: explicit steps are 100 times shorter than the
// accuracy needs, and one to four implicit ones do. No factorisation is large enough for threads,
// which take long at first beside load.
BOOST_AUTO_TEST_CASE(where_stiff_springs_hold_an_answer_back_implicit_methods_take_few_steps) {
  Rules rules;
  rules.unnoticed = 0.5;  // a race that no load ends
  for (const std::uint64_t number : {14000011, 14000092, 14000168}) {
    const judged_advice::Case drawn = judged_advice::drawn_case(number);
    const Model model(drawn.scene);
    Search search(model, drawn.until, AccuracyOf::positions, seconds, &drawn.scene, rules);
    const Trial* found = search.find(drawn.accuracy);
    BOOST_TEST_CONTEXT(drawn.scene.name) {
      BOOST_TEST_REQUIRE((found != nullptr));
      BOOST_TEST(found->method->is(Trait::implicit), found->method->name);
      BOOST_TEST(static_cast<double>(found->summary.counts.steps) <
                 0.1 * search.runs().steps_of_verlet());
    }
  }
}

// A mass on a compressed spring stands in exact balance above its pin. Sideways, one rounding grows
// as cosh(rate t), rate^2 = g / length.
BOOST_AUTO_TEST_CASE(an_unstable_equilibrium_is_known_until_one_rounding_leaves_it) {
  Scene scene{.name = "stands", .dimension = 2, .gravity = {0, -8, 0}};
  scene.nodes = {{.pinned = true}, {.position = {0, 0.9375, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 128, .rest_length = 1}}};
  const Model model(scene);
  const double rate = std::sqrt(8 / 0.9375), accuracy = 1e-3;
  for (const auto& [until, is_known] :
       {std::pair(5.0, true), {8.5, true}, {10.0, false}, {13.0, false}}) {
    Search search(model, until, AccuracyOf::positions, seconds, &scene);
    const Trial* found = search.find(accuracy);
    BOOST_TEST((found != nullptr) == is_known, "until " << until);
    // A rounding is between half of eps and eps of a coordinate.
    const double effect = 0x1p-53 * std::cosh(rate * until);
    if (found) BOOST_TEST(search.check().bound(*found)->error > effect, "until " << until);
  }
  // A column that stands above its critical load, until one rounding is 0.02 of its size. A million
  // roundings have thrown it over long before, and their effect is no million times as large.
  const judged_advice::HardCase column = judged_advice::hard_case(34001181);
  const Model standing = column.model();
  Search search(standing, column.until, column.of, seconds, &column.scene);
  BOOST_TEST((search.find(column.accuracy) == nullptr));
  BOOST_TEST(search.check().is_hopeless(column.accuracy));
}

// An outcome may not depend on the time that runs take. A clock that counts its own calls stands
// for a machine of another speed.
BOOST_AUTO_TEST_CASE(the_judge_is_the_same_on_machines_of_any_speed) {
  for (const auto& [scene, until, accuracy] : motions()) {
    const Model model(scene);
    Search fast(model, until, AccuracyOf::positions, seconds, &scene);
    fast.find(accuracy);
    const CountedClock clock;
    Search slow(model, until, AccuracyOf::positions, seconds, &scene);
    slow.find(accuracy);
    BOOST_TEST_CONTEXT(scene.name) {
      BOOST_TEST_REQUIRE((fast.check().best() && slow.check().best()));
      BOOST_TEST(fast.check().conditioning()->effect == slow.check().conditioning()->effect);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_pushed_run_checks_and_is_no_answer) {
  const Scene scene = drawn("cloth", {{"nodes", 20}});
  const Model model(scene);
  Search search(model, 0.6, AccuracyOf::positions, seconds);
  const Trial* found = search.find(1e-5);
  BOOST_TEST_REQUIRE((found && search.is_judged_by_forecast()));
  BOOST_TEST(!found->is_pushed);
  int pushed = 0;
  for (const Trial& trial : search.runs().all()) {
    if (!trial.is_pushed) continue;
    ++pushed;
    BOOST_TEST(!search.check().is_known(trial, 0.9));
    // It began elsewhere, by no more than a rounding of the largest coordinate.
    BOOST_TEST(trial.path.front().q.allFinite());
  }
  BOOST_TEST(pushed > 0);
}

// The way of a run that was not seen there cannot be compared.
BOOST_AUTO_TEST_CASE(a_run_that_was_seen_at_its_end_alone_is_none_of_a_pair) {
  const Scene scene = drawn("oscillator");
  const Model model(scene);
  Runs runs(model, 1, AccuracyOf::positions, seconds, nullptr, Rules{});
  const Method& verlet = *find_method("verlet");
  runs.make(verlet, 1e-3, {.only_end = true});
  BOOST_TEST((runs.has(verlet, 1e-3) && !runs.find(verlet, 1e-3)));
  const Trial& seen = runs.make(verlet, 1e-3);
  BOOST_TEST((runs.find(verlet, 1e-3) == &seen));
  // A path is nothing without looks.
  Runs path(model, 1, AccuracyOf::path, seconds, nullptr, Rules{});
  BOOST_TEST(path.make(verlet, 1e-3, {.only_end = true}).path.size() > 100u);
  // The run is repeated with looks, so that the effect of rounding is known at each.
  runs.measure_by(seen);
  Check check(runs);
  check.accept(seen, {});
  check.condition(runs.all().front(), 1e-3);
  BOOST_TEST_REQUIRE(check.conditioning().has_value());
  BOOST_TEST(check.conditioning()->differences.size() == runs.stage().times().size());
}

// The second of a pair begins one rounding away, so that both are apart by at least its effect.
BOOST_AUTO_TEST_CASE(a_pair_of_runs_shows_what_rounding_does) {
  const Scene scene = drawn("cloth", {{"nodes", 20}});
  const Model model(scene);
  Runs runs(model, 0.1, AccuracyOf::positions, seconds, nullptr, Rules{});
  const Trial& first = runs.make(*find_method("verlet"), 1e-4);
  runs.measure_by(first);
  Check check(runs);
  check.accept(first, {});
  check.condition_by_pair(first, 1e-9, first, 1e-3);
  BOOST_TEST_REQUIRE(check.conditioning().has_value());
  BOOST_TEST(check.conditioning()->effect == 1e-9);
  BOOST_TEST(runs.all().size() == 1u);
  // A distance beside which nothing is known may be that of the steps: the run is repeated.
  check.condition_by_pair(first, 1e-3, first, 1e-3);
  BOOST_TEST_REQUIRE(check.conditioning().has_value());
  BOOST_TEST(check.conditioning()->effect > 0.0);
  BOOST_TEST(check.conditioning()->effect < 1e-9);
  BOOST_TEST(runs.all().size() == 2u);
}

BOOST_AUTO_TEST_CASE(a_judge_that_another_contradicts_is_none) {
  const Scene scene = drawn("orbit");
  const Model model(scene);
  Runs runs(model, 2, AccuracyOf::positions, seconds, nullptr, Rules{});
  const Method& verlet = *find_method("verlet");
  const Trial &coarse = runs.make(verlet, 1e-2), &fine = runs.make(verlet, 5e-3);
  runs.measure_by(fine);
  const double apart = runs.distance(coarse, fine);
  BOOST_TEST_REQUIRE(apart > 1e-8);
  Check check(runs);
  // Both bounds are possible: the runs are no farther apart than twice their sum.
  check.accept(coarse, {0.3 * apart});
  check.accept(fine, {0.3 * apart});
  BOOST_TEST(check.bound(coarse)->error < 0.4 * apart);
  // A bound that is too small does not stay.
  Check other(runs);
  other.accept(coarse, {0.1 * apart});
  other.accept(fine, {0.1 * apart});
  BOOST_TEST((other.judge() == &fine));
  BOOST_TEST(other.bound(coarse)->error > apart);
}

BOOST_AUTO_TEST_CASE(forces_are_counted_as_if_all_parts_were_one) {
  Scene scene = drawn("pendulum");
  const auto forces = [&] {
    const Model model(scene);
    Runs runs(model, 1, AccuracyOf::positions, seconds, nullptr, Rules{});
    return runs.forces(runs.make(*find_method("verlet"), 1e-3));
  };
  const double of_one = forces();
  BOOST_TEST(of_one >= 1000);
  const auto nodes = static_cast<Index>(scene.nodes.size());
  const auto springs = scene.springs;
  for (Node node : std::vector<Node>(scene.nodes)) {
    node.position.x() += 10;
    scene.nodes.push_back(node);
  }
  for (Spring spring : springs) {
    for (auto& node : spring.nodes) node += nodes;
    scene.springs.push_back(spring);
  }
  BOOST_TEST_REQUIRE(Model(scene).unknowns_by_part().size() == 2u);
  BOOST_TEST(forces() == of_one);
}

BOOST_AUTO_TEST_CASE(a_motion_that_lives_in_exact_symmetry_alone_is_told_from_its_drawing) {
  // A mass between two pins, on springs that push: along the line it vibrates, out of it it
  // buckles.
  Scene scene{.name = "strut", .dimension = 3};
  const Eigen::Vector3d along = Eigen::Vector3d(1, 2, 3).normalized();
  scene.nodes = {{.position = -along, .pinned = true},
                 {.position = along, .pinned = true},
                 {.position = 0.1 * along, .mass = 1}};
  scene.springs = {{{0, 2}, {.stiffness = 100, .rest_length = 1.2}},
                   {{1, 2}, {.stiffness = 100, .rest_length = 1.2}}};
  const Model model(scene);
  BOOST_TEST_REQUIRE(model.system().size() == 1);
  Search whole(model, 10, AccuracyOf::positions, seconds, &scene);
  BOOST_TEST((whole.find(1e-6) == nullptr));
  BOOST_TEST(whole.check().conditioning()->leaves_by > 0.1);
  const Failure failure = why_not(whole, 1e-6, "");
  BOOST_TEST(failure.is_rounding);
  BOOST_TEST(failure.why.find("symmetry") != std::string::npos, failure.why);
  // The motion on the line is known, and so is the drawn one before it buckles: rounding grows by
  // e in sqrt(m / (2 k (l0 / l - 1))), 0.16 s.
  Search on_the_line(model, 10, AccuracyOf::positions, seconds);
  BOOST_TEST((on_the_line.find(1e-6) != nullptr));
  Search early(model, 1, AccuracyOf::positions, seconds, &scene);
  BOOST_TEST((early.find(1e-6) != nullptr));
}

BOOST_AUTO_TEST_CASE(a_motion_of_few_roundings_is_known_to_few_digits) {
  // A mass that moves by some 1e-9 of its coordinates: one rounding of these is 1e-7 of its motion.
  Scene scene{.name = "small", .dimension = 2};
  scene.nodes = {{.pinned = true},
                 {.position = {1, 0, 0}, .pinned = true},
                 {.position = {0.4, 0.8, 0}, .velocity = {1e-8, 5e-9, 0}, .mass = 1}};
  scene.springs = {{{0, 2}, {.stiffness = 100, .rest_length = std::sqrt(0.8)}},
                   {{1, 2}, {.stiffness = 100, .rest_length = 1}}};
  const Model model(scene);
  Search search(model, 2, AccuracyOf::positions, seconds, &scene);
  BOOST_TEST((search.find(1e-9) == nullptr));
  const Failure failure = why_not(search, 1e-9, "");
  BOOST_TEST(failure.is_rounding);
  BOOST_TEST(failure.why.find("chaotic") == std::string::npos, failure.why);
  BOOST_TEST((Search(model, 2, AccuracyOf::positions, seconds, &scene).find(1e-5) != nullptr));
}

// A mass that stands on a spring in balance falls over as rounding lets it: by e in sqrt(l / g).
BOOST_AUTO_TEST_CASE(what_stands_in_balance_is_known_until_rounding_has_grown) {
  Scene scene{.name = "standing", .dimension = 2, .gravity = {0, -9.81, 0}};
  scene.nodes = {{.pinned = true}, {.position = {0, 1, 0}, .mass = 0.2}};
  scene.springs = {{{0, 1}, {.stiffness = 4000, .rest_length = 1 + 0.2 * 9.81 / 4000}}};
  const Model on_a_line(scene), in_the_plane(scene, Reductions().without(Reduction::dimension));
  // A rounding of the height to the side, and one of the rest length beside w^2 = k/m: the bound is
  // no less than half of the first, and no more than some hundred of both.
  const double grown = 1.1e-16 * std::cosh(std::sqrt(9.81) * 3);
  for (const Model* model : {&on_a_line, &in_the_plane}) {
    const auto bound = [&](double until) {
      Search search(*model, until, AccuracyOf::positions, seconds, &scene);
      const Trial* found = search.find(1e-6);
      return found ? search.check().bound(*found)->error : INFINITY;
    };
    BOOST_TEST_CONTEXT(model->system().size() << " unknowns") {
      BOOST_TEST(bound(3) > grown / 2);
      BOOST_TEST(bound(3) < 1000 * grown);
      BOOST_TEST(bound(12) == INFINITY);
    }
  }
}

// The bound of a motion of 1e-7 in closed form knows that positions are of the order of 1.
BOOST_AUTO_TEST_CASE(closed_forms_are_as_accurate_as_their_coordinates) {
  constexpr double until = 1431.658729802337, k = 5.302289364884351, m = 1.9865957055368455;
  constexpr double pin = -0.590300432355326, start = -1.2367572492546013;
  constexpr double v = -1.907452168458753e-07, rest = 0.6464568168992753;
  Scene scene{.name = "small", .dimension = 1};
  scene.nodes = {{.position = {pin, 0, 0}, .pinned = true},
                 {.position = {start, 0, 0}, .velocity = {v, 0, 0}, .mass = m}};
  scene.springs = {{{0, 1}, {.stiffness = k, .rest_length = rest}}};
  const Model model(scene);
  Search search(model, until, AccuracyOf::positions, seconds, &scene);
  const Trial* found = search.find(1e-6);
  BOOST_TEST_REQUIRE((found && found->method->order == 0));
  const long double w = std::sqrt(static_cast<long double>(k) / m);
  const long double balance = static_cast<long double>(pin) - rest;
  const long double x =
      balance + (start - balance) * std::cos(w * until) + v / w * std::sin(w * until);
  const double moved = search.runs().stage().scales().displacement;
  const double error =
      std::abs(static_cast<double>(model.expand(found->path.back())[1].position.x() - x)) / moved;
  const double bound = search.check().bound(*found)->error;
  BOOST_TEST(error <= bound);
  BOOST_TEST(bound > 1.1e-16 / moved);  // one rounding of the position
}

// Errors of a formula that has become unstable say nothing of its order.
BOOST_AUTO_TEST_CASE(a_run_whose_energy_grows_is_not_sound) {
  const Scene scene = drawn("oscillator");
  const Model model(scene);
  Runs runs(model, 5, AccuracyOf::positions, seconds, nullptr, Rules{});
  const Method& verlet = *find_method("verlet");
  const double limit = linear_limit(verlet) / runs.bound_of_w();
  // It grows within some steps beyond the limit, and by less than a half below it.
  const Trial& unstable = runs.make(verlet, 1.02 * limit);
  BOOST_TEST_REQUIRE(unstable.reached_end());
  BOOST_TEST(!runs.is_sound(unstable));
  const Trial& stable = runs.make(verlet, 0.2 * limit);
  BOOST_TEST(runs.is_sound(stable));
}

// A massless node that starts beside its balance is there at once. The energy that this takes is no
// error of a run.
BOOST_AUTO_TEST_CASE(energies_of_massless_nodes_begin_in_balance) {
  Scene scene{.name = "three cables", .dimension = 2};
  scene.nodes = {{.position = {-1, 1, 0}, .pinned = true},
                 {.position = {1, 1, 0}, .pinned = true},
                 {.position = {0.2, 0.2, 0}, .mass = 0},
                 {.position = {-0.1, -0.8, 0}, .velocity = {0.3, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 2}, {.stiffness = 400, .rest_length = 1.2}},
                   {{1, 2}, {.stiffness = 300, .rest_length = 1.0}},
                   {{2, 3}, {.stiffness = 500, .rest_length = 0.9}}};
  scene.gravity[1] = -9.81;
  const Model model(scene, Reductions().without(Reduction::massless));
  const double until = 2, accuracy = 1e-5;
  Search search(model, until, AccuracyOf::energy, seconds, &scene);
  const Trial* found = search.find(accuracy);
  BOOST_TEST_REQUIRE((found != nullptr));
  // The energy at the start is another one, by far more than the accuracy.
  const double kinetic = search.runs().stage().scales().kinetic;
  const double start = model.energy(model.initial()), end = model.energy(found->path.back());
  BOOST_TEST(start - end > 0.01 * kinetic);
  // Energies along the run are as near each other as its bound says, whatever their first one is.
  double least = end, most = end;
  for (const State& seen : found->path) {
    least = std::min(least, model.energy(seen));
    most = std::max(most, model.energy(seen));
  }
  BOOST_TEST(most - least <= 2 * search.check().bound(*found)->error * kinetic);
}

// All steps of a coarse run are looked into, and short runs as often as long ones.
BOOST_AUTO_TEST_CASE(a_path_is_seen_within_its_steps) {
  const Scene scene = drawn("orbit", {{"radius", 2.5}, {"speed", 0.1}});
  const Model model(scene);
  const Method& coarse = *find_method("dprkn8");
  Runs runs(model, 3, AccuracyOf::path, seconds, nullptr, Rules{});
  const std::size_t before = runs.stage().times().size();
  runs.look_within_steps(coarse, 1e-2);
  const std::vector<double>& times = runs.stage().times();
  // As many again, up to one look in each step that is left over.
  BOOST_TEST(times.size() >= 2 * before - 50);
  const auto integrator = make_integrator(coarse, model.system(), options_for(coarse, 1e-2, model));
  State state = model.initial();
  std::vector<double> ends{0};
  integrator->advance(state, 3, {{}, {}, [&](const State& seen) { ends.push_back(seen.t); }});
  BOOST_TEST_REQUIRE(ends.size() < before);
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const auto looks =
        std::ranges::count_if(times, [&](double t) { return t > ends[i - 1] && t < ends[i]; });
    BOOST_TEST(looks >= static_cast<std::ptrdiff_t>(before / ends.size()));
  }
}

BOOST_AUTO_TEST_SUITE_END()
