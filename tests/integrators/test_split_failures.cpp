// Methods that take stiff forces apart, and halves that fail.
#include <stdexcept>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/split_relay.hpp"

BOOST_AUTO_TEST_SUITE(split_failures)

using namespace qddot;

namespace {

using Spoil = void (*)(MutableVec f);

void break_it(MutableVec) { throw std::runtime_error("the spring broke"); }
void lose_it(MutableVec f) { f[0] = NAN; }

Options options_for(const Method& method) { return options_of(method, 0.01, 1e-6); }

// A split hammock; the forces of one half are spoiled from one of them on.
struct Spoiled {
  Spoiled(bool in_stiff, int first_bad, Spoil spoil) {
    (in_stiff ? relay.stiff : relay.soft)->after_force = [this, first_bad, spoil](const ConstVec&,
                                                                                  MutableVec f) {
      if (++calls >= first_bad) spoil(f);
    };
  }
  Problem problem = hammock(2);
  std::unique_ptr<System> system = make_mass_spring(with_split(problem.network));
  SplitRelay relay{*system};
  int calls = 0;
};

// Each method, half, and a first and a later force.
template <class Check>
void for_all(const Check& check) {
  for (const Method& method : methods()) {
    if (!method.asks(Need::split_forces)) continue;
    for (const bool in_stiff : {true, false}) {
      for (const int first_bad : {1, 95}) {
        BOOST_TEST_CONTEXT(method.name << ", force " << first_bad << " of the "
                                       << (in_stiff ? "stiff" : "soft") << " half") {
          check(method, in_stiff, first_bad);
        }
      }
    }
  }
}

void check_ended_early(const Run& r, int first_bad) {
  BOOST_TEST((r.state.t > 0) == (first_bad > 1));
  BOOST_TEST(r.state.t < 1);
  BOOST_TEST(r.summary.t_reached == r.state.t);
  BOOST_TEST(is_finite(r.state));
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_exception_in_either_half_comes_out_as_itself) {
  for_all([](const Method& method, bool in_stiff, int first_bad) {
    const Spoiled s(in_stiff, first_bad, break_it);
    const Run r = run(method, s.relay, s.problem.initial, 1, options_for(method));
    BOOST_TEST(r.thrown == "the spring broke");
    BOOST_TEST(s.calls == first_bad);  // nothing is asked for again
    check_ended_early(r, first_bad);
  });
}

BOOST_AUTO_TEST_CASE(a_force_that_is_no_number_in_either_half_is_named) {
  for_all([](const Method& method, bool in_stiff, int first_bad) {
    const Spoiled s(in_stiff, first_bad, lose_it);
    const Run r = run(method, s.relay, s.problem.initial, 1, options_for(method));
    BOOST_TEST(name(r.summary.outcome) == "not_finite", r.summary.message);
    BOOST_TEST(r.summary.message.starts_with("a force "), r.summary.message);
    BOOST_TEST(r.summary.message.find('\n') == std::string::npos);
    check_ended_early(r, first_bad);
  });
}

BOOST_AUTO_TEST_CASE(after_a_failure_the_same_integrator_runs_again) {
  for_all([](const Method& method, bool in_stiff, int first_bad) {
    for (const Spoil spoil : {break_it, lose_it}) {
      Spoiled s(in_stiff, first_bad, spoil);
      const auto integrator = make_integrator(method, s.relay, options_for(method));
      State failed = s.problem.initial, again = s.problem.initial;
      if (spoil == break_it) {
        BOOST_CHECK_THROW(integrator->advance(failed, 1), std::runtime_error);
      } else {
        BOOST_TEST(integrator->advance(failed, 1).message != "");
      }
      (in_stiff ? s.relay.stiff : s.relay.soft)->after_force = nullptr;
      BOOST_TEST(integrator->advance(again, 1).message == "");
      const Run fresh = run(method, *s.system, s.problem.initial, 1, options_for(method));
      BOOST_TEST(same(again, fresh.state));
    }
  });
}

BOOST_AUTO_TEST_CASE(a_stop_is_heard) {
  for (const Method& method : methods()) {
    if (!method.asks(Need::split_forces)) continue;
    const Problem p = hammock(2);
    const auto system = make_mass_spring(with_split(p.network));
    SplitRelay relay(*system);
    std::stop_source budget;
    relay.soft->after_force = [&, calls = 0](const ConstVec&, MutableVec) mutable {
      if (++calls == 50) budget.request_stop();
    };
    const Run r = run(method, relay, p.initial, 1e6, options_for(method), {}, budget.get_token());
    BOOST_TEST(name(r.summary.outcome) == "over_budget", method.name);
    BOOST_TEST((r.state.t > 0 && r.state.t < 1), method.name);
  }
}

BOOST_AUTO_TEST_CASE(negative_control_unspoiled_it_ends_well) {
  for_all([](const Method& method, bool in_stiff, int) {
    const Spoiled s(in_stiff, std::numeric_limits<int>::max(), break_it);
    BOOST_TEST(run(method, s.relay, s.problem.initial, 1, options_for(method)).summary.message ==
               "");
    BOOST_TEST(s.calls > 95);
  });
}

BOOST_AUTO_TEST_SUITE_END()
