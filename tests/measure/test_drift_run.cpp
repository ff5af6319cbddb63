#include <boost/test/unit_test.hpp>

#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/measure/trend/drift_run.hpp"
#include "qddot/scene/scene_file.hpp"

BOOST_AUTO_TEST_SUITE(drift_run)

using namespace qddot;

namespace {

// Verlet's method with the positions' h^2 larger by d = 1/1000:
//   q_{n+1} = q_n + h v_n + (1 + d) h^2/2 a_n,   v_{n+1} = v_n + h/2 (a_n + a_{n+1}).
// The matrix of a step on q'' = -w^2 q has the determinant 1 - d h^2 w^2/2, by which energy falls.
class LeaningVerlet final : public Formula {
 public:
  using Formula::Formula;

  Outcome step(const State& now, double h, State& next) {
    Vec a(now.q.size()), b(now.q.size());
    force(now.q, a);
    a = a.cwiseQuotient(system().mass());
    next.q = now.q + h * now.v + (1 + 1e-3) * h * h / 2 * a;
    force(next.q, b);
    next.v = now.v + h / 2 * (a + b.cwiseQuotient(system().mass()));
    return Outcome::reached_end;
  }
};

struct Study {
  explicit Study(const std::string& name) : drawn(load_scene(name)) {}

  DriftRun of(const Method& method, double value, double h, double until) const {
    const MotionScales scales = motion_scales(scene, momenta, until);
    return run_drift(method, options_for(method, value, scene), scene, momenta, scales,
                     {.step_size = h, .until = until, .seconds = 60});
  }
  DriftRun of(const std::string& method, double h, double steps) const {
    return of(*find_method(method), h, h, steps * h);
  }

  Scene drawn;
  Model scene{drawn};
  Momenta momenta{drawn};
};

bool holds_zero(const Interval& interval) { return !interval.excludes_zero(); }

}  // namespace

BOOST_AUTO_TEST_CASE(explicit_eulers_growth_is_that_of_theory_where_it_blows_up_late_or_early) {
  // A step multiplies the energy of a vibration by 1 + (h w)^2; here w = 10 rad/s.
  const Study oscillator("oscillator");
  for (const double steps : {3e4, 4e4, 2e5}) {  // to e^3, e^4 and e^20 times the start
    const DriftRun run = oscillator.of("explicit_euler", 1e-3, steps);
    BOOST_TEST(verdict_name(run.energy.verdict) == "blows_up");
    BOOST_TEST(run.energy.rate.value == std::log1p(1e-4) / 1e-3,
               boost::test_tools::tolerance(1e-6));
  }
}

BOOST_AUTO_TEST_CASE(over_a_million_steps_verlet_does_not_drift_and_rk4_does) {
  const Study orbit("orbit");
  const DriftRun verlet = orbit.of("verlet", 0.02, 1e6);
  BOOST_TEST(holds_zero(verlet.energy.drift));
  BOOST_TEST(verdict_name(verlet.energy.verdict) == "bounded");
  // h^2 w^2/8 and thereabouts.
  BOOST_TEST(verlet.energy.oscillation > 1e-4);
  BOOST_TEST(verlet.energy.oscillation < 1e-2);
  // The interval is so narrow that a loss of a tenth of the oscillation over the run would be
  // visible.
  const double duration = 0.02 * 1e6;
  BOOST_TEST(verlet.energy.drift.high * duration < verlet.energy.oscillation / 10);

  const DriftRun rk4 = orbit.of("rk4", 0.02, 1e6);
  BOOST_TEST(rk4.energy.drift.high < 0);
}

BOOST_AUTO_TEST_CASE(one_coefficient_off_by_a_thousandth_is_caught) {
  Method leaning = *find_method("verlet");
  leaning.make = create<LeaningVerlet>;
  const double h = 0.02;
  const Study orbit("orbit"), oscillator("oscillator");
  const DriftRun wrong = orbit.of(leaning, h, h, 1e5 * h);
  BOOST_TEST(wrong.energy.drift.high < 0);
  BOOST_TEST(verdict_name(wrong.energy.verdict) != "bounded");
  // The determinant, with w = 10 rad/s.
  const DriftRun damped = oscillator.of(leaning, h, h, 2000);
  BOOST_TEST(
      damped.energy.drift.value == std::log1p(-1e-3 * 100 * h * h / 2) / h * damped.scales.excess,
      boost::test_tools::tolerance(0.02));
}

