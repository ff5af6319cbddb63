#include "qddot/integrators/base/symmetric_multistep.hpp"

#include <utility>

#include "qddot/model/vector_updates.hpp"

namespace qddot {
namespace {

// The weights in h v_N of g_N, if first = 0, and of u_{N-1}, u_{N-2}, ..., with h^2 g_{N-j} = r_0
// u_{N-j} + r_1 u_{N-j-1} + ...
std::vector<double> weights_of_history(int first, int count, const std::vector<double>& r) {
  const std::vector<double> w = velocity_weights(first, count);
  std::vector<double> weights(2 * r.size() - 1);
  if (first == 0) weights[0] = w[0];
  for (std::size_t i = first == 0 ? 1 : 0; i < w.size(); ++i) {
    const std::size_t j = i + static_cast<std::size_t>(first);
    for (std::size_t l = 0; l < r.size(); ++l) weights[j + l] += w[i] * r[l];
  }
  return weights;
}

}  // namespace

SymmetricMultistep::SymmetricMultistep(const Method& method, const System& system,
                                       const Options& options, const SymmetricFormula& formula)
    : FixedStep(method, system, options),
      formula_(formula),
      r_(formula.cofactor()),
      b_(formula.all_beta()),
      with_force_(weights_of_history(0, formula.steps - 1, r_)),
      without_(weights_of_history(1, formula.steps - 2, r_)),
      symmetric_start_(symmetric_start(formula)),
      stages_(formula.single_step(), system.size()),
      first_(formula.steps - 1, system.size()),
      u_(2 * static_cast<std::size_t>(formula.steps) - 3, Vec(system.size())),
      d_(system.size()),
      d_next_(system.size()),
      f_(system.size()),
      a_(system.size()) {
  past_.reserve(u_.size());
  weights_.reserve(u_.size());
}

void SymmetricMultistep::start(const State&) {
  h_ = options().step_size;
  h2_by_mass_ = h_ * h_ * system().mass().cwiseInverse();
  begun_ = 0;
  force_is_known_ = has_history_ = false;
}

void SymmetricMultistep::evaluate(const Vec& q) {
  if (!force_is_known_) force(q, f_);
  force_is_known_ = true;
}

void SymmetricMultistep::single_step(const State& now, double h, State& next) {
  const NystromPair& pair = formula_.single_step();
  const Vec& mass = system().mass();
  evaluate(now.q);
  divide(f_, mass, a_);
  stages_.compute(now.q, now.v, a_, h, [&](const Vec& stage, MutableVec k) {
    force(stage, f_);
    divide(f_, mass, k);
  });
  force_is_known_ = false;
  const Eigen::MatrixXd& k = stages_.k();
  add_combination(now.q, h, now.v, h * h, k, pair.b, next.q);
  add_combination(now.v, h, k, pair.b_prime, next.v);
}

void SymmetricMultistep::begin_from(const State& now) {
  const Vec& mass = system().mass();
  evaluate(now.q);
  divide(f_, mass, a_);
  first_.compute(now.q, now.v, a_, h_, formula_.steps / 2, [&](const Vec& q, MutableVec g) {
    force(q, f_);
    divide(f_, mass, g);
  });
  force_is_known_ = false;
}

void SymmetricMultistep::begin_history() {
  const std::ptrdiff_t m = formula_.steps - 2;
  const auto& [of_differences, of_forces] = symmetric_start_;
  // u_m, ..., u_1 and u_0, ..., u_{1-m} are those of 1, ..., 2m steps ago.
  newest_ = 0;
  const auto begin_sum = [&] {
    past_.clear();
    weights_.clear();
  };
  const auto add = [&](double weight, const double* x) {
    past_.push_back(x);
    weights_.push_back(weight);
  };
  for (std::ptrdiff_t l = 0; l < m; ++l) {
    begin_sum();
    for (std::ptrdiff_t n = 0; n < m; ++n) add(of_differences(l, n), first_.e(n + 1).data());
    for (std::ptrdiff_t n = 0; n < m; ++n) add(of_forces(l, n) * h_ * h_, first_.g(n + 1).data());
    set_combination(past_, weights_.data(), u(m + 1 + l));
  }
  for (std::ptrdiff_t n = 1; n <= m; ++n) {
    begin_sum();
    add(h_ * h_, first_.g(n).data());
    for (std::ptrdiff_t i = 1; i <= m; ++i) {
      add(-r_[static_cast<std::size_t>(i)], u(m + 1 - n + i).data());
    }
    set_combination(past_, weights_.data(), u(m + 1 - n));
  }
  d_ = first_.d(m);
}

void SymmetricMultistep::accepted() {
  force_is_known_ = false;
  if (has_history_) {
    newest_ = (newest_ + std::ssize(u_) - 1) % std::ssize(u_);
    std::swap(d_, d_next_);
  } else if (++begun_ == first_.steps()) {
    begin_history();
    has_history_ = force_is_known_ = true;  // the last of begin_from()
  }
}

void SymmetricMultistep::complete(State& now, bool may_evaluate) {
  if (may_evaluate) evaluate(now.q);
  const std::vector<double>& weights = may_evaluate ? with_force_ : without_;
  past_.clear();
  for (std::ptrdiff_t ago = 1; ago < std::ssize(weights); ++ago) past_.push_back(u(ago).data());
  set_combination(past_, weights.data() + 1, now.v);
  now.v += d_;
  if (may_evaluate) now.v += weights[0] * h2_by_mass_.cwiseProduct(f_);
  now.v /= h_;
}

double SymmetricMultistep::squared_speed(const State&) { return squared_norm(d_next_) / (h_ * h_); }

Outcome SymmetricMultistep::step(const State& now, double h, State& next) {
  if (h != h_) {
    single_step(now, h, next);
  } else if (!has_history_) {
    if (begun_ == 0) begin_from(now);
    next.q = now.q + first_.d(begun_);
    next.v = first_.v(begun_ + 1);
  } else {
    evaluate(now.q);
    past_.clear();
    for (std::ptrdiff_t ago = 0; ago + 1 < formula_.steps; ++ago) past_.push_back(u(ago).data());
    step_by_history({past_, r_.data(), b_.data()}, f_, h2_by_mass_, now.q, d_, u(0), d_next_,
                    next.q);
    leave_incomplete();
  }
  return Outcome::reached_end;
}

}  // namespace qddot
