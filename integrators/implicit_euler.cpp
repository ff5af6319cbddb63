// Implicit (backward) Euler as optimisation, as the lecture ends:
//   v_{n+1} = argmin g(v),  g(v) = 1/2 (v - v_n)' M (v - v_n) + V(q_n + h v)
//   q_{n+1} = q_n + h v_{n+1}
// by Newton's method from the inertial prediction v = v_n:
//   gradient   r = M (v - v_n) - h f(q_n + h v)
//   direction  (M - h^2 K) p = -r
// Order 1. On q'' = -w^2 q the amplitude decays by 1/sqrt(1 + h^2 w^2) each step, at every h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/fixed_step.hpp"
#include "integrators/registry.hpp"
#include "src/algebra/effective_mass.hpp"

namespace qddot {
namespace {

// The last correction may change the velocity by this fraction of the largest one; Newton's
// convergence is quadratic, so what it leaves is about the square of it.
constexpr double tolerance = 1e-6;
constexpr int most_iterations = 100;
constexpr int most_halvings = 30;
constexpr double least_shift = 1.0 / 64;
constexpr int most_shifts = 60;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

class ImplicitEuler final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  void start(const State&) override { factorized_h_ = shift_ = 0; }

  Outcome step(const State& now, double h, State& next) override {
    next.v = now.v;
    gradient(now, h, next);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      if (must_stop()) return Outcome::over_budget;
      if (const Outcome outcome = direction(h, next.q); outcome != Outcome::reached_end) {
        return outcome;
      }
      ++counts().newton_iterations;
      if (shift_ == 0 && (system().stiffness_is_constant() || is_small(h, now, next))) {
        next.v += p_;
        next.q = now.q + h * next.v;
        return Outcome::reached_end;
      }
      if (!search(now, h, next)) return Outcome::newton_failed;
    }
    return Outcome::newton_failed;
  }

  // q = q_n + h v and r at v = next.v.
  void gradient(const State& now, double h, State& next) {
    next.q = now.q + h * next.v;
    force(next.q, f_);
    r_ = system().mass().cwiseProduct(next.v - now.v) - h * f_;
  }

  // p = -(a M - h^2 K(q))^-1 r with a = 1 where that is positive definite; where it is not, some
  // a > 1 that makes it so, which keeps p a direction of descent. The last a is where the search
  // for the next begins.
  Outcome direction(double h, const Vec& q) {
    if (!system().stiffness_is_constant() || h != factorized_h_) {
      stiffness(q, k_);
      if (!k_.coeffs().allFinite()) return Outcome::not_finite;
      factorized_h_ = h;
      shift_ = shift_ > least_shift ? shift_ / 4 : 0;
      for (int tries = 0; !is_positive(1 + shift_, h * h); ++tries) {
        if (tries == most_shifts) return Outcome::indefinite_matrix;
        shift_ = std::max(least_shift, 4 * shift_);
      }
    }
    matrix_.solve(r_, p_);
    ++counts().solves;
    p_ = -p_;
    return p_.allFinite() ? Outcome::reached_end : Outcome::not_finite;
  }

  bool is_positive(double a, double s) {
    ++counts().factorizations;
    return matrix_.factorize_positive(a, s, k_);
  }

  // Whether p is within the tolerance, or too small to move any node by more than rounding.
  bool is_small(double h, const State& now, const State& next) const {
    const double p = p_.lpNorm<Eigen::Infinity>();
    const double v = std::max(now.v.lpNorm<Eigen::Infinity>(), next.v.lpNorm<Eigen::Infinity>());
    return p <= tolerance * v || h * p <= 4 * epsilon * next.q.lpNorm<Eigen::Infinity>();
  }

  // Moves v along p by the first of 1, 1/2, 1/4, ... that halves the gradient, or else decreases g
  // by Armijo's rule; the first test costs nothing, since the next iteration needs that gradient.
  bool search(const State& now, double h, State& next) {
    v_ = next.v;
    const double norm = r_.norm(), slope = r_.dot(p_);
    const double g = objective(now, next);
    double alpha = 1;
    for (int halvings = 0; halvings < most_halvings; ++halvings, alpha /= 2) {
      next.v = v_ + alpha * p_;
      gradient(now, h, next);
      if (r_.norm() <= 0.5 * norm) return true;
      if (objective(now, next) <= g + 1e-4 * alpha * slope) return true;
    }
    return false;
  }

  double objective(const State& now, const State& next) const {
    return system().kinetic(next.v - now.v) + system().potential(next.q);
  }

  Vec f_{system().size()}, r_{system().size()}, p_{system().size()}, v_{system().size()};
  SymmetricMatrix k_{system().stiffness_pattern()};
  EffectiveMass matrix_{system()};
  double factorized_h_ = 0;
  double shift_ = 0;  // the factors are those of (1 + shift) M - h^2 K
};

}  // namespace

Method implicit_euler() {
  return {.name = "implicit_euler",
          .summary = "backward Euler by Newton on the incremental potential; damps at every h",
          .source = "Martin, Thomaszewski, Grinspun, Gross, SIGGRAPH 2011, section 4",
          .implicit = true,
          .needs_stiffness = true,
          .accepts_massless = true,
          .make = create<ImplicitEuler>};
}

}  // namespace qddot
