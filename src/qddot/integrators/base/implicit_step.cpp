#include "qddot/integrators/base/implicit_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/model/machine_epsilon.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot {
namespace {

// The most iterations of Newton's method. It takes some ten if it converges.
constexpr int most_iterations = 100;
// The most halvings of a correction: 2^-30 of it changes the energy by rounding only.
constexpr int most_halvings = 30;
// The rate of convergence above which K is factorised anew. New factors cost as much as some ten
// solves.
constexpr double slowest_rate = 0.3;
// The part of a stage's tolerance that an iterative solve for one correction may leave as residual.
// In a linear stage, one correction is all.
constexpr double linear_share = 0.1;
// Corrections that no longer shrink and are below this part of the positions are rounding.
constexpr double rounding = 1e-12;

}  // namespace

ImplicitStep::ImplicitStep(SystemRun& run, double solve_tolerance)
    : Formula(run),
      free_(system().size()),
      u_(system().size()),
      tolerance_(options().solve_tolerance > 0 ? options().solve_tolerance : solve_tolerance),
      kinks_(system().kinks()),
      pieces_(system().pieces()),
      x_(system().size()),
      f_(system().size()),
      r_(system().size()),
      p_(system().size()),
      before_(system().size()),
      start_(system().size()),
      k_(system().stiffness_pattern()),
      matrix_(system(), options().solver),
      is_damped_(is_damped()) {
  if (is_damped_) w_ = velocity_ = Vec::Zero(system().size());
  matrix_.set_tolerance(linear_share * tolerance_);
  if (kinks_ && kinks_->kink_count() == 0) kinks_ = nullptr;
  if (!kinks_) return;
  length_.resize(kinks_->kink_count());
  other_length_.resize(kinks_->kink_count());
}

void ImplicitStep::begin(const State& state, State& x) {
  x = state;
  factorized_s_ = last_missed_ = 0;
  last_rate_ = 1;
  compression_.start();
}

void ImplicitStep::acceleration(const At& at, Vec& a) {
  force(at, a);
  a.array() /= system().mass().array();
}

// The state of a stage's iteration.
struct ImplicitStep::Iteration {
  bool wants_factors;             // before the next correction
  bool has_new_factors = false;   // made in this stage,
  bool has_factors_of_u = false;  // and for the present u
  double last = 0;  // size of the last correction, if it had these factors and full length; else 0
  double least = std::numeric_limits<double>::infinity();  // of all corrections so far

  void note_factors() {
    has_new_factors = has_factors_of_u = true;
    wants_factors = false;
    last = 0;
  }
};

Outcome ImplicitStep::solve_stage(const Vec& q, double t, double s) {
  t_ = t;
  Iteration now{.wants_factors = s != factorized_s_ || rate_ != factorized_rate_};
  start_ = u_;
  residual(q, s);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    if (must_stop()) return Outcome::over_budget;
    if (const Outcome outcome = correct(q, s, now); outcome != Outcome::reached_end) return outcome;
    const double size = p_.lpNorm<Eigen::Infinity>(), rate = rate_of(now, q, size, iteration == 0);
    const double missed = (u_ - start_ + p_).lpNorm<Eigen::Infinity>();
    const bool is_solved = rate < 1 && rate / (1 - rate) * size <= tolerance_ * missed;
    if (is_exact(q) || is_solved || is_rounding(q, size, now.least)) {
      u_ += p_;
      last_missed_ = missed;
      // The rate is unknown with new factors, and less certain after a stage that needed one
      // correction only.
      last_rate_ = now.has_new_factors ? 1 : (iteration == 0 ? 2 * rate : rate);
      return Outcome::reached_end;
    }
    now.least = std::min(now.least, size);
    now.wants_factors = now.last > 0 && rate > slowest_rate && !now.has_factors_of_u;
    if (now.wants_factors) continue;

    const double length = search(q, s);
    if (length == 0 && now.has_factors_of_u) return Outcome::newton_failed;
    now.wants_factors = length < 1;
    now.has_factors_of_u = false;
    now.last = length == 1 ? size : 0;
  }
  return Outcome::newton_failed;
}

