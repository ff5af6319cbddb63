#include "qddot/measure/speed/sweep_bound.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/analysis/frequency_bound.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/scene_file.hpp"

namespace qddot::inline measure {
namespace {

// A first run at least so long [s] is a sample; shorter ones are timed in batches of `batch` [s].
constexpr double sample_from = 0.1, batch = 1e-4;
// A watched run is looked at after some of its steps, a quarter of them at most. The time of the
// looks themselves is part of `slower_`.
constexpr double watched = 1.25;
// Time of the threads for time limits, and of the journal [s].
constexpr double around = 1e-3;
// A point that takes this fraction of the limit or more shows the overhead and not a disturbance. A
// run of so many steps shows the time of one.
constexpr double long_enough = 0.5;
constexpr int many_steps = 100;
// 0.1 to 1e-15, a power of ten apart.
constexpr int most_tolerances = 15;
// Rungs to both sides of the first.
constexpr int most_rungs = 121;
// Shorter steps need fewer Newton iterations, which saves at most this factor.
constexpr double saved_at_most = 10;
// So many coarse runs of an implicit method may be over budget before its sweep ends.
constexpr int forgiven = 3;
// A ladder is refined by up to 42 rungs near its limit, or 35 from order 3 on, if errors fall by
// the order. Some more follow if runs beyond the limit reach their end by chance. All have at most
// eight times the steps of the limit.
constexpr int most_lacking = 50, most_lacking_of_high_order = 40, high_order = 3;
constexpr double refined_up_to = 8;
// The work of a step beside its forces differs between methods. w_max may rise during a run; only
// that of the start is known.
constexpr double dearer_step = 2, stiffer_on_the_way = 2;
// Implicit methods with steps as short as explicit ones, at h w = 1, do not blow up.
constexpr double limit_of_implicit = 1;

// Whether all forces are taken at each step: multirate methods resolve w_max of the soft ones.
bool is_plainly_explicit(const Method& method) {
  return !method.is(Trait::implicit) && !method.asks(Need::split_forces);
}

// Forces per step of an explicit method, those of its start included; zero if the method cannot run
// a mass on a spring.
double forces_a_step(const Method& method) {
  constexpr int steps = 64;
  static const ReducedScene oscillator(load_scene("oscillator"));
  if (!applies_to(method, oscillator.system())) return 0;
  const double h = 0.1 / frequency_bound(oscillator.system(), oscillator.initial().q);
  State state = oscillator.initial();
  const auto integrator = make_integrator(method, oscillator.system(), {.step_size = h});
  const Counts counts = integrator->advance(state, steps * h).counts;
  return static_cast<double>(counts.force_evaluations) / steps;
}

}  // namespace

double point_seconds_at_most(double run, const Effort& effort) {
  // No sample is begun that would end after half of the limit, but for the first.
  const double timed = std::max(run, effort.seconds / 2);
  const double all =
      run >= sample_from ? timed : run + std::min(effort.repeats * (run + batch), timed);
  return all + (effort.watch ? watched * run : 0);
}

SweepBound::SweepBound(const ReducedScene& scene, double until, const Effort& effort)
    : scene_(&scene), until_(until), effort_(effort) {}

void SweepBound::learn(const Point& point, double seconds) {
  setup_ = std::max(setup_, point.setup);
  const bool reached = point.outcome == Outcome::reached_end;
  const double expected = this->point(reached ? point.time : effort_.seconds);
  if (expected >= long_enough * effort_.seconds)
    slower_ = std::max(slower_, slower_ * seconds / expected);
  const auto steps = static_cast<double>(point.counts.steps);
  if (!reached || point.method->knob != Knob::step_size || steps < many_steps) return;
  if (w_ == 0) w_ = frequency_bound(scene_->system(), scene_->initial().q);
  if (!is_plainly_explicit(*point.method)) {
    step_ = std::max(step_, point.time / steps);
  } else if (point.counts.force_evaluations > 0) {
    force_ = std::max(force_, point.time / static_cast<double>(point.counts.force_evaluations));
  }
}

double SweepBound::point(double run) const {
  // The run that is watched is set up anew.
  const double setups = (effort_.watch ? 2 : 1) * setup_;
  return slower_ * (point_seconds_at_most(run, effort_) + setups + around);
}

double SweepBound::step(const Method& method) const {
  if (!is_plainly_explicit(method)) return step_;
  const auto [known, is_new] = forces_.try_emplace(&method, 0);
  if (is_new) known->second = forces_a_step(method);
  return known->second * force_;
}

double SweepBound::near_limit(const Method& method) const {
  if (linear_limit(method) == 0) return 0;
  const double limit =
      std::isfinite(linear_limit(method)) ? linear_limit(method) : limit_of_implicit;
  double longest = effort_.seconds;
  if (const double seconds = step(method); seconds > 0) {
    const double steps = refined_up_to * std::max(1.0, stiffer_on_the_way * until_ * w_ / limit);
    longest = std::min(longest, steps * dearer_step * seconds);
  }
  // They are the closer the nearer to the limit: at most evenly spread over the octaves.
  const int count = method.order < high_order ? most_lacking : most_lacking_of_high_order;
  double sum = 0;
  for (int i = 0; i < count; ++i)
    sum += point(longest * std::pow(refined_up_to, -static_cast<double>(i) / count));
  return sum;
}

double SweepBound::whole(const Method& method) const {
  const double limit = effort_.seconds;
  if (method.order == 0) return point(limit);
  if (method.knob == Knob::rtol) return most_tolerances * point(limit);
  // The finest run that ends within the limit may take all of it. The runs before it take less,
  // since they have fewer steps; the one after it is stopped or never started.
  const bool implicit = method.is(Trait::implicit);
  const double rung = std::pow(4.0, -1.0 / method.order);
  double sum = (limit + setup_) * (implicit ? 1 + forgiven : 1);
  double run = limit * (implicit ? saved_at_most : 1);
  for (int i = 0; i < most_rungs; ++i, run *= rung) sum += point(std::min(limit, run));
  return sum + near_limit(method);
}

double SweepBound::left(const Method& method, int points, double spent) const {
  const double left = std::max(0.0, whole(method) - spent);
  if (method.knob != Knob::rtol || method.order == 0) return left;
  return std::min(left, std::max(0, most_tolerances - points) * point(effort_.seconds));
}

}  // namespace qddot::inline measure
