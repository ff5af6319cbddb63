#include "qddot/integrators/base/nystrom.hpp"

#include "qddot/model/vector_updates.hpp"

namespace qddot {
namespace {

std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

}  // namespace

Nystrom::Nystrom(SystemRun& run, const NystromPair& pair, std::size_t instants)
    : AdaptiveStep(run, {pair.lower_order, instants, pair.is_first_same_as_last()}),
      pair_(pair),
      error_b_(difference(pair.b, pair.lower_b)),
      error_b_prime_(difference(pair.b_prime, pair.lower_b_prime)),
      is_first_same_as_last_(pair.is_first_same_as_last()),
      stages_(pair, system().size()),
      w_max_(system()) {}

void Nystrom::start(const State& state) {
  AdaptiveStep::start(state);
  w_max_.start();
}

double Nystrom::longest_step(const Instant& now) {
  const double w_max = w_max_.at(counts().steps, [&](SymmetricMatrix& k) {
    stiffness({now.state.t, now.state.q}, k);
  });
  return w_max > 0 ? pair_.stable_hw / w_max : INFINITY;
}

Outcome Nystrom::attempt(const Instant& now, double h, Instant& next, Vec& error_q, Vec& error_v) {
  const Vec &q = now.state.q, &v = now.state.v;
  Work work;
  auto weight = pair_.b_prime.begin();
  if (is_driven()) work = *weight++ * power({now.state.t, q});
  stages_.compute(q, v, now.a, h, [&](double t, const Vec& stage, MutableVec k) {
    acceleration({now.state.t + t, stage}, k);
    if (is_driven()) work += *weight++ * driving_power();
  });
  next.state.work = now.state.work + h * work;
  const Eigen::MatrixXd& k = stages_.k();
  if (is_first_same_as_last_) next.a = k.rightCols<1>();
  add_combination(q, h, v, h * h, k, pair_.b, next.state.q);
  add_combination(v, h, k, pair_.b_prime, next.state.v);
  set_combination(h * h, k, error_b_, error_q);
  set_combination(h, k, error_b_prime_, error_v);
  return Outcome::reached_end;
}

}  // namespace qddot
