#include "qddot/integrators/base/local_global.hpp"

#include <cmath>

namespace qddot {
namespace {

constexpr int usual_iterations = 10;
constexpr int most_shortenings = 60;

}  // namespace

LocalGlobal::LocalGlobal(SystemRun& run)
    : Formula(run),
      iterations_(options().iterations > 0 ? options().iterations : usual_iterations),
      descends_(system().laplacian()->bounds_stiffness()),
      matrix_(system()) {
  if (!is_damped()) return;
  SymmetricMatrix l = system().stiffness_pattern();
  descends_ = descends_ && system().damping()->bound_damping(l);
}

Outcome LocalGlobal::step(const State& now, double h, State& next) {
  if (h != factorized_h_) {
    ++counts().factorizations;
    const Stopwatch watch(clock(), &Seconds::factorization);
    if (is_damped()) matrix_.emplace(system(), 1 / h);
    if (!matrix_->factorize(h * h)) return Outcome::indefinite_matrix;
    factorized_h_ = h;
  }
  now_ = &now;
  t_ = next.t;
  h_ = h;
  next.v = now.v;
  begin_step();
  for (int i = 0; i < iterations_; ++i) {
    if (must_stop()) return Outcome::over_budget;
    iterate(next.v);
    if (!is_finite_) return Outcome::not_finite;
  }
  next.q = now.q + h * next.v;
  if (does_work()) next.work = now.work + h * power_at(next.v);
  return Outcome::reached_end;
}

void LocalGlobal::gradient(const Vec& v, Vec& r) {
  q_ = now_->q + h_ * v;
  force({t_, q_}, f_);
  r = system().mass().cwiseProduct(v - now_->v) - h_ * f_;
  if (!is_damped()) return;
  find_friction(v);
  r -= h_ * friction_;
}

double LocalGlobal::find_friction(const Vec& v) {
  q_ = now_->q + h_ * v;
  friction_.resize(q_.size());
  const BackwardRate rate{q_, now_->q, now_->q, 1 / h_, -1 / h_, 0, t_, now_->t, now_->t};
  if (const auto taken = run_.counted().secant_friction(rate, v, friction_)) return *taken;
  const double taken = power({t_, now_->q, v}).dissipated;
  friction_ = friction();
  return taken;
}

Work LocalGlobal::power_at(const Vec& v) {
  Work power;
  if (is_damped()) power.dissipated = find_friction(v);
  q_ = now_->q + h_ * v;
  if (const Driving* driving = system().driving())
    power.driven = driving->driving_power({t_, q_, v}).driven;
  return power;
}

void LocalGlobal::direction(const Vec& r, Vec& p) {
  ++counts().solves;
  const Stopwatch watch(clock(), &Seconds::solve);
  matrix_->solve(r, p);
  is_finite_ = std::isfinite(p.sum());
}

double LocalGlobal::objective(const Vec& v) {
  q_ = v - now_->v;
  const double kinetic = system().kinetic(q_);
  q_ = now_->q + h_ * v;
  const double g = kinetic + potential({t_, q_});
  return is_damped() ? g + h_ / 2 * find_friction(v) : g;
}

void LocalGlobal::search(Vec& v, const Vec& p, double slope, double& g) {
  double alpha = 1;
  for (int halvings = 0; halvings < most_shortenings; ++halvings, alpha /= 2) {
    trial_ = v - alpha * p;
    if (const double lower = objective(trial_); lower <= g - 1e-4 * alpha * slope) {
      v.swap(trial_);
      g = lower;
      return;
    }
  }
}

void LocalGlobal::plain_step(Vec& v, const Vec& r, const Vec& p) {
  if (descends()) {
    v -= p;
    return;
  }
  double g = objective(v);
  search(v, p, r.dot(p), g);
}

}  // namespace qddot
