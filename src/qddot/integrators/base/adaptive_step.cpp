#include "qddot/integrators/base/adaptive_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <boost/math/quadrature/gauss.hpp>
#include <fmt/format.h>

#include "qddot/model/machine_epsilon.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {
namespace {

// The controller aims at this fraction of the step that would just be accepted. It changes a step
// by no more than these factors at once.
constexpr double safety = 0.9, smallest_factor = 0.2, largest_factor = 5;
// The exponents of the last error and of the one before it, times the order of the errors; smaller
// errors than the third number count as that.
constexpr double proportional = 0.7, integral = 0.4, smallest_error = 1e-4;
// The factor after an attempt without an error estimate.
constexpr double factor_of_failure = 0.25;
// A length that turns within this many tolerances of zero has no sign that can be told: errors of
// steps add up. With 1, two of a thousand runs of dprkn at 1e-3 to 1e-5 took the wrong way.
constexpr double unknown_sign = 4;
// A step is stretched by up to this factor to meet the end.
constexpr double stretch = 1.01;
// The first step, as a fraction of the run, if the start and its rate of change say nothing: a
// start of less than the second number of its tolerance.
constexpr double blind_step = 1e-6, nothing = 1e-5;
// A polynomial is trusted if its change without one instant is at most so many tolerances.
constexpr double trusted = 0.5;
// A step ends before a jump by this part of its length.
constexpr double short_of_jump = 1e-6;
// A step over a jump takes some roundings of the time. It is longer for slow positions, whose
// rounding takes longer to cross, by at most this part of the step before.
constexpr double slowest_over_jump = 1e-6;
constexpr double roundings_over_jump = 8 * machine_epsilon;

}  // namespace

AdaptiveStep::AdaptiveStep(SystemRun& run, const Accuracy& accuracy)
    : Formula(run),
      accuracy_(accuracy),
      atol_q_(options().atol > 0 ? options().atol : options().rtol * options().length),
      atol_v_(options().atol > 0 ? options().atol : options().rtol * options().speed),
      per_mass_(system().mass().cwiseInverse()),
      f_(system().size()),
      error_q_(system().size()),
      error_v_(system().size()),
      instants_(std::max<std::size_t>(accuracy.instants, 2) + 1,
                {{0, Vec(system().size()), Vec(system().size())}, Vec(system().size())}),
      aside_{instants_[0], instants_[0]},
      kinks_(system()) {
  // No polynomial leads over a jump.
  if (kinks_.has_kinks() && accuracy_.instants > 2) accuracy_.instants = 0;
}

void AdaptiveStep::acceleration(const At& at, MutableVec a) {
  force(at, f_);
  multiply(f_, per_mass_, a);
}

double AdaptiveStep::norm(const State& at, const Vec& q, const Vec& v) const {
  const double rtol = options().rtol;
  const double sum = squared_error(q, rtol, at.q, atol_q_) + squared_error(v, rtol, at.v, atol_v_);
  return std::sqrt(sum / static_cast<double>(2 * q.size()));
}

void AdaptiveStep::start(const State& state) {
  newest_ = 0;
  count_ = 1;
  last().state = state;
  acceleration({state.t, state.q}, last().a);
  ended_ = last().a.allFinite() ? Outcome::reached_end : Outcome::not_finite;
  if (ended_ == Outcome::reached_end) h_ = first_step();
  last_error_ = 1;
  was_rejected_ = false;
  h_before_jump_ = 0;
  judged_ = -INFINITY;
  moved();
  creep_ = Creep(state.t);
}

// Let d0, d1 and d2 be the sizes of y = (q, v), y' and y'' in tolerances. h_0 changes y by a
// hundredth of itself. h_1 is where the term d1 w^p h^(p+1)/(p+1)! of a Taylor series, with the
// rate w = max(d1/d0, d2/d1) by which derivatives grow, is a tenth of the tolerance. Nothing here
// depends on units.
double AdaptiveStep::first_step() {
  const auto& [now, a] = last();
  const double d0 = norm(now, now.q, now.v), d1 = norm(now, now.v, a);
  const double whole = t_end() - now.t, blind = blind_step * whole;
  const double h0 = d0 > nothing && d1 > 0 ? std::min(0.01 * d0 / d1, whole) : blind;
  State& ahead = last(instants_.size() - 1).state;
  ahead.q = now.q + h0 * now.v;
  acceleration({now.t + h0, ahead.q}, error_v_);
  error_v_ = (error_v_ - a) / h0;
  const double d2 = norm(now, a, error_v_);
  const double w = std::max(d0 > nothing ? d1 / d0 : 0, d1 > 0 ? d2 / d1 : 0);
  const double terms = accuracy_.error_order + 1;
  const double h1 =
      w > 0 ? std::pow(0.1 * std::tgamma(terms + 1) * (w / d1), 1 / terms) / w : 100 * h0;
  const double h = std::min(100 * h0, h1);
  return h > 0 ? h : blind;
}

