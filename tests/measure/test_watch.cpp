#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/measure/drawn_scenes.hpp"

BOOST_AUTO_TEST_SUITE(watch)

using namespace qddot;

namespace {

constexpr double omega = 10;  // of the oscillator, 1 kg at 1 m: E = kinetic scale = 50 J

struct Watched {
  Scene drawn;
  double until;
  Model scene{drawn};
  Reference reference = make_reference(scene, until, 100);
  Watch watch{drawn, scene, until, reference};

  Point point(const char* method, double value) const {
    return measure_point(*find_method(method), value, scene, until, reference,
                         {.seconds = 60, .repeats = 1, .watch = &watch});
  }
};

Watched oscillator(double until) { return {load_scene("oscillator"), until}; }

}  // namespace

BOOST_AUTO_TEST_CASE(explicit_eulers_energy_error_is_largest_at_the_end) {
  // E grows by 1 + h^2 w^2 in each step.
  const Watched run = oscillator(2);
  for (const int steps : {40, 200, 1000}) {
    const double h = 2.0 / steps;
    const Point point = run.point("explicit_euler", h);
    const double growth = std::pow(1 + h * h * omega * omega, steps) - 1;
    BOOST_TEST(point.path.energy == point.errors.energy);
    // The largest kinetic energy is seen at the reference's steps.
    BOOST_TEST(point.path.energy == growth, boost::test_tools::tolerance(1e-3));
  }
}

BOOST_AUTO_TEST_CASE(verlets_energy_error_is_its_oscillation_though_the_end_is_good_by_luck) {
  // Verlet's method conserves w^2 q^2 + v^2/(1 - s), s = (h w/2)^2. So E goes from E(0) to (1 - s)
  // E(0) and back twice a period, from rest. It is E(0) again after whole periods.
  const double until = 6 * M_PI / omega;
  const Watched run = oscillator(until);
  for (const int steps : {60, 130, 1000}) {
    const double h = until / steps, s = std::pow(h * omega / 2, 2);
    const Point point = run.point("verlet", h);
    // The look that is nearest to a crest is half a step from it: 1 - cos of a tenth of pi.
    BOOST_TEST(point.path.energy <= s * (1 + 1e-3));
    BOOST_TEST(point.path.energy >= s * 0.95);
    BOOST_TEST(point.errors.energy < 0.1 * s);
  }
}

BOOST_AUTO_TEST_CASE(steps_of_a_fixed_size_stay_what_they_are) {
  const Watched run{load_scene("orbit"), 0.7};
  for (const int steps : {7, 100, 333}) {
    const double h = 0.7 / steps;
    double largest = 0;
    const auto integrator =
        make_integrator(*find_method("rk4"), run.scene.system(), {.step_size = h});
    State state = run.scene.initial();
    for (int i = 1; i <= steps; ++i) {
      integrator->advance(state, i * h);
      const Errors errors =
          errors_between(run.scene, state, state, run.reference.energy, run.reference.scales);
      largest = std::max(largest, errors.energy);
    }
    const double seen = run.point("rk4", h).path.energy;
    if (steps <= Watch::most_looks) {  // at every step
      BOOST_TEST(std::abs(seen - largest) < 1e-13);
    } else {
      BOOST_TEST((seen <= largest + 1e-13 && seen > 0.5 * largest));
    }
  }
}

// Verlet's energy is right again after each period, to h^4. Equal looks at so many steps that not
// all are seen would be in step with it: 100 periods of 640 steps.
BOOST_AUTO_TEST_CASE(looks_are_not_in_step_with_the_motion) {
  constexpr int periods = 100, steps = 64000;
  static_assert(steps > Watch::most_looks);
  const double until = periods * 2 * M_PI / omega, h = until / steps,
               s = std::pow(h * omega / 2, 2);
  const Point point = oscillator(until).point("verlet", h);
  // One look in each 6.4 steps: none is farther from a crest than 13 steps, 1 - cos of 0.13.
  BOOST_TEST(point.path.energy >= s * 0.99);
  BOOST_TEST(point.path.energy <= s * (1 + 1e-3));
}

BOOST_AUTO_TEST_CASE(momenta_are_watched_where_some_are_kept) {
  const Watched orbit{load_scene("orbit"), 0.7};
  BOOST_TEST(orbit.point("verlet", 0.01).path.momentum < 1e-13);
  // Neither of these keeps it; the first one turns it up by h^2 of each step.
  BOOST_TEST(orbit.point("explicit_euler", 0.01).path.momentum > 1e-3);
  BOOST_TEST(orbit.point("rk4", 0.1).path.momentum > 1e-8);
  BOOST_TEST(std::isnan(oscillator(2).point("verlet", 0.01).path.momentum));
}

BOOST_AUTO_TEST_CASE(adaptive_methods_are_watched_as_well) {
  const Watched run{load_scene("orbit"), 0.7};
  for (const char* method : {"ida", "dprkn6", "arkode_erk4"}) {
    const double coarse = run.point(method, 1e-4).path.energy;
    const double fine = run.point(method, 1e-8).path.energy;
    BOOST_TEST(coarse > 0, method);
    BOOST_TEST(fine < 0.1 * coarse, method);
  }
}

BOOST_AUTO_TEST_CASE(beyond_the_horizon_the_modes_are_compared) {
  // Four masses in a row on soft springs, let go from the horizontal.
  const Watched run{drawn("chain", {{"nodes", 4}, {"stiffness", 1000}}), 12};
  BOOST_TEST_REQUIRE(run.reference.is_beyond_horizon());
  const double floor = run.reference.modal_shares_floor;
  BOOST_TEST((floor > 0 && floor < 0.5));
  const Point good = run.point("blanes_moan6", 1e-3), poor = run.point("implicit_euler", 0.05);
  BOOST_TEST(good.errors.position > far_apart);  // which nobody can help
  BOOST_TEST(good.path.energy < 1e-8);
  BOOST_TEST((good.path.modal_shares > 0 && good.path.modal_shares < 0.5));
  BOOST_TEST((poor.path.modal_shares > 0 && poor.path.modal_shares <= 1));
}

BOOST_AUTO_TEST_CASE(negative_control_unwatched_there_is_no_number) {
  const Watched run = oscillator(2);
  const Point point = measure_point(*find_method("verlet"), 0.01, run.scene, run.until,
                                    run.reference, {.seconds = 60, .repeats = 1});
  BOOST_TEST(std::isnan(point.path.energy));
  BOOST_TEST(std::isnan(run.point("verlet", 0.01).path.modal_shares));
}

BOOST_AUTO_TEST_SUITE_END()
