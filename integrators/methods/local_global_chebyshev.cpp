// local_global accelerated by Chebyshev's semi-iterative method. With the local/global step p_k at
// the iterate v_k of the velocity, the next iterate is
//   (M + h^2 L) p_k = M (v_k - v_n) - h f(q_n + h v_k)
//   v_{k+1} = omega_{k+1} (v_k - gamma p_k - v_{k-1}) + v_{k-1},   gamma = 2/(2 - rho)
//   omega_1 = 1,   omega_2 = 2/(2 - sigma^2),   omega_{k+1} = 4/(4 - sigma^2 omega_k)
//   sigma = rho/(2 - rho),   rho = h^2 w^2/(1 + h^2 w^2)
// Here w is the largest frequency of L x = w^2 M x, with the matrix L of local_global. If few
// iterations are made, sigma is smaller: the largest one for which they gain a digit.
//
// Near the solution a plain iteration multiplies errors by T = I - (M + h^2 L)^-1 (M - h^2 K). Its
// eigenvalues lie in [0, rho] where no spring is compressed: L bounds -K, so that T >= 0. The
// recurrence makes the polynomial of T that is smallest on that interval. Wang's polynomial is the
// one for [-rho, rho].
//
// The first iteration is a plain one. After it the momentum of free bodies is right and stays so.
// If p^T (M + h^2 L) p grows from one iteration to the next, the recurrence starts again with a
// plain step.
#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/base/local_global.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

class Chebyshev final : public LocalGlobal {
 public:
  explicit Chebyshev(SystemRun& run) : LocalGlobal(run) {
    SymmetricMatrix l = system().stiffness_pattern();
    system().laplacian()->assemble_laplacian(l);
    Vec row_sums;
    frequency_ = frequency_bound(system().mass(), l, row_sums);
    if (!is_damped() || !system().damping()->bound_damping(l)) return;
    const double root = frequency_bound(system().mass(), l, row_sums);
    friction_ = root * root;
  }

 private:
  // Takes the widest interval in which k iterations gain a digit. In a few iterations a narrower
  // interval is better: errors inside shrink faster, and those outside hardly grow.
  void begin_step() override {
    const double hw = step_size() * frequency_;
    const double size = hw * hw + step_size() * friction_, widest = size / (1 + size);
    const double few = 1 / std::cosh(std::acosh(10.0) / iterations());
    const double sigma = std::min(widest / (2 - widest), few);
    sigma_squared_ = sigma * sigma;
    gamma_ = 1 + sigma;
    omega_ = 0;
    size_ = std::numeric_limits<double>::infinity();
  }

  void iterate(Vec& v) override {
    gradient(v, r_);
    direction(r_, p_);
    const double size = r_.dot(p_);
    if (omega_ == 0 || !(size < size_)) {
      plain_step(v, r_, p_);
      omega_ = -1;
    } else if (omega_ < 0) {
      move(v, 1);
    } else {
      move(v, omega_ == 1 ? 2 / (2 - sigma_squared_) : 4 / (4 - sigma_squared_ * omega_));
    }
    size_ = size;
  }

  void move(Vec& v, double omega) {
    trial_ = v - gamma_ * p_;
    if (omega != 1) trial_ = omega * (trial_ - before_) + before_;
    if (!descends() && !(objective(trial_) < objective(v))) {
      plain_step(v, r_, p_);
      omega_ = -1;
      return;
    }
    before_ = v;
    v.swap(trial_);
    omega_ = omega;
  }

  double frequency_, friction_ = 0;  // bounds of L and of the bound of C, beside M [1/s]
  double sigma_squared_ = 0, gamma_ = 1;
  double omega_ = 0;  // of the last iteration; 0 at the start of a step, -1 after a plain one
  double size_ = 0;   // r'p of the last iteration
  Vec r_{system().size()}, p_{system().size()}, trial_{system().size()}, before_{system().size()};
};

}  // namespace

Method local_global_chebyshev() {
  return {.name = "local_global_chebyshev",
          .summary = "local_global, its iterations accelerated by Chebyshev's polynomials",
          .source =
              "Wang, A Chebyshev Semi-Iterative Approach for Accelerating Projective and "
              "Position-Based Dynamics, SIGGRAPH Asia 2015",
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::laplacian},
          .takes = {Option::iterations},
          .damped = Damped::by_any,
          .make = create<Chebyshev>};
}

}  // namespace qddot::registered
