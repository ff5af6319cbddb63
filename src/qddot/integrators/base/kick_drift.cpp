#include "qddot/integrators/base/kick_drift.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "qddot/integrators/base/kicks_and_drift.hpp"

namespace qddot {

std::vector<double> mirrored(std::vector<double> half, std::size_t size) {
  assert(half.size() == (size + 1) / 2);
  for (std::size_t i = half.size(); i < size; ++i) half.push_back(half[size - 1 - i]);
  return half;
}

Splitting verlet_composition(int order, const std::vector<double>& gamma) {
  std::vector<double> kicks;
  double before = 0;
  for (const double g : gamma) {
    kicks.push_back((before + g) / 2);
    before = g;
  }
  kicks.push_back(before / 2);
  return {.order = order, .kicks = kicks, .drifts = gamma};
}

KickDrift::KickDrift(SystemRun& run, const Splitting& splitting)
    : Formula(run),
      splitting_(splitting),
      kicks_first_(splitting.kicks.size() > splitting.drifts.size()),
      air_damping_(is_damped() ? system().damping()->air_damping() : 0),
      q_(options().compensated, system().size()),
      v_(options().compensated, system().size()) {}

void KickDrift::begin(const State& state, X& x) {
  static_cast<State&>(x) = state;
  x.f.resize(state.q.size());
  x.late = 0;
  q_.restart();
  v_.restart();
  if (kicks_first_) force({state.t, state.q}, x.f);
  x.driving = driving_power();
}

Outcome KickDrift::step(const X& now, double h, X& next) {
  if (does_work()) next.work = now.work;
  if (options().compensated || is_damped()) {
    step_compensated(now, h, next);
  } else if (kicks_first_) {
    step_from_kick(now, h, next);
  } else {
    step_from_drift(now, h, next);
  }
  return Outcome::reached_end;
}

void KickDrift::step_from_kick(const X& now, double h, X& next) {
  const auto& [order, kicks, drifts] = splitting_;
  const X* from = &now;
  double t = now.t, late = now.late;
  if (is_driven()) next.work += kicks[0] * h * now.driving;
  for (std::size_t i = 0; i < drifts.size(); ++i) {
    KicksAndDrift work({from->q, from->v, from->f, system().mass()},
                       {late, kicks[i] * h, drifts[i] * h}, next.q, next.v);
    if (i + 1 == drifts.size()) work.see_speed(kicks.back() * h, next.f);
    t += drifts[i] * h;
    next.squared_speed = force_beside({t, next.q}, next.f, work);
    if (is_driven()) next.work += kicks[i + 1] * h * driving_power();
    from = &next;
    late = 0;
  }
  next.late = kicks.back() * h;
  next.driving = driving_power();
}

void KickDrift::step_from_drift(const X& now, double h, X& next) {
  const auto& [order, kicks, drifts] = splitting_;
  const Vec* v = &now.v;
  double t = now.t;
  add_scaled(now.q, drifts[0] * h, now.v, next.q);
  for (std::size_t i = 0; i < kicks.size(); ++i) {
    t += drifts[i] * h;
    force({t, next.q}, next.f);
    if (is_driven()) next.work += kicks[i] * h * driving_power();
    kick_and_drift({next.q, *v, next.f, system().mass()}, 0, kicks[i] * h, drifts[i + 1] * h,
                   next.q, next.v);
    v = &next.v;
  }
}

void KickDrift::step_compensated(const X& now, double h, X& next) {
  const auto& [order, kicks, drifts] = splitting_;
  next.q = now.q;
  next.v = now.v;
  if (kicks_first_) next.f = now.f;
  next.driving = now.driving;
  const auto kick = [&](double size) {
    if (is_driven()) next.work += size * h * next.driving;
    v_.add_quotient(next.v, size * h, next.f, system().mass(), next.v);
  };
  next.late = 0;
  const auto drift = [&](double size) { this->drift(size * h, next); };
  double t = now.t;
  for (std::size_t i = 0; i < std::min(kicks.size(), drifts.size()); ++i) {
    if (kicks_first_) kick(kicks[i]);
    drift(drifts[i]);
    t += drifts[i] * h;
    force({t, next.q}, next.f);
    next.driving = driving_power();
    if (!kicks_first_) kick(kicks[i]);
  }
  if (kicks_first_) {
    kick(kicks.back());
  } else {
    drift(drifts.back());
  }
}

void KickDrift::drift(double h, X& next) {
  if (air_damping_ == 0) return q_.add_scaled(next.q, h, next.v, next.q);
  q_.add_scaled(next.q, -std::expm1(-air_damping_ * h) / air_damping_, next.v, next.q);
  next.work.dissipated -= std::expm1(-2 * air_damping_ * h) * system().kinetic(next.v);
  next.v *= std::exp(-air_damping_ * h);
}

void KickDrift::show(const X& x, bool, State& state) const {
  state.q = x.q;
  if (x.late == 0) {
    state.v = x.v;
  } else {
    add_quotient(x.v, x.late, x.f, system().mass(), state.v);
  }
}

double KickDrift::squared_speed(const X& next) const {
  return next.late == 0 ? squared_norm(next.v) : next.squared_speed;
}

std::unique_ptr<Stepper> create_splitting(SystemRun& run) {
  return std::make_unique<FixedSteps<KickDrift>>(run, *run.method().splitting);
}

}  // namespace qddot