BOOST_AUTO_TEST_CASE(implicit_euler_dissipates_and_explicit_euler_grows_as_predicted) {
  const Study oscillator("oscillator");
  const double w = 10;
  for (const double h : {0.001, 0.01}) {
    const double rate = std::log1p(h * h * w * w) / h;  // E changes by 1 + h^2 w^2 a step
    const DriftRun falls = oscillator.of("implicit_euler", h, 1e5);
    BOOST_TEST(falls.scales.frequency == w, boost::test_tools::tolerance(1e-3));
    BOOST_TEST(verdict_name(falls.energy.verdict) == "dissipates");
    // E counts T and V alike, what falls steadily is not quite E: a ripple of h w/2.
    BOOST_TEST(falls.energy.damping_ratio == rate / (2 * w), boost::test_tools::tolerance(0.01));
    const DriftRun grows = oscillator.of("explicit_euler", h, 1e5);
    BOOST_TEST(verdict_name(grows.energy.verdict) == "blows_up");
    BOOST_TEST(grows.energy.rate.value == rate, boost::test_tools::tolerance(1e-3));
    BOOST_TEST(grows.energy.blow_up_time == std::log(11) / rate,
               boost::test_tools::tolerance(0.01));
  }
}

BOOST_AUTO_TEST_CASE(beyond_its_limit_verlet_blows_up_at_its_rate) {
  const Study oscillator("oscillator");
  const double h = 0.201, z = 100 * h * h;  // h w = 2.01
  // The larger root of x^2 - (2 - z) x + 1; energy grows with its square.
  const double root = (z - 2) / 2 + std::sqrt((z - 2) * (z - 2) / 4 - 1);
  const DriftRun run = oscillator.of("verlet", h, 1e5);
  BOOST_TEST(verdict_name(run.energy.verdict) == "blows_up");
  BOOST_TEST(run.energy.rate.value == 2 * std::log(root) / h, boost::test_tools::tolerance(0.01));
  BOOST_TEST(verdict_name(oscillator.of("verlet", 0.199, 1e5).energy.verdict) == "bounded");
}

BOOST_AUTO_TEST_CASE(what_only_rounds_is_called_so) {
  const Study oscillator("oscillator");
  const DriftRun exact = oscillator.of("exact", 0.05, 1e6);
  BOOST_TEST(verdict_name(exact.energy.verdict) == "round_off");
  BOOST_TEST(verdict_name(oscillator.of("verlet", 0.05, 1e6).energy.verdict) == "bounded");
}

BOOST_AUTO_TEST_CASE(momenta_are_looked_at_where_they_stay) {
  const Study free("pair"), pinned("orbit"), cloth("cloth");
  const DriftRun pair = free.of("rk4", 0.02, 1e5), orbit = pinned.of("rk4", 0.05, 1e5);
  BOOST_TEST_REQUIRE(pair.linear.has_value());
  BOOST_TEST(!pair.linear->drift.excludes_zero());
  BOOST_TEST(!orbit.linear.has_value());
  BOOST_TEST_REQUIRE(orbit.angular.has_value());
  BOOST_TEST(orbit.angular->drift.excludes_zero());  // RK4's order alone keeps it
  BOOST_TEST(!pinned.of("verlet", 0.05, 1e5).angular->drift.excludes_zero());
  BOOST_TEST(!cloth.momenta.has_linear());
  BOOST_TEST(!cloth.momenta.has_angular());
}

