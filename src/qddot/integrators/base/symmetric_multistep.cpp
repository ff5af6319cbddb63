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

SymmetricMultistep::SymmetricMultistep(SystemRun& run, const SymmetricFormula& formula)
    : Formula(run),
      formula_(formula),
      r_(formula.cofactor()),
      b_(formula.all_beta()),
      with_force_(weights_of_history(0, formula.steps - 1, r_)),
      without_(weights_of_history(1, formula.steps - 2, r_)),
      symmetric_start_(symmetric_start(formula)),
      stages_(formula.single_step(), system().size()),
      first_(formula.steps - 1, system().size()),
      integrals_(step_integrals(formula.steps - 1)),
      u_(2 * static_cast<std::size_t>(formula.steps) - 3, Vec(system().size())),
      f_(system().size()),
      a_(system().size()) {
  past_.reserve(u_.size());
  weights_.reserve(u_.size());
}

void SymmetricMultistep::begin(const State& state, X& x) {
  h_ = options().step_size;
  h2_by_mass_ = h_ * h_ * system().mass().cwiseInverse();
  static_cast<State&>(x) = state;
  x.d.resize(state.q.size());
  x.f.resize(state.q.size());
  x.begun = 0;
  x.newest = 0;
  x.has_force = x.has_history = false;
  x.has_velocity = true;
  state_ = state;
}

void SymmetricMultistep::evaluate(X& x) {
  if (!x.has_force) force({x.t, x.q}, x.f);
  x.has_force = true;
}

void SymmetricMultistep::single_step(X& x, double h, X& next) {
  const NystromPair& pair = formula_.single_step();
  const Mass& mass = system().mass();
  show(x, true, state_);
  evaluate(x);
  divide(x.f, mass, a_);
  Work work;
  auto weight = pair.b_prime.begin();
  if (is_driven()) work = *weight++ * power({x.t, state_.q});
  stages_.compute(state_.q, state_.v, a_, h, [&](double t, const Vec& stage, MutableVec k) {
    force({x.t + t, stage}, f_);
    divide(f_, mass, k);
    if (is_driven()) work += *weight++ * driving_power();
  });
  next.work = x.work + h * work;
  const Eigen::MatrixXd& k = stages_.k();
  add_combination(state_.q, h, state_.v, h * h, k, pair.b, next.q);
  add_combination(state_.v, h, k, pair.b_prime, next.v);
}

void SymmetricMultistep::begin_from(X& x) {
  const Mass& mass = system().mass();
  evaluate(x);
  divide(x.f, mass, a_);
  first_.compute(x.q, x.v, a_, h_, formula_.steps / 2, [&](double t, const Vec& q, MutableVec g) {
    force({x.t + t, q}, f_);
    divide(f_, mass, g);
  });
  if (!is_driven()) return;
  powers_ = {power({x.t, x.q})};
  state_.q = x.q;
  for (Index j = 0; j < first_.steps(); ++j) {
    state_.q += first_.d(j);
    powers_.push_back(power({x.t + static_cast<double>(j + 1) * h_, state_.q}));
  }
}

// The work of driving in step j of the last `steps` [J]. It is exact for polynomials through the
// powers at all their ends, so that work has the order of the positions.
Work SymmetricMultistep::work_of_step(Index j) const {
  Work work;
  for (Index l = 0; l < std::ssize(powers_); ++l) {
    work += (h_ * integrals_.once(j, l)) * powers_[static_cast<std::size_t>(l)];
  }
  return work;
}

void SymmetricMultistep::begin_history(X& x) {
  const std::ptrdiff_t m = formula_.steps - 2;
  const auto& [of_differences, of_forces] = symmetric_start_;
  // u_m, ..., u_1 and u_0, ..., u_{1-m} are those of 1, ..., 2m steps ago.
  x.newest = 0;
  const auto begin_sum = [&] {
    past_.clear();
    weights_.clear();
  };
  const auto add = [&](double weight, const double* z) {
    past_.push_back(z);
    weights_.push_back(weight);
  };
  for (std::ptrdiff_t l = 0; l < m; ++l) {
    begin_sum();
    for (std::ptrdiff_t n = 0; n < m; ++n) add(of_differences(l, n), first_.e(n + 1).data());
    for (std::ptrdiff_t n = 0; n < m; ++n) add(of_forces(l, n) * h_ * h_, first_.g(n + 1).data());
    set_combination(past_, weights_.data(), u(x, m + 1 + l));
  }
  for (std::ptrdiff_t n = 1; n <= m; ++n) {
    begin_sum();
    add(h_ * h_, first_.g(n).data());
    for (std::ptrdiff_t i = 1; i <= m; ++i) {
      add(-r_[static_cast<std::size_t>(i)], u(x, m + 1 - n + i).data());
    }
    set_combination(past_, weights_.data(), u(x, m + 1 - n));
  }
  x.d = first_.d(m);
  x.f = f_;  // the last of begin_from()
  x.has_history = x.has_force = true;
}

void SymmetricMultistep::show(X& x, bool may_evaluate, State& state) {
  state.q = x.q;
  state.v = x.v;
  if (x.has_velocity) return;
  if (may_evaluate) evaluate(x);
  const std::vector<double>& weights = may_evaluate ? with_force_ : without_;
  past_.clear();
  for (std::ptrdiff_t ago = 1; ago < std::ssize(weights); ++ago) past_.push_back(u(x, ago).data());
  set_combination(past_, weights.data() + 1, x.v);
  x.v += x.d;
  if (may_evaluate) x.v += weights[0] * h2_by_mass_.cwiseProduct(x.f);
  x.v /= h_;
  x.has_velocity = true;
  state.v = x.v;
}

double SymmetricMultistep::squared_speed(const X& next) {
  return next.has_velocity ? squared_norm(next.v) : squared_norm(next.d) / (h_ * h_);
}

Outcome SymmetricMultistep::step(X& x, double h, X& next) {
  next.has_force = false;
  if (h != h_) {
    single_step(x, h, next);
    next.has_history = false;
    next.begun = 0;
    next.has_velocity = true;
  } else if (!x.has_history) {
    if (x.begun == 0) begin_from(x);
    next.q = x.q + first_.d(x.begun);
    next.v = first_.v(x.begun + 1);
    next.begun = x.begun + 1;
    next.work = x.work;
    if (is_driven()) next.work += work_of_step(x.begun);
    next.has_velocity = true;
    next.has_history = false;
    if (next.begun == first_.steps()) begin_history(next);
  } else {
    evaluate(x);
    past_.clear();
    for (std::ptrdiff_t ago = 0; ago + 1 < formula_.steps; ++ago) past_.push_back(u(x, ago).data());
    step_by_history({past_, r_.data(), b_.data()}, x.f, h2_by_mass_, x.q, x.d, u(x, 0), next.d,
                    next.q);
    next.newest = (x.newest + std::ssize(u_) - 1) % std::ssize(u_);
    next.has_history = true;
    next.has_velocity = false;
    if (is_driven()) {
      next.work = x.work;
      powers_.erase(powers_.begin());
      powers_.push_back(power({next.t, next.q}));
      next.work += work_of_step(first_.steps() - 1);
    }
  }
  return Outcome::reached_end;
}

std::unique_ptr<Stepper> create_symmetric(SystemRun& run) {
  return std::make_unique<FixedSteps<SymmetricMultistep>>(run, *run.method().symmetric_formula);
}

}  // namespace qddot
