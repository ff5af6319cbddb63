#include "qddot/integrators/base/nystrom.hpp"

#include <algorithm>

#include "qddot/integrators/base/table_row.hpp"

namespace qddot {
bool NystromPair::is_first_same_as_last() const {
  return c.back() == 1 && std::equal(a.back().begin(), a.back().end(), b.begin()) && b.back() == 0;
}

Nystrom::Nystrom(const Method& method, const System& system, const Options& options,
                 const NystromPair& pair, std::size_t instants)
    : AdaptiveStep(method, system, options, {pair.lower_order, instants}),
      pair_(pair),
      b_(as_vec(pair.b)),
      b_prime_(as_vec(pair.b_prime)),
      error_b_(b_ - as_vec(pair.lower_b)),
      error_b_prime_(b_prime_ - as_vec(pair.lower_b_prime)),
      is_first_same_as_last_(pair.is_first_same_as_last()),
      k_(system.size(), b_.size()),
      stage_(system.size()),
      w_max_(system) {}

void Nystrom::start(const State& state) {
  AdaptiveStep::start(state);
  w_max_.start();
}

double Nystrom::longest_step(const Instant& now) {
  const double w_max =
      w_max_.at(counts().steps, [&](SymmetricMatrix& k) { stiffness(now.state.q, k); });
  return w_max > 0 ? pair_.stable_hw / w_max : INFINITY;
}

Outcome Nystrom::attempt(const Instant& now, double h, Instant& next, Vec& error_q, Vec& error_v) {
  const Vec &q = now.state.q, &v = now.state.v;
  k_.col(0) = now.a;
  for (Index i = 1; i < k_.cols(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    stage_ = q + (pair_.c[row] * h) * v;
    stage_.noalias() += (h * h) * (k_.leftCols(i) * as_vec(pair_.a[row]));
    acceleration(stage_, next.a);
    k_.col(i) = next.a;
  }
  next.state.q = q + h * v;
  next.state.q.noalias() += (h * h) * (k_ * b_);
  next.state.v = v;
  next.state.v.noalias() += h * (k_ * b_prime_);
  error_q.noalias() = (h * h) * (k_ * error_b_);
  error_v.noalias() = h * (k_ * error_b_prime_);
  return Outcome::reached_end;
}

void Nystrom::accepted(Instant& next) {
  if (!is_first_same_as_last_) AdaptiveStep::accepted(next);
}

}  // namespace qddot