BOOST_AUTO_TEST_CASE(the_kinetic_scale_and_the_excess_are_those_of_the_motion) {
  const Study oscillator("oscillator");  // 1 m from rest, 100 N/m
  const MotionScales scales = motion_scales(oscillator.scene, oscillator.momenta, 100);
  BOOST_TEST(scales.energy == 50, boost::test_tools::tolerance(1e-14));
  // Verlet at h w = 1/2 oscillates by h^2 w^2/4.
  BOOST_TEST(scales.kinetic == 50, boost::test_tools::tolerance(0.07));
  BOOST_TEST(scales.excess * scales.kinetic == 50, boost::test_tools::tolerance(1e-9));
}

BOOST_AUTO_TEST_CASE(without_k_the_trend_is_that_of_the_energy) {
  // The oscillator's forces alone: 1 m from rest, 100 N/m.
  class Pull final : public System {
   public:
    Pull() : System(Vec::Ones(1)) {}
    double potential(const At& at) const override { return 50 * at.q.squaredNorm(); }
    void force(const At& at, MutableVec f) const override { f = -100 * at.q; }
  };
  const auto own = std::make_shared<const Model>(std::make_shared<const Pull>(),
                                                 State{0, Vec::Ones(1), Vec::Zero(1)}, 1);
  const Options options{.step_size = 0.02};
  for (const auto& [method, verdict] :
       {std::pair{"verlet", "bounded"}, std::pair{"rk4", "drifts"}}) {
    const DriftRun run = energy_trend(own, Momenta(), *find_method(method), options, 2000);
    BOOST_TEST(verdict_name(run.energy.verdict) == verdict);
    BOOST_TEST(!run.linear.has_value());
    BOOST_TEST(!run.angular.has_value());
  }
  // The kinetic energy is looked at every 0.05 rad, where it comes within 6e-4 of its largest.
  const MotionScales scales = motion_scales(*own, Momenta(), 100);
  BOOST_TEST(scales.energy == 50);
  BOOST_TEST(scales.kinetic == 50, boost::test_tools::tolerance(1e-3));
}

BOOST_AUTO_TEST_CASE(a_run_out_of_time_has_its_verdict_over_what_it_reached) {
  const Study orbit("orbit");
  const MotionScales scales = motion_scales(orbit.scene, orbit.momenta, 1e6);
  const Method& method = *find_method("verlet");
  const DriftRun run =
      run_drift(method, options_for(method, 0.02, orbit.scene), orbit.scene, orbit.momenta, scales,
                {.step_size = 0.02, .until = 1e9, .seconds = 0.3});
  BOOST_TEST((run.summary.outcome == Outcome::over_budget));
  BOOST_TEST(verdict_name(run.energy.verdict) == "bounded");
  // A verdict on so little of the run is none on the run.
  BOOST_TEST(verdict_name(verdict_at(run, 1e9)) == "unknown");
  const std::string words = verdict(run, 1e9);
  BOOST_TEST(words.starts_with("too short to tell from "));
  BOOST_TEST(words.find("% of the run, when its time was up; over that: bounded") != words.npos);
  // The same of a run that should have gone but a little further.
  const double most = 1.25 * run.summary.t_reached;
  BOOST_TEST(verdict_name(verdict_at(run, most)) == "bounded");
  BOOST_TEST(verdict(run, most).starts_with("bounded: "));
  BOOST_TEST(verdict(run, most).find("; over 80 % of the run, when its time was up") != words.npos);
}

BOOST_AUTO_TEST_CASE(a_run_cut_short_has_a_verdict_where_nothing_more_can_come) {
  const Study oscillator("oscillator");
  const double h = 0.01, until = 1e4 * h;
  for (const char* method : {"implicit_euler", "explicit_euler", "verlet"}) {
    DriftRun run = oscillator.of(method, h, 1e4);
    run.summary.outcome = Outcome::over_budget;
    const bool is_over = run.energy.verdict != Verdict::bounded;  // all energy gone, or blown up
    BOOST_TEST((verdict_at(run, 100 * until) == Verdict::unknown) == !is_over);
    BOOST_TEST((verdict_at(run, until) == run.energy.verdict));
  }
}

BOOST_AUTO_TEST_SUITE_END()
