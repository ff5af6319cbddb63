#include "qddot/integrators/base/nystrom.hpp"

#include <algorithm>

#include "qddot/model/vector_updates.hpp"

namespace qddot {
namespace {

std::vector<double> difference(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

}  // namespace

bool NystromPair::is_first_same_as_last() const {
  return c.back() == 1 && std::equal(a.back().begin(), a.back().end(), b.begin()) && b.back() == 0;
}

Nystrom::Nystrom(const Method& method, const System& system, const Options& options,
                 const NystromPair& pair, std::size_t instants)
    : AdaptiveStep(method, system, options, {pair.lower_order, instants}),
      pair_(pair),
      error_b_(difference(pair.b, pair.lower_b)),
      error_b_prime_(difference(pair.b_prime, pair.lower_b_prime)),
      is_first_same_as_last_(pair.is_first_same_as_last()),
      k_(system.size(), std::ssize(pair.b)),
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
    add_combination(q, pair_.c[row] * h, v, h * h, k_, pair_.a[row], stage_);
    acceleration(stage_, k_.col(i));
  }
  if (is_first_same_as_last_) next.a = k_.rightCols<1>();
  add_combination(q, h, v, h * h, k_, pair_.b, next.state.q);
  add_combination(v, h, k_, pair_.b_prime, next.state.v);
  set_combination(h * h, k_, error_b_, error_q);
  set_combination(h, k_, error_b_prime_, error_v);
  return Outcome::reached_end;
}

void Nystrom::accepted(Instant& next) {
  if (!is_first_same_as_last_) AdaptiveStep::accepted(next);
}

}  // namespace qddot
