// local_global accelerated by Anderson's method. The last iterates v_i of the velocity have the
// local/global steps p_i. Their combination with the shortest step gives the next iterate:
//   (M + h^2 L) p_i = M (v_i - v_n) - h f(q_n + h v_i)
//   theta   = argmin |p_k - sum_i theta_i (p_{i+1} - p_i)|
//   v_{k+1} = (v_k - p_k) - sum_i theta_i ((v_{i+1} - p_{i+1}) - (v_i - p_i))
// The sums have the last 5 differences at most. If the energy of the implicit Euler step does not
// fall, the plain step v_{k+1} = v_k - p_k is taken instead.
#include <array>

#include <Eigen/Dense>

#include "qddot/integrators/base/local_global.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

constexpr int window = 5;

class Anderson final : public LocalGlobal {
 public:
  explicit Anderson(SystemRun& run) : LocalGlobal(run) {
    for (int i = 0; i < window; ++i) dp_[i] = dg_[i] = Vec(system().size());
  }

 private:
  using Small = Eigen::Matrix<double, window, window>;
  using SmallVector = Eigen::Matrix<double, window, 1>;

  void begin_step() override { iteration_ = 0; }

  void iterate(Vec& v) override {
    gradient(v, r_);
    direction(r_, p_);
    g_ = v - p_;
    if (iteration_ == 0) {
      plain_step(v, r_, p_);
      energy_ = objective(v);
    } else {
      remember();
      combine();
      if (const double energy = objective(trial_); energy <= energy_) {
        v.swap(trial_);
        energy_ = energy;
      } else {
        plain_step(v, r_, p_);
        energy_ = objective(v);
      }
    }
    last_p_.swap(p_);
    last_g_.swap(g_);
    ++iteration_;
  }

  // The newest differences replace the oldest.
  void remember() {
    const int at = (iteration_ - 1) % window;
    dp_[at] = p_ - last_p_;
    dg_[at] = g_ - last_g_;
    for (int i = 0; i < remembered(); ++i) gram_(i, at) = gram_(at, i) = dp_[i].dot(dp_[at]);
  }

  int remembered() const { return std::min(iteration_, window); }

  // Computes the weights of the differences. A term on the diagonal keeps rounding from deciding
  // those of almost parallel ones.
  void combine() {
    const int m = remembered();
    for (int i = 0; i < m; ++i) theta_[i] = dp_[i].dot(p_);
    constexpr double rounding = 1e-14;
    Small gram = gram_;
    gram.diagonal().array() += rounding * gram.diagonal().head(m).maxCoeff();
    for (int i = m; i < window; ++i) {
      gram.row(i).setZero();
      gram.col(i).setZero();
      gram(i, i) = 1;
      theta_[i] = 0;
    }
    theta_ = gram.ldlt().solve(theta_).eval();
    trial_ = g_;
    for (int i = 0; i < m; ++i) trial_ -= theta_[i] * dg_[i];
  }

  int iteration_ = 0;
  double energy_ = 0;
  std::array<Vec, window> dp_, dg_;
  Small gram_ = Small::Zero();
  SmallVector theta_ = SmallVector::Zero();
  Vec r_{system().size()}, p_{system().size()}, g_{system().size()}, trial_{system().size()};
  Vec last_p_{system().size()}, last_g_{system().size()};
};

}  // namespace

Method local_global_anderson() {
  return {.name = "local_global_anderson",
          .summary = "local_global, its iterations accelerated by Anderson's method",
          .source =
              "Peng, Deng, Zhang, Geng, Qin, Liu, Anderson Acceleration for Geometry "
              "Optimization and Physics Simulation, SIGGRAPH 2018",
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::laplacian},
          .takes = {Option::iterations},
          .damped = Damped::by_any,
          .make = create<Anderson>};
}

}  // namespace qddot::registered