// Computes the next correction p: with new factors if they are wanted, and with less of the
// compression if conjugate gradients meet an indefinite matrix.
Outcome ImplicitStep::correct(const Vec& q, double s, Iteration& now) {
  if (now.wants_factors) {
    if (const Outcome outcome = factorize(q, s); outcome != Outcome::reached_end) return outcome;
    now.note_factors();
  }
  Outcome outcome = correction();
  while (outcome == Outcome::indefinite_matrix && compression_.soften()) {
    outcome = factorize_softened(q, s);
    if (outcome == Outcome::reached_end) outcome = correction();
    now.note_factors();
  }
  return outcome;
}

// The expected ratio of the next correction to this one, from the ratio of this one to the last.
// The first correction has no ratio: it may take that of the last stage, unless a kink lies
// between.
double ImplicitStep::rate_of(const Iteration& now, const Vec& q, double size, bool is_first) {
  if (now.last > 0) return size / now.last;
  const bool may_be_like_last = is_first && !now.has_new_factors && size <= 2 * last_missed_;
  const bool is_like_last =
      may_be_like_last && !system().stiffness_is_constant() && !crosses_kink(q);
  return is_like_last ? last_rate_ : 1;
}

// Whether this correction is the exact solution.
bool ImplicitStep::is_exact(const Vec& q) {
  if (is_damped_ && !system().damping()->damping_is_constant()) return false;
  return system().stiffness_is_constant() && compression_.kept() == 1 && is_linear_along(q);
}

bool ImplicitStep::is_rounding(const Vec& q, double size, double least) const {
  const double place = (q + u_).lpNorm<Eigen::Infinity>();
  return size <= 4 * machine_epsilon * place || (2 * size > least && size <= rounding * place);
}

// Whether f is linear at the place of the residual and at the place that the correction leads to.
bool ImplicitStep::is_linear_along(const Vec& q) {
  if (!pieces_) return system().stiffness_is_constant();
  if (knows_start() && !pieces_->is_linear_at({t_, q})) return false;
  x_ = q + u_;
  if (!pieces_->is_linear_at({t_, x_})) return false;
  x_ += p_;
  return pieces_->is_linear_at({t_, x_});
}

bool ImplicitStep::crosses_kink(const Vec& q) {
  if (!kinks_) return false;
  kinks_->kink_lengths({t_, q}, length_);
  const auto has_other_signs = [&] {
    kinks_->kink_lengths({t_, x_}, other_length_);
    return (length_.array() * other_length_.array() <= 0).any();
  };
  x_ = q + u_;
  if (has_other_signs()) return true;
  x_ += p_;
  return has_other_signs();
}

// r = M (u - u*) - s f.
void ImplicitStep::residual(const Vec& q, double s) {
  stage_force(q, u_, f_);
  r_ = system().mass().cwiseProduct(u_ - free_) - s * f_;
}

void ImplicitStep::stage_force(const Vec& q, const Vec& u, Vec& f) {
  x_ = q + u;
  if (!is_damped_) return force({t_, x_}, f);
  velocity_ = rate_ * u + w_;
  if (!find_secant_friction()) return force({t_, x_, velocity_}, f);
  force({t_, x_}, f);
  f += secant_;
}

std::optional<double> ImplicitStep::find_secant_friction() {
  if (!at1_) return {};
  const Stopwatch watch(clock(), &Seconds::force);
  secant_.resize(x_.size());
  const BackwardRate rate{x_, at1_->q, at2_->q, rate_, a1_, a2_, t_, at1_->t, at2_->t};
  const auto power = run_.counted().secant_friction(rate, velocity_, secant_);
  if (!power) at1_ = nullptr;
  return power;
}

At ImplicitStep::at_friction(const Vec& q) {
  x_ = q + friction_part() * u_;
  velocity_ = rate_ * u_ + w_;
  return {t_, x_, velocity_};
}