// After the last step, states are shown by the instants that there are.
bool AdaptiveStep::has_passed(double t) {
  return ended_ == Outcome::reached_end ? can_show(t) : last().state.t >= t;
}

Outcome AdaptiveStep::step(double) {
  if (ended_ == Outcome::reached_end) ended_ = take_step();
  return ended_;
}

void AdaptiveStep::show_last(State& state) { state = last().state; }

// Whether the kept instants determine the state at t. Their polynomial is most accurate in its
// middle; at the end of the run no more instants come.
bool AdaptiveStep::can_show(double t) {
  if (last().state.t == t_end()) return true;
  if (accuracy_.instants == 0) return last().state.t >= t;
  return count_ >= accuracy_.instants && last(accuracy_.instants / 2 - 1).state.t >= t;
}

Outcome AdaptiveStep::show(double t, State& state) {
  std::size_t before = 0;
  while (last(before).state.t > t) ++before;
  const Instant& from = last(before);
  if (from.state.t == t) {
    state = from.state;
    return Outcome::reached_end;
  }
  std::array<const Instant*, most_instants> list;
  const std::size_t used = std::min(count_, accuracy_.instants);
  for (std::size_t i = 0; i < used; ++i) list[i] = &last(i);
  const auto instants = std::span(list).first(used);
  if (!is_trusted(instants, from)) return step_aside(from, t, state);
  interpolate(instants, t, state);
  state.work = from.state.work;
  if (is_driven()) state.work.driven += work_between(instants, from.state.t, t);
  return Outcome::reached_end;
}

double AdaptiveStep::work_between(std::span<const Instant* const> instants, double from, double t) {
  constexpr unsigned points = 10;
  const auto power_at = [&](double s) {
    interpolate(instants, s, between_);
    return power({s, between_.q}).driven;
  };
  return boost::math::quadrature::gauss<double, points>::integrate(power_at, from, t);
}

// Without the instant t_k the polynomial changes by prod_{i != k} (t - t_i)^3 times one of second
// degree. If that is zero at both places, its slope is not.
bool AdaptiveStep::is_trusted(std::span<const Instant* const> instants, const Instant& from) {
  if (instants.size() < 3) return false;
  const double t = from.state.t;
  if (judged_ == t) return judged_trusted_;
  judged_ = t;
  double end = last().state.t;
  for (const Instant* instant : instants) {
    if (instant->state.t > t) end = std::min(end, instant->state.t);
  }
  // The newest or the oldest; both ends of the step are among the rest.
  const double ahead = instants.front()->state.t - end, behind = t - instants.back()->state.t;
  const std::size_t farthest = ahead > behind ? 0 : instants.size() - 1;
  judged_trusted_ = true;
  for (const double part : {0.25, 0.75}) {
    change_without(farthest, instants, t + part * (end - t), error_q_, error_v_);
    judged_trusted_ = judged_trusted_ && norm(from.state, error_q_, error_v_) <= trusted;
  }
  return judged_trusted_;
}

Outcome AdaptiveStep::step_aside(const Instant& from, double t, State& state) {
  moved();
  const Instant* now = &from;
  double h = t - from.state.t;
  Outcome outcome = Outcome::reached_end;
  for (std::size_t place = 0; now->state.t < t;) {
    Instant& next = aside_[place];
    const double left = t - now->state.t;
    next.state.t = h < left ? now->state.t + h : t;
    h = next.state.t - now->state.t;
    outcome = must_stop() ? Outcome::over_budget : attempt(*now, h, next, error_q_, error_v_);
    if (outcome == Outcome::reached_end) outcome = run_.check_step(now->state, next.state);
    if (outcome != Outcome::reached_end) break;
    const double error = norm(now->state, error_q_, error_v_);
    const double factor = factor_after(error);
    // A step that cannot be shorter crosses a jump.
    if (error > 1 && now->state.t + factor * h > now->state.t) {
      h *= factor;
      continue;
    }
    now = &next;
    if (next.state.t == t) break;
    complete(next);
    moved();
    place = 1 - place;
  }
  state = outcome == Outcome::reached_end ? now->state : from.state;
  moved();
  return outcome;
}

double AdaptiveStep::factor_after(double error) const {
  const double power = 1.0 / (accuracy_.error_order + 1);
  const double factor = std::isfinite(error) ? safety * std::pow(error, -power) : factor_of_failure;
  return std::clamp(factor, smallest_factor, 1.0);
}

double AdaptiveStep::step_size(double t, double longest) const {
  const double h = std::min(h_, longest), left = t_end() - t;
  if (h_before_jump_ > 0) return std::min(h, left);  // h_ ends just before the jump
  if (left <= stretch * h) return left;
  // Two equal steps to the end are better than one and a short rest.
  return left < 2 * h ? left / 2 : h;
}

