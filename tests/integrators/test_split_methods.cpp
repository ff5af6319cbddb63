// Methods that take the forces of stiff springs apart, by the plainest one: symplectic Euler with
// the sum of both.
#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/fixed_step.hpp"
#include "tests/integrators/parts.hpp"
#include "tests/integrators/scenes.hpp"

BOOST_AUTO_TEST_SUITE(split_methods)

using namespace qddot;

namespace {

class SumOfForces final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  Outcome step(const State& now, double h, State& next) override {
    split_of(system())->stiff->force(now.q, stiff_);
    split_of(system())->soft->force(now.q, soft_);
    next.v = now.v + h * (stiff_ + soft_).cwiseQuotient(system().mass());
    next.q = now.q + h * next.v;
    return Outcome::reached_end;
  }

  Vec stiff_{system().size()}, soft_{system().size()};
};

const Method method = {.name = "sum_of_forces",
                       .summary = "a sum",
                       .source = "none",
                       .needs = {Need::split_forces},
                       .make = create<SumOfForces>};

constexpr Options options = {.step_size = 1e-3};

}  // namespace

BOOST_AUTO_TEST_CASE(on_a_split_system_they_run) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = hammock(dimension);
    const auto system = make_mass_spring(with_split(p.network));
    BOOST_TEST(applies_to(method, *system));
    const Run r = run(method, *system, p.initial, 0.1, options);
    BOOST_TEST(r.summary.message == "");
    const Run whole = run(method_named("symplectic_euler"), *system, p.initial, 0.1, options);
    // 100 steps of positions of 5 m, velocities of 10 m/s and forces of 100 N, each rounded.
    BOOST_TEST(distance(r.state, whole.state) < 100 * 10 * 2.2e-16 * 10);
    BOOST_TEST(distance(r.state.q, p.initial.q) > 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(without_a_stiff_set_they_are_refused_before_the_first_step) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  BOOST_TEST(!applies_to(method, *system));
  BOOST_TEST((misfit(method, *system) == Outcome::no_stiff_set));
  const Run r = run(method, *system, p.initial, 1, options);
  BOOST_TEST(name(r.summary.outcome) == "no_stiff_set");
  BOOST_TEST(r.summary.message == advice(Outcome::no_stiff_set));
  BOOST_TEST(same(r.state, p.initial));
  BOOST_TEST((r.summary.counts == Counts{}));
}

BOOST_AUTO_TEST_CASE(other_methods_do_not_ask) {
  const auto split = make_mass_spring(with_split(hammock(2).network)),
             whole = make_mass_spring(hammock(2).network);
  for (const Method& other : general_methods()) {
    BOOST_TEST(applies_to(other, *whole), other.name);
    BOOST_TEST(applies_to(other, *split), other.name);
  }
}

BOOST_AUTO_TEST_CASE(one_that_needs_a_constant_stiffness_as_well_is_told_of_that_first) {
  Method both = method;
  both.needs = both.needs.with(Need::constant_stiffness);
  const auto is = [&](const Network& network) { return misfit(both, *make_mass_spring(network)); };
  BOOST_TEST((is(hammock(2).network) == Outcome::stiffness_varies));
  BOOST_TEST((is(linear_hammock(2).network) == Outcome::no_stiff_set));
  BOOST_TEST(!is(with_split(linear_hammock(2).network)).has_value());
}

BOOST_AUTO_TEST_CASE(every_part_has_to_be_split_but_one_without_unknowns) {
  const std::vector<Part> parts = parts_for(method);
  const Together together(parts);
  BOOST_TEST(applies_to(method, *together.system));
  const double t_end = start_time + 0.1;
  const Run whole = run(method, together, t_end, options);
  BOOST_TEST(whole.summary.message == "");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Run alone = run(method, parts[i], t_end, options);
    BOOST_TEST(same(together.part(whole.state, i), alone.state));
  }

  std::vector<Part> more = parts;
  more.push_back({[] { return make_mass_spring({.dimension = 2}); }, {start_time, {}, {}}});
  BOOST_TEST(run(method, Together(more), t_end, options).summary.message == "");
  more.insert(more.begin() + 1, part(hammock(2)));
  const Together unlike(more);
  const Run refused = run(method, unlike, t_end, options);
  BOOST_TEST(name(refused.summary.outcome) == "no_stiff_set");
  BOOST_TEST(same(refused.state, unlike.start));
}

BOOST_AUTO_TEST_CASE(scenes_that_name_stiff_springs_take_them_however_reduced) {
  std::mt19937 random(3);
  Scene scene{.dimension = 2, .stiff_above = 120};
  for (const double x : {0., 20.}) add_random_body(random, 5, {x, 0, 0}, scene);
  scene.nodes.push_back({.position = {50, 0, 0}, .velocity = {1, 1, 0}, .mass = 1});
  scene.nodes[2].pinned = true;
  for (const Reductions& reductions :
       {Reductions(), Reductions::only({}), Reductions::only({Reduction::parts}),
        Reductions().without(Reduction::free_flight)}) {
    const auto split = nodes_after(scene, reductions, method, 1e-3, 0.1);
    const auto whole = nodes_after(scene, reductions, method_named("symplectic_euler"), 1e-3, 0.1);
    for (std::size_t i = 0; i < split.size(); ++i) {
      // As above, with positions of 50 m.
      BOOST_TEST((split[i].position - whole[i].position).norm() < 100 * 10 * 2.2e-16 * 50);
    }
    Scene unnamed = scene;
    unnamed.stiff_above.reset();
    BOOST_CHECK_THROW(nodes_after(unnamed, reductions, method, 1e-3, 0.1), std::runtime_error);
  }
}

BOOST_AUTO_TEST_SUITE_END()
