// Implicit Euler by the local/global iteration of Liu, Bargteil, O'Brien and Kavan. Each spring s
// of rest length l_s between nodes i and j has a vector d_s of its own. An iteration finds all
// vectors and then all positions x:
//   local    d_s = l_s (x_i - x_j)/|x_i - x_j|
//   global   (M + h^2 L) x = M (q_n + h v_n) + h^2 (J d + loads)
// L is the stiffness of the same springs with rest length zero, and J d are the forces of the
// vectors. L is constant, so M + h^2 L is factorised once for a step size. One N x N matrix serves
// all axes of N nodes.
//
// The force at x = q_n + h v is f(x) = -L x + J d(x) + loads, so it contains the local step. Then
// an iteration is one step of Newton's method with L in the place of -K:
//   (M + h^2 L) p = M (v - v_n) - h f(q_n + h v),   v <- v - p
// It takes one force and one solve. It lowers the energy of the implicit Euler step, since L >= -K
// wherever springs are. The first iteration already gives order 1: each one multiplies the error by
// a factor of order h^2.
//
// Springs with a quartic part are stiffer than L where they are long. There p is shortened until it
// lowers the energy.
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
          .needs = {Need::conservative, Need::laplacian},
          .takes = {Option::iterations},
          .damped = Damped::by_any,
          .make = create<Plain>};
}

}  // namespace qddot::registered
