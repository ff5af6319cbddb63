#include "qddot/measure/speed/sweep_bound.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/measure/motion/resolved_frequency.hpp"

namespace qddot::measure {
namespace {

// A first run at least so long [s] is a sample; shorter ones are timed in batches of `batch` [s].
constexpr double sample_from = 0.1, batch = 1e-4;
// What is watched ends at some of its steps to be looked at, no more than a quarter of them; with
// what it takes to look, that is less than a second run.
constexpr double watched = 2;
// Threads that wait for the end of their time, and the journal [s].
constexpr double around = 1e-3;
// A point of so many seconds shows what else there is.
constexpr double long_enough = 0.01;
// From 0.1 to 1e-15, a power of ten apart.
constexpr int most_tolerances = 15;
// To both sides of the first.
constexpr int most_rungs = 121;
// Newton's iterations become fewer with shorter steps, and save so much at most.
constexpr double saved_at_most = 10;
// So many coarse runs over the budget are forgiven to implicit steps.
constexpr int forgiven = 3;
// A ladder lacks up to 42 rungs near its limit where errors fall as the order says, whatever that
// is, and some more where runs beyond it come to their end by luck; all of at most eight times the
// steps of the limit.
constexpr int most_lacking = 50;
constexpr double refined_up_to = 8;
// No explicit method takes more forces a step (Kahan and Li's has the most).
constexpr double most_forces = 17;
// What a step does beside its forces differs from method to method, and w_max rises on the way: it
// is that of the start which is known.
constexpr double dearer_step = 2, stiffer_on_the_way = 2;

// Whether all forces are taken at each step: multirate methods resolve w_max of the soft ones.
bool is_plainly_explicit(const Method& method) {
  return !method.is(Trait::implicit) && !method.asks(Need::split_forces);
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
  if (seconds >= long_enough) slower_ = std::max(slower_, slower_ * seconds / expected);
  if (reached && point.method->knob == Knob::step_size && is_plainly_explicit(*point.method) &&
      point.counts.force_evaluations > 0) {
    force_ = std::max(force_, point.time / static_cast<double>(point.counts.force_evaluations));
    if (w_ == 0) w_ = resolved_frequency(*point.method, scene_->system(), scene_->initial().q);
  }
}

double SweepBound::point(double run) const {
  // The run that is watched is set up anew.
  const double setups = (effort_.watch ? 2 : 1) * setup_;
  return slower_ * (point_seconds_at_most(run, effort_) + setups + around);
}

double SweepBound::near_limit(const Method& method) const {
  const double limit = linear_limit(method);
  if (limit == 0) return 0;
  double longest = effort_.seconds;
  if (force_ > 0 && std::isfinite(limit) && is_plainly_explicit(method)) {
    const double steps = refined_up_to * std::max(1.0, stiffer_on_the_way * until_ * w_ / limit);
    longest = std::min(longest, steps * most_forces * dearer_step * force_);
  }
  // They are the closer the nearer to the limit: at most evenly spread over the octaves.
  double sum = 0;
  for (int i = 0; i < most_lacking; ++i)
    sum += point(longest * std::pow(refined_up_to, -static_cast<double>(i) / most_lacking));
  return sum;
}

double SweepBound::whole(const Method& method) const {
  const double limit = effort_.seconds;
  if (method.order == 0) return point(limit);
  if (method.knob == Knob::rtol) return most_tolerances * point(limit);
  // The finest run that ends within the limit may take all of it, and those before it less, as they
  // take fewer steps; the one after it is stopped, or not begun.
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

}  // namespace qddot::measure
