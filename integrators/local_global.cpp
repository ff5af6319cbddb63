// Implicit Euler by the local/global iteration of Liu, Bargteil, O'Brien and Kavan: with every
// spring given a direction of its own,
//   local    d_s = l0_s (x_i - x_j) / |x_i - x_j|
//   global   (M + h^2 L) x = M (q_n + h v_n) + h^2 (J d + loads)
// For fixed d the energy is quadratic, with the constant matrix L of the same springs at rest
// length zero; and since f(x) = -L x + J d(x) + loads, the two together are one step of Newton's
// method with L in the place of -K:
//   (M + h^2 L) p = M (v - v_n) - h f(q_n + h v),   v = v - p
// so that the local step is in f. Each iteration lowers the energy, since L >= -K wherever springs
// are, and costs one force and N x N solves for all axes at once. Order 1 after one iteration
// already: the iteration contracts by O(h^2).
//
// Springs with a quartic part are stiffer than L where they are long; there the step is shortened
// until it lowers the energy.
#include "integrators/local_global.hpp"

#include <cmath>

#include "integrators/registry.hpp"

namespace qddot {

namespace {

constexpr int usual_iterations = 10;
constexpr int most_halvings = 60;

class Plain final : public LocalGlobal {
 public:
  using LocalGlobal::LocalGlobal;

 private:
  void iterate(Vec& v) override {
    gradient(v, r_);
    direction(r_, p_);
    plain_step(v, r_, p_);
  }

  Vec r_{system().size()}, p_{system().size()};
};

}  // namespace

LocalGlobal::LocalGlobal(const Method& method, const System& system, const Knobs& knobs)
    : FixedStep(method, system, knobs),
      iterations_(knobs.iterations > 0 ? knobs.iterations : usual_iterations),
      matrix_(system) {}

Outcome LocalGlobal::step(const State& now, double h, State& next) {
  if (h != factorized_h_) {
    ++counts().factorizations;
    const Stopwatch watch(seconds(), &Seconds::factorization);
    if (!matrix_.factorize(h * h)) return Outcome::indefinite_matrix;
    factorized_h_ = h;
  }
  now_ = &now;
  h_ = h;
  next.v = now.v;
  begin();
  for (int i = 0; i < iterations_; ++i) {
    if (must_stop()) return Outcome::over_budget;
    iterate(next.v);
    if (!is_finite_) return Outcome::not_finite;
  }
  next.q = now.q + h * next.v;
  return Outcome::reached_end;
}

void LocalGlobal::gradient(const Vec& v, Vec& r) {
  q_ = now_->q + h_ * v;
  force(q_, f_);
  r = system().mass().cwiseProduct(v - now_->v) - h_ * f_;
}

void LocalGlobal::direction(const Vec& r, Vec& p) {
  ++counts().solves;
  const Stopwatch watch(seconds(), &Seconds::solve);
  matrix_.solve(r, p);
  is_finite_ = std::isfinite(p.sum());
}

double LocalGlobal::objective(const Vec& v) {
  q_ = v - now_->v;
  const double kinetic = system().kinetic(q_);
  q_ = now_->q + h_ * v;
  return kinetic + system().potential(q_);
}

void LocalGlobal::search(Vec& v, const Vec& p, double slope, double& g) {
  double alpha = 1;
  for (int halvings = 0; halvings < most_halvings; ++halvings, alpha /= 2) {
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

Method local_global() {
  return {.name = "local_global",
          .summary = "backward Euler by local/global steps: one matrix for all axes and all time",
          .source =
              "Liu, Bargteil, O'Brien, Kavan, Fast Simulation of Mass-Spring Systems, "
              "SIGGRAPH Asia 2013",
          .implicit = true,
          .needs_laplacian = true,
          .takes_iterations = true,
          .make = create<Plain>};
}

}  // namespace qddot
