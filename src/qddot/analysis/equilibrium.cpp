#include "qddot/analysis/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/stability.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

using Outcome = Equilibrium::Outcome;

constexpr int most_steps = 2000;
constexpr int most_polishing = 3;
constexpr int most_halvings = 40;
constexpr int most_shifts = 60;
constexpr double far_away = 1e6;       // lengths
constexpr double first_radius = 0.1;   // lengths
constexpr double least_shift = 1e-12;  // of the bound of M'^-1 K
constexpr double little = 1e-8;        // beside what a negative curvature promises
constexpr double infinite = std::numeric_limits<double>::infinity();

const char* const falls_for_ever =
    "there is no equilibrium: a part that nothing holds falls for ever";
const char* const overflows = "no equilibrium was reached: forces or stiffnesses overflow";
const char* const stuck =
    "no equilibrium was reached: rounding hides where the energy falls further";
const char* const too_long =
    "no equilibrium was reached in 2000 iterations, though the energy still falls";

double largest(const Vec& x) { return x.lpNorm<Eigen::Infinity>(); }

class Descent {
 public:
  Descent(const System& system, const Vec& start, double length)
      : system_(system), start_(start), length_(length) {
    move_to(start);
  }

  Equilibrium run() {
    while (iterations_ < most_steps) {
      if (!k_.coeffs().allFinite() || !f_.allFinite())
        return end(Outcome::not_converged, overflows);
      if (largest(q_ - start_) > far_away * length_) return end(Outcome::unbounded, falls_for_ever);
      const bool looks = nears_saddle(), rests = is_stationary();
      if (!looks && !rests && step()) continue;
      if (curvature_signs(system_, q_).negative > 0) {
        curvature_ = smallest_curvature(system_, q_);
        if (leave_saddle()) continue;
      } else if (rests) {
        polish();
        return end(Outcome::reached, "");
      }
      next_look_ = 2 * iterations_;
      if (!(looks || rests) || !step()) return end(Outcome::not_converged, stuck);
    }
    return end(Outcome::not_converged, too_long);
  }

 private:
  void move_to(const Vec& q) {
    q_ = q;
    v_ = system_.potential(q_);
    system_.force(q_, f_);
    system_.stiffness(q_, k_);
    row_sum_ = largest_row_sum(k_);
    reach_ = std::max(largest(q_), length_);
  }

  bool is_stationary() const { return largest(f_) <= 8 * machine_epsilon * row_sum_ * reach_; }

  // Whether the last step lowered V by little beside what the shift promises, which outweighs a
  // negative curvature. Such a descent leads to a saddle, ever more slowly.
  bool nears_saddle() const {
    if (iterations_ < next_look_ || !(shift_ > 4 * least())) return false;
    const double distance = first_radius * length_;
    return fall_ < little * 0.5 * shift_ * metric_.sum() * distance * distance;
  }

  // The root mean square [m] of a displacement by the metric; it does not change if the scene is
  // rotated.
  double size(const Vec& p) const {
    return std::sqrt(p.dot(metric_.cwiseProduct(p)) / metric_.sum());
  }

  // Computes p_ with the first of `shift`, 4 shift, 16 shift, ... that makes the matrix positive
  // definite. False if none does.
  bool direction(double shift) {
    shift_ = shift;
    for (int tries = 0; !matrix_.factorize_positive(shift_, 1, k_); ++tries) {
      if (tries == most_shifts) return false;
      shift_ = std::max(least(), 4 * shift_);
    }
    matrix_.solve(f_ + shift_ * metric_.cwiseProduct(before_), p_);
    if (!(f_.dot(p_) > 0)) {  // the inertia points uphill
      before_.setZero();
      matrix_.solve(f_, p_);
    }
    return p_.allFinite();
  }

  double least() const {
    return row_sum_ > 0 ? least_shift * row_sum_ / metric_.minCoeff() : least_shift;
  }

  // One step downhill; false if none is found.
  bool step() {
    ++iterations_;
    const double shift = shift_ > 4 * least() ? shift_ / 4 : 0;
    return descend(shift, /*by_slope=*/false) || descend(shift, /*by_slope=*/true);
  }