Outcome AdaptiveStep::take_step() {
  const Instant& now = last();
  Instant& next = last(instants_.size() - 1);
  const double t = now.state.t, power = 1.0 / (accuracy_.error_order + 1);
  const double longest = longest_step(now);
  for (;;) {
    if (must_stop()) return Outcome::over_budget;
    const double planned = step_size(t, longest);
    next.state.t = planned == t_end() - t ? t_end() : t + planned;
    const double h = next.state.t - t;  // as rounded

    Outcome outcome = h > 0 ? attempt(now, h, next, error_q_, error_v_) : Outcome::step_too_small;
    double error = INFINITY;
    if (outcome == Outcome::reached_end) {
      error = norm(now.state, error_q_, error_v_);
      outcome = std::isfinite(error) ? run_.check_step(now.state, next.state) : Outcome::not_finite;
    }
    const bool may_jump = kinks_.has_kinks();
    if (outcome == Outcome::reached_end && (error <= 1 || may_jump)) {
      complete(next);
      if (!std::isfinite(next.a.sum())) outcome = Outcome::not_finite;
    }
    const Jump jump_here =
        may_jump && outcome == Outcome::reached_end ? jump(now, next, h, error) : Jump::none;
    if (jump_here == Jump::unknown) return Outcome::solver_failed;
    if (jump_here == Jump::ahead) {
      ++counts().rejected;
      continue;
    }
    if (jump_here == Jump::over) error = std::min(error, 1.0);
    if (outcome == Outcome::not_finite) error = INFINITY;
    if (error <= 1) {
      if (outcome != Outcome::reached_end) return outcome;
      moved();
      accept(h_ > longest);
      const double factor =
          safety * std::pow(error, -proportional * power) * std::pow(last_error_, integral * power);
      h_ = h * std::clamp(factor, smallest_factor, was_rejected_ ? 1 : largest_factor);
      last_error_ = std::max(error, smallest_error);
      was_rejected_ = false;
      if (jump_here == Jump::over) h_ = std::exchange(h_before_jump_, 0);
      return creep_.is_found(last().state.t, t_end()) ? Outcome::step_too_small
                                                      : Outcome::reached_end;
    }
    if (!(t + smallest_factor * h > t)) {
      return std::isfinite(error) ? Outcome::step_too_small : outcome;
    }
    h_ = h * factor_after(error);
    was_rejected_ = true;
    ++counts().rejected;
  }
}

AdaptiveStep::Jump AdaptiveStep::jump(const Instant& now, const Instant& next, double h,
                                      double error) {
  const auto change = kinks_.first(now, next);
  if (!change) return Jump::none;
  const double size = now.state.q.lpNorm<Eigen::Infinity>();
  const double tolerance = unknown_sign * (atol_q_ + options().rtol * size);
  const auto tell = [&](double nearest) {
    set_message(
        fmt::format("at t = {:.6g} s a spring on a line comes within {:.2g} m of length zero, "
                    "where its force jumps, and whether it turns over or back is not known to "
                    "the tolerance of {:.2g} m: take a smaller tolerance",
                    now.state.t, nearest, tolerance));
    return Jump::unknown;
  };
  if (!change->is_certain) {
    if (error <= 1 && change->nearest <= tolerance) return tell(change->nearest);
    h_ = change->part * h;
    was_rejected_ = true;
    return Jump::ahead;
  }
  if (h_before_jump_ == 0) over_jump_ = 0;
  h_before_jump_ = std::max(h_before_jump_, h_);
  // The rounding of the time, and the time in which positions change by their rounding.
  const double rounded = size / change->speed;
  const double least = roundings_over_jump * std::max(std::abs(now.state.t), h_before_jump_) +
                       std::min(roundings_over_jump * rounded, slowest_over_jump * h_before_jump_);
  over_jump_ = std::max(over_jump_, least);
  if (h > 2 * over_jump_) {
    const double before = std::min((1 - short_of_jump) * change->part * h, h - least);
    h_ = std::max(before, over_jump_);
    return Jump::ahead;
  }
  if (!change->is_at_end) {
    const double depth = kinks_.depth(now, next);
    return depth <= tolerance ? tell(depth) : Jump::over;
  }
  // Far from the origin a length stays zero for longer.
  h_ = over_jump_ = 2 * h;
  return Jump::ahead;
}

void AdaptiveStep::accept(bool is_limited) {
  newest_ = (newest_ + 1) % instants_.size();
  count_ = std::min(count_ + 1, instants_.size());
  ++counts().steps;
  run_.note(last().state);
  if (is_limited) ++counts().stability_limited_steps;
}

}  // namespace qddot
