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
#include "qddot/integrators/base/local_global.hpp"

#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

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

Method local_global() {
  return {.name = "local_global",
          .summary = "backward Euler by local/global steps: one matrix for all axes and all time",
          .source =
              "Liu, Bargteil, O'Brien, Kavan, Fast Simulation of Mass-Spring Systems, "
              "SIGGRAPH Asia 2013",
          .traits = {Trait::implicit},
          .needs = {Need::laplacian},
          .takes = {Option::iterations},
          .make = create<Plain>};
}

}  // namespace qddot::registered