  // The same with `shift` or a larger one, which makes shorter steps. From the bound of M'^-1 K on
  // they are those of steepest descent.
  bool descend(double shift, bool by_slope) {
    const double before = v_;
    for (; direction(shift); shift = std::max(least(), 16 * shift_)) {
      const double full = size(p_), length = std::min(full, radius_);
      p_ *= length / full;
      if (const double alpha = search(by_slope); alpha > 0) {
        const bool may_grow = alpha == 1 && length < full;
        radius_ = may_grow ? 2 * radius_ : std::max(2 * alpha * length, machine_epsilon * length_);
        before_ = p_;
        fall_ = before - v_;
        if (alpha < 1) before_.setZero();
        return true;
      }
      before_.setZero();
      if (shift_ > least() / least_shift) break;
    }
    return false;
  }

  // Moves along p_ by the first of 1, 1/2, 1/4, ... that leads to an acceptable place, and returns
  // it; 0 if none does. A place is acceptable if V has fallen, by more than its rounding. Where
  // rounding hides that, |f| must have fallen. `by_slope`: or V must not yet rise along p as fast
  // as it fell (Hager, Zhang, SIAM J. Optim. 16 (2005) 170-192, approximate Wolfe conditions).
  double search(bool by_slope) {
    const double slope = f_.dot(p_);
    const double noise = machine_epsilon * (std::abs(v_) + row_sum_ * reach_ * reach_);  // of V
    double alpha = 1;
    for (int halvings = 0; halvings < most_halvings; ++halvings, alpha /= 2) {
      trial_ = q_ + alpha * p_;
      const double v = system_.potential(trial_);
      system_.force(trial_, trial_f_);
      if (!std::isfinite(v) || !trial_f_.allFinite()) continue;
      const bool falls = v <= v_ - std::max(noise, 1e-4 * alpha * slope);
      const bool relaxes =
          by_slope ? trial_f_.dot(p_) >= -0.8 * slope : trial_f_.norm() <= 0.9 * f_.norm();
      if (falls || (v <= v_ + noise && relaxes)) {
        move_to(trial_);
        return alpha;
      }
    }
    return 0;
  }

  // Moves along the direction of negative curvature to a lower place; false if none is found.
  bool leave_saddle() {
    ++iterations_;
    const Vec& direction = curvature_.direction;
    double s = first_radius * length_ / size(direction);
    for (int halvings = 0; halvings < most_halvings; ++halvings, s /= 2) {
      const double ahead = system_.potential(Vec(q_ + s * direction));
      const double behind = system_.potential(Vec(q_ - s * direction));
      // Half of the decrease that the curvature predicts.
      if (!(std::min(ahead, behind) <= v_ + 0.25 * curvature_.value * s * s)) continue;
      move_to(q_ + (ahead <= behind ? s : -s) * direction);
      radius_ = first_radius * length_;
      before_.setZero();
      shift_ = 0;
      fall_ = infinite;
      return true;
    }
    return false;
  }

  // Newton steps as long as they halve the residual.
  void polish() {
    before_.setZero();
    for (int i = 0; i < most_polishing && largest(f_) > 0 && direction(0); ++i) {
      trial_ = q_ + p_;
      system_.force(trial_, trial_f_);
      if (!(largest(trial_f_) <= 0.5 * largest(f_))) return;
      move_to(trial_);
    }
  }

  Equilibrium end(Outcome outcome, const char* message) {
    CurvatureSigns signs;
    if (k_.coeffs().allFinite()) {
      signs = curvature_signs(system_, q_);
      curvature_ = smallest_curvature(system_, q_);
    }
    return {.outcome = outcome,
            .message = message,
            .q = q_,
            .residual = largest(f_),
            .smallest_eigenvalue = curvature_.value,
            .isolated = signs.negative + signs.flat == 0,
            .flat_directions = signs.flat,
            .iterations = iterations_};
  }

  const System& system_;
  Vec metric_{metric_of_all(system_)};
  EffectiveMass matrix_{system_, metric_};
  Vec start_;
  double length_, radius_{first_radius * length_};
  // The values at the place q.
  Vec q_, f_{system_.size()};
  SymmetricMatrix k_{system_.stiffness_pattern()};
  double v_ = 0, row_sum_ = 0, reach_ = 0;
  Curvature curvature_;
  Vec p_{system_.size()}, before_{Vec::Zero(system_.size())}, trial_, trial_f_{system_.size()};
  double shift_ = 0;        // a [1/s^2]
  double fall_ = infinite;  // of V by the last step [J]
  int iterations_ = 0, next_look_ = 0;
};

}  // namespace

Equilibrium find_equilibrium(const System& system, const Vec& start, double length) {
  if (system.size() == 0) return {.q = start};
  require_stiffness(system);
  return Descent(system, start, length).run();
}

}  // namespace qddot
