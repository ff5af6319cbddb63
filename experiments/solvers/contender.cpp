#include "experiments/solvers/contender.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/measure/motion/timing.hpp"

namespace qddot::solvers {
namespace {

// The number of calls that take about a millisecond.
template <class Call>
int calls_in_a_sample(const Call& call) {
  return std::clamp(static_cast<int>(1e-3 / seconds_of(call)), 1, 1000);
}

template <class Call>
double time_of(int calls, const Call& call) {
  call();  // reloads the caches after the other solvers
  const double all = seconds_of([&] {
    for (int i = 0; i < calls; ++i) call();
  });
  return all / calls;
}

double known(double x) { return x > 0 ? x : SolverRow::nothing; }

}  // namespace

Contender::Contender(const DirectSolverKind& kind, const System& system, double s,
                     const SymmetricMatrix& k)
    : name_(kind.name), s_(s), k_(k), b_(Vec::LinSpaced(system.size(), -1, 2)), x_(b_) {
  analysis_ = seconds_of([&] { solver_ = kind.make(system); });
  has_solved_ = solver_->factorize(s, k);
  if (!has_solved_) return;
  solve();
  const SymmetricMatrix whole = k.selfadjointView<Eigen::Lower>();
  const Vec product = system.mass().cwiseProduct(x_) - s * (whole * x_);
  residual_ = (product - b_).cwiseAbs().maxCoeff();
  factorizations_ = calls_in_a_sample([&] { factorize(); });
  solves_ = calls_in_a_sample([&] { solve(); });
}

std::vector<double> Contender::sample() {
  if (!has_solved_) return {};
  return {time_of(factorizations_, [&] { factorize(); }), time_of(solves_, [&] { solve(); })};
}

void Contender::take(const std::vector<double>& sample) {
  if (sample.empty()) return;
  factorization_ = std::fmin(factorization_, sample[0]);
  solve_ = std::fmin(solve_, sample[1]);
}

SolverRow Contender::row(const std::string& scene) const {
  return {.scene = scene,
          .unknowns = b_.size(),
          .solver = name_,
          .analysis = analysis_,
          .factorization = factorization_,
          .solve = solve_,
          .gflops = known(1e-9 * solver_->flops / factorization_),
          .gigabytes_per_second = known(2e-9 * bytes() / solve_),
          .bytes = known(bytes()),
          .residual = residual_};
}

}  // namespace qddot::solvers
