#include <cmath>
#include <random>

#include <boost/test/unit_test.hpp>

#include "experiments/kit/sweep_progress.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/resolved_frequency.hpp"
#include "qddot/measure/speed/ladder_points.hpp"
#include "qddot/scene/scene_file.hpp"

BOOST_AUTO_TEST_SUITE(sweep_progress)

using namespace qddot;

namespace {

constexpr double until = 0.1;  // [s]

// What methods take and miss by on a scene, drawn: no run is made. Time goes on as if they were.
class DrawnStudy {
 public:
  DrawnStudy(unsigned seed, const Effort& effort) : random_(seed), effort_(effort) {
    force_ = std::pow(10, between(-7, -3));
  }

  double now = 0;  // [s]

  void begin(const Method& method, double w) {
    // What is known of each method: a limit near the theory's, an order that is nearly its own, its
    // iterations.
    const double theory = std::clamp(linear_limit(method), 0.5, 10.0);
    stable_steps_ =
        method.is(Trait::implicit) && draw() < 0.5 ? 0 : between(0.7, 2) * until * w / theory;
    order_ = method.order * between(0.6, 1.2);
    error_ = std::pow(10, between(-3, 0.3));
    step_ = force_ * (method.is(Trait::implicit) ? between(5, 100) : between(1, 17));
    saved_ = method.is(Trait::implicit) ? between(1, 10) : 1;
    rounding_ = std::pow(10, between(-18, -9));  // the least ones leave the end to the limits
  }

  Point take(const Method& method, double value) {
    Point point{.method = &method, .value = value, .outcome = Outcome::reached_end};
    point.setup = 10 * force_;
    now += 2 * point.setup;
    const bool fixed = method.knob == Knob::step_size;
    const double steps =
        fixed ? std::round(until / value) : 20 * std::pow(0.1 / value, 1 / std::max(1.0, order_));
    // Iterations become fewer from a hundred steps on to a million.
    const double part = std::clamp(std::log10(steps) / 4 - 0.5, 0.0, 1.0);
    const double run = steps * step_ * std::pow(saved_, -part);
    if (fixed && steps < stable_steps_) {
      point.outcome = Outcome::diverged;
      now += std::min(run, effort_.seconds) * draw();
      return point;
    }
    if (run > effort_.seconds) {
      point.outcome = Outcome::over_budget;
      now += effort_.seconds;
      return point;
    }
    point.time = run;
    point.counts.steps = static_cast<std::int64_t>(steps);
    point.counts.force_evaluations =
        static_cast<std::int64_t>(steps * std::max(1.0, step_ / force_));
    const double scaled = fixed ? steps / std::max(20.0, stable_steps_) : steps / 20;
    point.errors.position = error_ * std::pow(scaled, -order_) + rounding_;
    spend(run);
    return point;
  }

 private:
  double draw() { return std::uniform_real_distribution<>(0, 1)(random_); }
  double between(double low, double high) { return low + (high - low) * draw(); }

  // As measure_point times a run, and one that is watched and a quarter longer.
  void spend(double run) {
    now += run;
    int samples = run >= 0.1 ? 1 : 0;
    const double batch = std::ceil(std::min(1e-4 / run, 1e5)) * run;
    for (double spent = samples * run;
         samples < effort_.repeats && (samples == 0 || spent + run < effort_.seconds / 2);
         ++samples) {
      now += std::max(run, batch);
      spent += std::max(run, batch);
    }
    if (effort_.watch) now += 1.25 * run;
  }

  std::mt19937 random_;
  Effort effort_;
  double force_, stable_steps_ = 0, order_ = 1, error_ = 1, step_ = 1, saved_ = 1, rounding_ = 0;
};

struct Promise {
  std::string method;
  double made = 0, left = 0;  // when, and what was said [s]
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_point_takes_no_longer_than_is_said) {
  const Watch* no_watch = nullptr;
  const Effort effort{.seconds = 1, .repeats = 5, .watch = no_watch};
  BOOST_TEST(point_seconds_at_most(1, effort) == 1);      // timed by the run itself
  BOOST_TEST(point_seconds_at_most(0.2, effort) == 0.5);  // until half of the limit
  // Once untimed, then five times, each with what fills a tenth of a millisecond.
  BOOST_TEST(point_seconds_at_most(0.01, effort) == 0.01 + 5 * (0.01 + 1e-4));
}

BOOST_AUTO_TEST_CASE(no_sweep_takes_longer_than_is_said) {
  const ReducedScene scene(load_scene("cloth"));
  const Scene start = load_scene("cloth");
  Reference reference;
  reference.end.t = until;
  reference.certified.position = 1e-16;
  const Watch watch(start, scene, until, reference);
  double nearest = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Effort effort{.seconds = 0.5, .repeats = 5, .watch = &watch};
    DrawnStudy study(seed, effort);
    SweepBound bound(scene, until, effort);
    effort.recall = [&](const Method& method, double value, const Effort::Take&) {
      const double before = study.now;
      const Point point = study.take(method, value);
      bound.learn(point, study.now - before);
      return point;
    };
    for (const Method& method : qddot::methods()) {
      if (!applies_to(method, scene.system())) continue;
      study.begin(method, resolved_frequency(method, scene.system(), scene.initial().q));
      const double said = bound.whole(method), begun = study.now;
      measure_ladder(method, scene, until, reference, effort, [](const Point&) {});
      const double took = study.now - begun;
      BOOST_TEST(took <= said, seed << ": " << method.name << " took " << took << " s of " << said);
      nearest = std::max(nearest, took / said);
    }
  }
  BOOST_TEST(nearest > 0.5);  // a bound that nothing comes near to is of no use
}

BOOST_AUTO_TEST_CASE(what_is_left_is_never_more_than_was_said) {
  const ReducedScene scene(load_scene("cloth"));
  Reference reference;
  reference.end.t = until;
  reference.certified.position = 1e-16;
  std::vector<const Method*> methods;
  for (const Method& method : qddot::methods()) {
    if (applies_to(method, scene.system())) methods.push_back(&method);
  }
  BOOST_TEST_REQUIRE(methods.size() > 40u);
  // The watch is not called, as no run is made; it only counts.
  const Scene start = load_scene("cloth");
  const Watch watch(start, scene, until, reference);
  int said = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Effort effort{.seconds = seed % 2 ? 0.5 : 10, .repeats = 5, .watch = &watch};
    DrawnStudy study(seed, effort);
    Progress shown({.now = [&] { return study.now; },
                    .columns = [] { return std::size_t{80}; },
                    .write = [](std::string_view) {}});
    shown.start("work_precision", Progress::Form::line);
    SweepProgress progress(methods, SweepBound(scene, until, effort), "", shown);
    std::vector<Promise> promises;
    effort.recall = progress.seen([&](const Method& method, double value, const Effort::Take&) {
      promises.push_back({method.name, study.now, progress.left().value()});
      return study.take(method, value);
    });
    for (const Method* method : methods) {
      study.begin(*method, resolved_frequency(*method, scene.system(), scene.initial().q));
      measure_ladder(*method, scene, until, reference, effort,
                     [&](const Point& p) { progress.take(p); });
      progress.finish();
    }
    for (const Promise& promise : promises) {
      BOOST_TEST(promise.made + promise.left >= study.now,
                 seed << ": " << promise.method << " at " << promise.made << " of " << study.now
                      << " s, at most " << promise.left << " left");
      said += promise.left < 4 * (study.now - promise.made);
    }
    BOOST_TEST(progress.left().value() == 0);
  }
  BOOST_TEST(said > 0);
}

BOOST_AUTO_TEST_SUITE_END()
