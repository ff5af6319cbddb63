#include "qddot/integrators/base/adaptive_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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
// A step is stretched by up to this factor to meet the end.
constexpr double stretch = 1.01;
// The first step, as a fraction of the run, if the start and its rate of change say nothing.
constexpr double blind_step = 1e-6;
// A step ends before a jump by this part of its length.
constexpr double short_of_jump = 1e-6;
// A step over a jump takes some roundings of the time. It is longer for slow positions, whose
// rounding takes longer to cross, by at most this part of the step before.
constexpr double slowest_over_jump = 1e-6;
constexpr double roundings_over_jump = 8 * machine_epsilon;

}  // namespace

AdaptiveStep::AdaptiveStep(const Method& method, const System& system, const Options& options,
                           const Accuracy& accuracy)
    : Integrator(method, system, options),
      accuracy_(accuracy),
      atol_q_(options.atol > 0 ? options.atol : options.rtol * options.length),
      atol_v_(options.atol > 0 ? options.atol : options.rtol * options.speed),
      per_mass_(system.mass().cwiseInverse()),
      f_(system.size()),
      error_q_(system.size()),
      error_v_(system.size()),
      instants_(std::max<std::size_t>(accuracy.instants, 2) + 1,
                {{0, Vec(system.size()), Vec(system.size())}, Vec(system.size())}),
      kinks_(system) {
  // No polynomial leads over a jump.
  if (kinks_.has_kinks() && accuracy_.instants > 2) accuracy_.instants = 0;
}

void AdaptiveStep::acceleration(const Vec& q, MutableVec a) {
  force(q, f_);
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
  acceleration(state.q, last().a);
  ended_ = last().a.allFinite() ? Outcome::reached_end : Outcome::not_finite;
  if (ended_ == Outcome::reached_end) h_ = first_step();
  last_error_ = 1;
  was_rejected_ = false;
  h_before_jump_ = 0;
  creep_ = Creep(state.t);
}

// h_0 changes y = (q, v) by a hundredth of itself. h_1 is where a Taylor series with the larger of
// |y'| and |y''| leaves a hundredth of the tolerance.
double AdaptiveStep::first_step() {
  const auto& [now, a] = last();
  const double d0 = norm(now, now.q, now.v), d1 = norm(now, now.v, a);
  const double blind = blind_step * (t_end() - now.t);
  const double h0 = d0 > 1e-5 && d1 > 1e-5 ? 0.01 * d0 / d1 : blind;
  State& ahead = last(instants_.size() - 1).state;
  ahead.q = now.q + h0 * now.v;
  acceleration(ahead.q, error_v_);
  error_v_ = (error_v_ - a) / h0;
  const double largest = std::max(d1, norm(now, a, error_v_));
  const double h1 = largest > 1e-15 ? std::pow(0.01 / largest, 1.0 / (accuracy_.error_order + 1))
                                    : std::max(blind, 1e-3 * h0);
  const double h = std::min(100 * h0, h1);
  return h > 0 ? h : blind;
}

Outcome AdaptiveStep::run_to(State& state, double t_stop) {
  if (must_stop()) return Outcome::over_budget;
  try {
    while (ended_ == Outcome::reached_end && !can_show(t_stop)) ended_ = take_step();
  } catch (...) {
    state = last().state;
    throw;
  }
  if (last().state.t < t_stop) {
    state = last().state;
    return ended_;
  }
  return show(t_stop, state);
}

// Whether the kept instants determine the state at t. Their polynomial is most accurate in its
// middle; at the end of the run no more instants come.
bool AdaptiveStep::can_show(double t) {
  if (last().state.t == t_end()) return true;
  if (accuracy_.instants == 0) return last().state.t >= t;
  return count_ >= accuracy_.instants && last(accuracy_.instants / 2 - 1).state.t >= t;
}

Outcome AdaptiveStep::show(double t, State& state) {
  for (std::size_t i = 0; i < std::min(count_, instants_.size() - 1); ++i) {
    if (last(i).state.t != t) continue;
    state = last(i).state;
    return Outcome::reached_end;
  }
  if (accuracy_.instants > 0) {
    std::array<const Instant*, most_instants> list;
    const std::size_t used = std::min(count_, accuracy_.instants);
    for (std::size_t i = 0; i < used; ++i) list[i] = &last(i);
    interpolate(std::span(list).first(used), t, state);
    return Outcome::reached_end;
  }
  const Instant& from = last(1);
  Instant& at = last(instants_.size() - 1);
  Outcome outcome = attempt(from, t - from.state.t, at, error_q_, error_v_);
  at.state.t = t;
  if (outcome == Outcome::reached_end) outcome = check_step(from.state, at.state);
  state = outcome == Outcome::reached_end ? at.state : from.state;
  return outcome;
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
      outcome = std::isfinite(error) ? check_step(now.state, next.state) : Outcome::not_finite;
    }
    const Jump jump_here =
        kinks_.has_kinks() && outcome == Outcome::reached_end ? jump(now, next, h) : Jump::none;
    if (jump_here == Jump::ahead) {
      ++counts().rejected;
      rejected();
      continue;
    }
    if (jump_here == Jump::over) error = std::min(error, 1.0);
    if (error <= 1 && outcome == Outcome::reached_end) {
      accepted(next);
      if (!std::isfinite(next.a.sum())) outcome = Outcome::not_finite;
    }
    if (outcome == Outcome::not_finite) error = INFINITY;
    if (error <= 1) {
      if (outcome != Outcome::reached_end) return outcome;
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
    const double factor =
        std::isfinite(error) ? safety * std::pow(error, -power) : factor_of_failure;
    h_ = h * std::clamp(factor, smallest_factor, 1.0);
    was_rejected_ = true;
    ++counts().rejected;
    rejected();
  }
}

AdaptiveStep::Jump AdaptiveStep::jump(const Instant& now, const Instant& next, double h) {
  const auto change = kinks_.first(now.state, next.state);
  if (!change) return Jump::none;
  if (h_before_jump_ == 0) over_jump_ = 0;
  h_before_jump_ = std::max(h_before_jump_, h_);
  // The rounding of the time, and the time in which positions change by their rounding.
  const double rounded = now.state.q.lpNorm<Eigen::Infinity>() / change->speed;
  const double least = roundings_over_jump * std::max(std::abs(now.state.t), h_before_jump_) +
                       std::min(roundings_over_jump * rounded, slowest_over_jump * h_before_jump_);
  over_jump_ = std::max(over_jump_, least);
  if (h > 2 * over_jump_) {
    const double before = std::min((1 - short_of_jump) * change->part * h, h - least);
    h_ = std::max(before, over_jump_);
    return Jump::ahead;
  }
  if (!change->is_at_end) return Jump::over;
  // Far from the origin a length stays zero for longer.
  h_ = over_jump_ = 2 * h;
  return Jump::ahead;
}

void AdaptiveStep::accept(bool is_limited) {
  newest_ = (newest_ + 1) % instants_.size();
  count_ = std::min(count_ + 1, instants_.size());
  ++counts().steps;
  note(last().state);
  if (is_limited) ++counts().stability_limited_steps;
}

}  // namespace qddot
