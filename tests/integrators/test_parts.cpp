#include <boost/test/unit_test.hpp>

#include "tests/integrators/parts.hpp"

BOOST_AUTO_TEST_SUITE(parts)

using namespace qddot;

namespace {

constexpr double t_end = start_time + 0.6137;  // no whole number of steps
Options options_for(const Method& method) { return options_of(method, 0.01, 1e-6); }

}  // namespace

BOOST_DATA_TEST_CASE(every_method_takes_each_part_as_if_it_were_alone_and_shows_all_at_one_time,
                     unconstrained_methods(), method) {
  const std::vector<Part> parts = parts_for(method);
  const Together together(parts);
  for (const std::vector<double>& times :
       {std::vector<double>{},
        {start_time + 0.013, start_time + 0.2, start_time + 1. / 3, t_end}}) {
    Film film{times};
    const Run whole = run(method, together, t_end, options_for(method), film.observer());
    BOOST_TEST(whole.summary.message == "");
    BOOST_TEST(whole.state.t == t_end);
    BOOST_TEST(whole.summary.t_reached == t_end);
    BOOST_TEST_REQUIRE(film.seen.size() == times.size());
    Counts sum;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      Film own{times};
      const Run alone = run(method, parts[i], t_end, options_for(method), own.observer());
      BOOST_TEST(alone.summary.message == "");
      BOOST_TEST(same(together.part(whole.state, i), alone.state));
      for (std::size_t k = 0; k < times.size(); ++k) {
        BOOST_TEST(film.seen[k].t == times[k]);
        BOOST_TEST(same(together.part(film.seen[k], i), own.seen[k]));
      }
      sum += alone.summary.counts;
    }
    if (times.empty()) BOOST_TEST(whole.summary.counts == sum);
    BOOST_TEST(sum.steps > 0);
  }
}

BOOST_DATA_TEST_CASE(each_call_is_a_fresh_run_also_after_one_that_failed, unconstrained_methods(),
                     method) {
  if (method.asks(Need::split_forces)) return;  // which the part that gives up has not
  std::vector<Part> parts = parts_for(method);
  parts.insert(parts.begin(), giving_up(-0.2, "no more"));
  const Together together(parts);
  const auto integrator = make_integrator(method, *together.system, options_for(method));
  const double early = start_time + 0.1;
  State first = together.start, failed = together.start, second = together.start;
  const Summary a = integrator->advance(first, early);
  const auto is_no_more = [](const auto& error) { return std::string(error.what()) == "no more"; };
  BOOST_CHECK_EXCEPTION(integrator->advance(failed, t_end), std::runtime_error, is_no_more);
  const Summary c = integrator->advance(second, early);
  BOOST_TEST(a.message == "");
  BOOST_TEST(c.message == "");
  BOOST_TEST(same(first, second));
  BOOST_TEST(a.counts == c.counts);
  BOOST_TEST(c.t_reached == early);

  std::stop_source budget;
  budget.request_stop();
  BOOST_CHECK_THROW(integrator->advance(failed, t_end), std::runtime_error);
  State stopped = together.start;
  const Summary d = integrator->advance(stopped, t_end, {}, budget.get_token());
  BOOST_TEST(d.message == advice(Outcome::over_budget));
  BOOST_TEST(same(stopped, together.start));
}

BOOST_DATA_TEST_CASE(parts_without_unknowns_and_parts_of_parts_change_nothing,
                     unconstrained_methods(), method) {
  const Part nothing = {[] { return make_mass_spring({.dimension = 2}); }, {start_time, {}, {}}};
  const std::vector<Part> parts = parts_for(method);
  const auto group = [](std::vector<Part> few) {
    const State start = Together(few).start;
    return Part{[few] { return std::move(Together(few).system); }, start};
  };
  const Together flat(parts), nested({group({}), nothing, group({parts[0], nothing}),
                                      group({group({parts[1]}), parts[2]})});
  const Run a = run(method, flat, t_end, options_for(method));
  const Run b = run(method, nested, t_end, options_for(method));
  BOOST_TEST(b.summary.message == "");
  BOOST_TEST(same(a.state, b.state));
  BOOST_TEST(a.summary.counts == b.summary.counts);

  const Run empty = run(method, Together({group({}), nothing}), t_end, options_for(method));
  BOOST_TEST(empty.summary.message == "");
  BOOST_TEST(empty.state.t == t_end);
}

BOOST_DATA_TEST_CASE(what_one_part_is_refused_for_all_are, unconstrained_methods(), method) {
  Problem massless = Oscillator().problem();
  massless.network.node_mass.setZero();
  std::vector<Part> parts = parts_for(method);
  const auto outcome = [&] {
    const Together together(parts);
    const Run r = run(method, together, t_end, options_for(method));
    if (r.summary.outcome != Outcome::reached_end) {
      BOOST_TEST(same(r.state, together.start));
      BOOST_TEST(r.summary.counts == (Counts{}));
    }
    return name(r.summary.outcome);
  };
  parts.push_back(part(hammock(2)));
  BOOST_TEST(outcome() == (method.asks(Need::constant_stiffness) ? "stiffness_varies"
                           : method.asks(Need::split_forces)     ? "no_stiff_set"
                                                                 : "reached_end"));
  parts.back() = part(massless);
  BOOST_TEST(outcome() == (method.is(Trait::accepts_massless) ? "reached_end" : "singular_mass"));
}

BOOST_AUTO_TEST_SUITE_END()