Work ImplicitStep::stage_power(const Vec& q) {
  if (!is_damped_) {
    x_ = q + u_;
    return power({t_, x_});
  }
  const At at = at_friction(q);
  const std::optional<double> secant = find_secant_friction();
  if (!secant) return power(at);
  // The work of supports on dashpots is by velocities: it differs by the formula's own error.
  Work of_driving;
  if (const Driving* driving = system().driving()) of_driving = driving->driving_power(at);
  return {.dissipated = *secant, .driven = of_driving.driven};
}

void ImplicitStep::stage_stiffness(const Vec& q, const Vec& u, double compression_weight,
                                   SymmetricMatrix& k) {
  x_ = q + u;
  run_.counted().weighted_stiffness({t_, x_}, compression_weight, k);
}

Outcome ImplicitStep::factorize(const Vec& q, double s) {
  compression_.harden();
  return factorize_softened(q, s);
}

Outcome ImplicitStep::factorize_softened(const Vec& q, double s) {
  factorized_s_ = 0;
  bool is_finite = true;
  const bool is_positive = compression_.find([&](double kept) {
    stage_stiffness(q, u_, kept, k_);
    if (is_damped_) subtract_damping(system(), at_friction(q), rate_, k_);
    is_finite = k_.coeffs().allFinite();
    if (!is_finite) return true;  // factors cannot make it positive
    ++counts().factorizations;
    const Stopwatch watch(clock(), &Seconds::factorization);
    return matrix_.factorize_positive(1, s, k_);
  });
  if (!is_finite) return Outcome::not_finite;
  if (!is_positive) return indefinite_at({t_, x_});
  factorized_s_ = s;
  factorized_rate_ = rate_;
  return Outcome::reached_end;
}

// p = -(M - s K)^-1 r.
Outcome ImplicitStep::correction() {
  const Stopwatch watch(clock(), &Seconds::solve);
  ++counts().solves;
  ++counts().newton_iterations;
  if (const Outcome outcome = check_solve(matrix_.solve(r_, p_)); outcome != Outcome::reached_end) {
    return outcome;
  }
  p_ = -p_;
  // Squares of finite numbers may overflow.
  const bool is_finite = std::isfinite(squared_norm(p_)) || p_.allFinite();
  return is_finite ? Outcome::reached_end : Outcome::not_finite;
}

// Moves u along p by the first of 1, 1/2, 1/4, ... of it that halves the residual or decreases g by
// Armijo's rule. The first test costs nothing, since the next iteration needs that residual. If
// there is no g, it moves by all of p. Returns that part; 0, with u unchanged, if there is none.
double ImplicitStep::search(const Vec& q, double s) {
  const double norm = std::sqrt(squared_norm(r_)), slope = r_.dot(p_);
  double g = std::numeric_limits<double>::quiet_NaN();
  before_ = u_;
  if (is_damped_) frozen_ = q + friction_part() * u_;
  double length = 1;
  for (int halvings = 0; halvings < most_halvings; ++halvings, length /= 2) {
    add_scaled(before_, length, p_, u_);
    residual(q, s);
    if (!is_minimisation() || !system().has_potential() ||
        std::sqrt(squared_norm(r_)) <= 0.5 * norm)
      return length;
    const double g_there = objective(q, s);
    if (std::isnan(g)) {
      u_.swap(before_);
      g = objective(q, s);
      u_.swap(before_);
    }
    // Near the minimum, rounding decides which g is smaller.
    if (g_there <= g + 1e-4 * length * slope + 8 * machine_epsilon * std::abs(g)) return length;
  }
  u_ = before_;
  residual(q, s);
  return 0;
}

double ImplicitStep::objective(const Vec& q, double s) {
  x_ = q + u_;
  const double potential = this->potential({t_, x_});
  x_ = u_ - free_;
  const double g = system().kinetic(x_) + s * potential;
  if (!is_damped_) return g;
  const At at = at_friction(q);
  const std::optional<double> secant = find_secant_friction();
  return g + s / (2 * rate_) * (secant ? *secant : power({t_, frozen_, at.v}).dissipated);
}

}  // namespace qddot
