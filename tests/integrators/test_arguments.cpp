// Arguments that an integrator refuses in a sentence before it does anything.
#include <stdexcept>

#include <boost/test/unit_test.hpp>

#include "tests/fragments.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(arguments)

using namespace qddot;

namespace {

constexpr double nan = NAN, infinity = INFINITY;

// Whether the call throws std::invalid_argument with these words.
template <class Call>
bool refuses(const Call& call, const std::vector<std::string>& words) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    BOOST_TEST_MESSAGE(error.what());
    return contains(error.what(), words);
  }
  return false;
}

}  // namespace

BOOST_DATA_TEST_CASE(options_that_cannot_be_are_refused_by_name_and_value, general_methods(),
                     method) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  const Options good = options_of(method, 0.01, 1e-6);
  const auto refused = [&](auto Options::*option, auto value, const char* name) {
    Options bad = good;
    bad.*option = value;
    return refuses([&] { make_integrator(method, *system, bad); },
                   {method.name + ": " + name + " = ", "is not allowed; it is"});
  };
  const bool is_fixed = method.knob == Knob::step_size;
  for (const double h : {0., -0.1, nan, infinity}) {
    BOOST_TEST(refused(&Options::step_size, h, "step_size") == is_fixed, h);
  }
  for (const double rtol : {0., -1e-3, 1e-16, nan, infinity}) {
    BOOST_TEST(refused(&Options::rtol, rtol, "rtol") == !is_fixed, rtol);
  }
  for (const double atol : {-1e-9, nan, infinity}) {
    BOOST_TEST(refused(&Options::atol, atol, "atol") == !is_fixed, atol);
  }
  for (const double size : {0., -1., nan, infinity}) {
    BOOST_TEST(refused(&Options::length, size, "length"));
    BOOST_TEST(refused(&Options::speed, size, "speed"));
  }
  BOOST_TEST(refused(&Options::max_order, -1, "max_order"));
  BOOST_TEST(refused(&Options::iterations, -1, "iterations"));
  for (const double share : {-0.1, nan}) {
    BOOST_TEST(refused(&Options::solve_tolerance, share, "solve_tolerance"));
    BOOST_TEST(refused(&Options::spectral_radius, share, "spectral_radius"));
  }
  BOOST_TEST(refused(&Options::solve_tolerance, 1., "solve_tolerance"));
  BOOST_TEST(refused(&Options::spectral_radius, 1.1, "spectral_radius"));
  BOOST_CHECK_NO_THROW(make_integrator(method, *system, good));
}

BOOST_DATA_TEST_CASE(a_state_of_another_size_is_refused, general_methods(), method) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  const auto integrator = make_integrator(method, *system, options_of(method, 0.01, 1e-6));
  State state = p.initial;
  state.q.conservativeResize(state.q.size() - 1);
  BOOST_TEST(refuses([&] { integrator->advance(state, 1); }, {"q has", "unknowns"}));
  state = p.initial;
  state.v.conservativeResize(state.v.size() + 1);
  BOOST_TEST(refuses([&] { integrator->advance(state, 1); }, {"v has", "unknowns"}));
  BOOST_TEST(state.t == 0);
}

BOOST_AUTO_TEST_CASE(times_that_do_not_ascend_to_the_end_are_refused) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(p.network);
  const auto integrator = make_integrator(method_named("verlet"), *system, {.step_size = 0.01});
  const auto see = [](const State&) {};
  const std::vector<std::vector<double>> bad = {{0.5, 0.4}, {-0.1}, {0.5, 1.5}, {nan}, {infinity}};
  for (const auto& times : bad) {
    State state = p.initial;
    BOOST_TEST(refuses(
        [&] {
          integrator->advance(state, 1, {times, see});
        },
        {"the observer's time ", " is not allowed"}));
    BOOST_TEST(same(state, p.initial));
  }
  State state = p.initial;
  BOOST_TEST(refuses([&] { integrator->advance(state, 1, {{0.5}, nullptr}); }, {"no function"}));
  BOOST_TEST(refuses([&] { integrator->advance(state, -1); }, {"before the start"}));
  BOOST_TEST(name(integrator->advance(state, 1, {{0, 0.5, 0.5, 1}, see}).outcome) == "reached_end");
}

BOOST_AUTO_TEST_SUITE_END()
