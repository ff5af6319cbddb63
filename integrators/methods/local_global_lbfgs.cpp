// Implicit Euler by L-BFGS, with the matrix of local_global as its first metric. With the gradient
// r of the step's energy at the velocity v:
//   r_i = M (v_i - v_n) - h f(q_n + h v_i)
//   H_0 = (M + h^2 L)^-1
//   v_{i+1} = v_i - alpha H_i r_i
// H_i is H_0 corrected by the last 5 differences of v and r, in the two loops of Nocedal. A line
// search on the energy of the step chooses alpha.
//
// The first iteration is that of local_global, and differences are taken from then on. So the
// momentum of free bodies is right after the first iteration, and no difference has any.
#include <algorithm>
#include <array>
#include <cmath>

#include "qddot/integrators/base/local_global.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::registered {
namespace {

constexpr int most_pairs = 5;
// A decrease of the energy by less than this fraction is rounding.
constexpr double hidden = 100 * machine_epsilon;

class Lbfgs final : public LocalGlobal {
 public:
  explicit Lbfgs(SystemRun& run) : LocalGlobal(run) {
    for (Pair& pair : pairs_) pair.s = pair.y = Vec(system().size());
  }

 private:
  struct Pair {
    Vec s, y;
    double sy = 0, alpha = 0;
  };

  void begin_step() override {
    pairs_used_ = pairs_seen_ = iteration_ = 0;
    is_at_rounding_ = false;
  }

  void iterate(Vec& v) override {
    gradient(v, r_);
    if (iteration_ == 0) energy_ = objective(v);
    if (iteration_ > 1 && !is_at_rounding_) remember(v);
    if (iteration_++ == 0 || is_at_rounding_) {
      last_v_ = v;
      direction(r_, p_);
      plain_step(v, r_, p_);
      energy_ = objective(v);
      return;
    }
    last_v_ = v;
    last_r_ = r_;
    for (int i = 0; i < pairs_used_; ++i) {
      Pair& pair = newest(i);
      pair.alpha = pair.s.dot(r_) / pair.sy;
      r_ -= pair.alpha * pair.y;
    }
    direction(r_, p_);
    for (int i = pairs_used_; i-- > 0;) {
      const Pair& pair = newest(i);
      p_ += (pair.alpha - pair.y.dot(p_) / pair.sy) * pair.s;
    }
    const double slope = last_r_.dot(p_);
    is_at_rounding_ = !(slope > hidden * std::abs(energy_));
    search(v, p_, slope, energy_);
  }

  // A pair without curvature would make the metric indefinite. It is left out, and so is the oldest
  // pair, whose place it has taken.
  void remember(const Vec& v) {
    Pair& pair = pairs_[pairs_seen_ % most_pairs];
    pair.s = v - last_v_;
    pair.y = r_ - last_r_;
    pair.sy = pair.s.dot(pair.y);
    if (pair.sy > machine_epsilon * pair.s.norm() * pair.y.norm()) {
      ++pairs_seen_;
      pairs_used_ = std::min(pairs_used_ + 1, most_pairs);
    } else {
      pairs_used_ = std::min(pairs_used_, most_pairs - 1);
    }
  }

  Pair& newest(int i) { return pairs_[(pairs_seen_ - 1 - i) % most_pairs]; }

  bool is_at_rounding_ = false;  // differences are noise from here on; plain steps do no harm
  int iteration_ = 0, pairs_seen_ = 0, pairs_used_ = 0;
  double energy_ = 0;
  std::array<Pair, most_pairs> pairs_;
  Vec r_{system().size()}, p_{system().size()}, last_v_{system().size()}, last_r_{system().size()};
};

}  // namespace

Method local_global_lbfgs() {
  return {.name = "local_global_lbfgs",
          .summary = "backward Euler by L-BFGS, with local_global's matrix as its first metric",
          .source =
              "Liu, Bouaziz, Kavan, Quasi-Newton Methods for Real-Time Simulation of "
              "Hyperelastic Materials, ACM TOG 36:3, 2017",
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::laplacian},
          .takes = {Option::iterations},
          .damped = Damped::by_any,
          .make = create<Lbfgs>};
}

}  // namespace qddot::registered
