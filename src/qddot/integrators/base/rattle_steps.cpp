#include "qddot/integrators/base/rattle_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace qddot {
namespace {

// Newton's method ends where g is rounding, or where it no longer falls and is not far above that.
constexpr double most_roundings = 32;
constexpr int most_iterations = 60;

}  // namespace

RattleSteps::RattleSteps(SystemRun& run, const Splitting& splitting)
    : Formula(run),
      splitting_(splitting),
      constraints_(system().constraints()),
      has_dashpots_(is_damped() && system().damping()->has_dashpots()),
      air_damping_(is_damped() && !has_dashpots_ ? system().damping()->air_damping() : 0),
      multipliers_(system()),
      lambda_(Vec::Zero(multipliers_.count())),
      g_(lambda_),
      solved_(lambda_),
      rates_(lambda_) {}

void RattleSteps::begin(const State& state, X& x) {
  static_cast<State&>(x) = state;
  x.f.resize(state.q.size());
  if (has_dashpots_) {
    force(state, x.f);
    x.friction = friction();
  } else {
    force({state.t, state.q}, x.f);
  }
  x.driving = driving_power();
  x.mu.setZero(multipliers_.count());
  x.change = x.mu;
  if (factorize_at(state.t, state.q) && constraints_) {
    At at(state);
    x.mu = multipliers_.forces_at(run_.counted().placed(at), x.f);
  }
}

Outcome RattleSteps::step(const X& now, double h, X& next) {
  if (now.t != time_of_factors_ && !factorize_at(now.t, now.q)) return no_solution(now.t);
  const double t_next = next.t;
  next = now;
  double t = now.t;
  for (const double gamma : splitting_.drifts) {
    const Outcome outcome = stage(t, gamma * h, next);
    if (outcome != Outcome::reached_end) return outcome;
    t += gamma * h;
  }
  next.t = t_next;
  time_of_factors_ = t_next;
  return Outcome::reached_end;
}

Outcome RattleSteps::stage(double t, double s, X& next) {
  if (has_dashpots_) before_ = next.v;
  add_quotient(next.v, s / 2, next.f, system().mass(), next.v);
  if (is_driven()) next.work += s / 2 * next.driving;
  if (const Outcome outcome = drift(t, s, next); outcome != Outcome::reached_end) return outcome;
  if (has_dashpots_) {
    half_ = next.v;
    next.work.dissipated -= s / 4 * product_with_sum(before_, half_, next.friction);
    before_ = 2 * half_ - before_;  // the predicted velocity
    force({t + s, next.q, before_}, next.f);
    take_friction(next.friction);
  } else {
    force({t + s, next.q}, next.f);
  }
  next.driving = driving_power();
  add_quotient(next.v, s / 2, next.f, system().mass(), next.v);
  if (is_driven()) next.work += s / 2 * next.driving;
  const Outcome outcome = kick_along_constraints(t + s, s, next);
  if (has_dashpots_) {
    next.work.dissipated -= s / 4 * product_with_sum(half_, next.v, next.friction);
  }
  return outcome;
}

Outcome RattleSteps::drift(double t, double s, X& next) {
  const double length = air_damping_ == 0 ? s : -std::expm1(-air_damping_ * s) / air_damping_;
  if (constraints_) {
    if (is_driven()) constraints_->constraint_rates(place(t, next.q), rates_);
    lambda_ = next.mu + s / next.size * next.change;
    const Vec& compliances = constraints_->compliances();
    const double to_force = 2 / (s * length);
    if (compliances.size() > 0 && !multipliers_.factorize(to_force)) return no_solution(t);
    next.q += length * next.v;
    multipliers_.add_pull(-1 / to_force, lambda_, next.q);
    const double rounding = multipliers_.rounding(next.q);
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0;; ++i) {
      constraints_->constraint_values(place(t + s, next.q), g_);
      if (compliances.size() > 0) g_ -= compliances.cwiseProduct(lambda_);
      const double worst = g_.lpNorm<Eigen::Infinity>();
      if (worst <= rounding) break;
      if (worst > last / 2 && worst <= most_roundings * rounding) break;
      if (i == most_iterations || !std::isfinite(worst)) return no_solution(t);
      last = worst;
      multipliers_.solve(g_, solved_);
      multipliers_.add_pull(-1, solved_, next.q);
      lambda_ += to_force * solved_;
    }
    multipliers_.add_pull(-s / 2, lambda_, next.v);
    next.change = lambda_ - next.mu;
    next.size = s;
    if (is_driven()) add_work_of_impulse(s / 2, lambda_, next);
  } else {
    next.q += length * next.v;
  }
  if (air_damping_ > 0) {
    next.work.dissipated -= std::expm1(-2 * air_damping_ * s) * system().kinetic(next.v);
    next.v *= std::exp(-air_damping_ * s);
  }
  return Outcome::reached_end;
}

Outcome RattleSteps::kick_along_constraints(double t, double s, X& next) {
  if (!constraints_) return Outcome::reached_end;
  if (!factorize_at(t, next.q)) return no_solution(t);
  const At here = place(t, next.q);
  if (is_driven()) constraints_->constraint_rates(here, rates_);
  next.mu = 2 / s * multipliers_.project_velocities(here, next.v);
  if (is_driven()) add_work_of_impulse(s / 2, next.mu, next);
  return Outcome::reached_end;
}

void RattleSteps::add_work_of_impulse(double s, const Vec& impulse, X& next) const {
  next.work.driven += s * impulse.dot(rates_);
}

bool RattleSteps::factorize_at(double t, const Vec& q) {
  multipliers_.take_gradients(place(t, q));
  const bool is_regular = multipliers_.factorize();
  time_of_factors_ = is_regular ? t : std::numeric_limits<double>::quiet_NaN();
  return is_regular;
}

Outcome RattleSteps::no_solution(double t) {
  set_message(fmt::format(
      "at t = {:.6g} s no forces along the rods keep their lengths: take a smaller step; if that "
      "does not help, a row of rods is taut between two pins there",
      t));
  return Outcome::newton_failed;
}

void RattleSteps::show(const X& x, bool, State& state) const {
  state.q = x.q;
  state.v = x.v;
}

std::unique_ptr<Stepper> create_rattle(SystemRun& run) {
  return std::make_unique<FixedSteps<RattleSteps>>(run, *run.method().splitting);
}

}  // namespace qddot
