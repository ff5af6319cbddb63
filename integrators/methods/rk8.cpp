// The order-8 formula of Prince and Dormand's pair in steps of constant length. On
// (q, v)' = (v, M^-1 f), with the coefficients a_ij, b_i and c_i of its 13 stages:
//   Q_i = q_n + h sum_{j<i} a_ij V_j,   V_i = v_n + h sum_{j<i} a_ij A_j
//   A_i = M^-1 f(t_n + c_i h, Q_i, V_i)
//   q_{n+1} = q_n + h sum b_i V_i,   v_{n+1} = v_n + h sum b_i A_i
// It takes 13 forces a step. Nystrom's methods and splittings of that order need fewer, but only
// for forces that do not depend on velocities. A vibration q'' = -w^2 q grows by 1.4e-8 a step at
// h w = 1 and decays from h w = 1.6 to 3.7; beyond, it grows fast.
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/base/prince_dormand_pair.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot::registered {
namespace {

class Rk8 final : public Formula {
 public:
  using Formula::Formula;

  Outcome step(const State& now, double h, State& next) {
    next.work = now.work;
    for (std::size_t i = 0; i < pair_.c.size(); ++i) {
      const std::span<const double> row = pair_.a[i];
      add_combination(now.q, h, v_, row, stage_.q);
      add_combination(now.v, h, a_, row, stage_.v);
      stage_.t = now.t + pair_.c[i] * h;
      force(stage_, f_);
      const auto column = static_cast<Index>(i);
      v_.col(column) = stage_.v;
      divide(f_, system().mass(), a_.col(column));
      if (does_work()) next.work += h * pair_.b[i] * power();
    }
    add_combination(now.q, h, v_, pair_.b, next.q);
    add_combination(now.v, h, a_, pair_.b, next.v);
    return Outcome::reached_end;
  }

 private:
  const ExplicitPair& pair_ = prince_dormand_pair();
  Eigen::MatrixXd v_{system().size(), std::ssize(pair_.c)}, a_{v_};  // a column for each stage
  State stage_{0, Vec(system().size()), Vec(system().size())};
  Vec f_{system().size()};
};

}  // namespace

Method rk8() {
  return {
      .name = "rk8",
      .summary = "Prince and Dormand's order 8 in constant steps; 13 forces, also of velocities",
      .source = "Prince and Dormand, J. Computational and Applied Mathematics 7 (1981) 67-75",
      .order = 8,
      .stability_limit = 0,
      .make = create<Rk8>};
}

}  // namespace qddot::registered
