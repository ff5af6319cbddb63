#include "qddot/integrators/base/rosenbrock.hpp"

#include <algorithm>
#include <cmath>

namespace qddot {
namespace {

// The polynomial through three ends of steps and the one through two differ by an order of h^6; a
// step's error is of order h^5.
constexpr std::size_t instants = 3;
// The part of a step's allowed error that an iterative solve for a stage may leave. Nothing
// corrects it, later stages multiply it by up to some 30, and it adds up over the steps. The
// formula's own errors are far below the estimate.
constexpr double stage_share = 1e-4;
// The smallest relative residual; below it is rounding.
constexpr double tightest = 1e-15;

// A row of a method's table as a vector of weights.
Eigen::Map<const Vec> as_vec(const std::vector<double>& row) {
  return {row.data(), static_cast<Index>(row.size())};
}

}  // namespace

Rosenbrock::Rosenbrock(SystemRun& run, const RosenbrockTable& table, int error_order)
    : AdaptiveStep(run, {error_order, instants}),
      table_(table),
      u_q_(system().size(), std::ssize(table.a)),
      u_v_(system().size(), std::ssize(table.a)),
      r_(system().size()),
      s_(system().size()),
      x_(system().size()),
      k_(system().stiffness_pattern()),
      matrix_(system(), options().solver) {}

// Let A = M - g^2 K, A U_q = b = M u, and e the error of U_q; U_v = (U_q - r)/g errs by e/g. Then
// |e|_M <= |e|_A <= tau |b|_{A^-1} <= tau |u|_M if A >= M. So tau = share g |w|_M / |u|_M leaves
// the part `share` of the weights w of velocities, by which the step's errors are judged.
// Accelerations of stiff springs cancel in the sum of the stages, but make u large and tau small.
// If the absolute tolerance outweighs the velocities, tau is the same part of rtol alone.
double Rosenbrock::tolerance(const State& now, double g, const Vec& u) const {
  const double atol = options().atol > 0 ? options().atol : options().rtol * options().speed;
  const auto& mass = system().mass().array();
  const double weights = (mass * (options().rtol * now.v.array().abs() + atol).square()).sum();
  const double size = (mass * u.array().square()).sum();
  const double asked = std::min(g * std::sqrt(weights / size), options().rtol);
  return std::max(stage_share * asked, tightest);
}

void Rosenbrock::start(const State& state) {
  AdaptiveStep::start(state);
  has_k_ = false;
}

void Rosenbrock::moved() {
  if (!system().stiffness_is_constant()) has_k_ = false;
}

Outcome Rosenbrock::attempt(const Instant& now, double h, Instant& next, Vec& error_q,
                            Vec& error_v) {
  const double g = table_.gamma * h;
  if (!factorize(now.state.q, g)) return Outcome::indefinite_matrix;
  Vec &q = next.state.q, &v = next.state.v;
  q = now.state.q;
  v = now.state.v;
  for (Index i = 0; i < u_q_.cols(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    if (i > 0) {
      q = now.state.q;
      v = now.state.v;
      q.noalias() += u_q_.leftCols(i) * as_vec(table_.a[row]);
      v.noalias() += u_v_.leftCols(i) * as_vec(table_.a[row]);
      acceleration(q, next.a);
    }
    r_ = g * v;
    s_ = g * (i == 0 ? now.a : next.a);
    r_.noalias() += table_.gamma * (u_q_.leftCols(i) * as_vec(table_.c[row]));
    s_.noalias() += table_.gamma * (u_v_.leftCols(i) * as_vec(table_.c[row]));
    x_ = r_ + g * s_;
    matrix_.set_tolerance(tolerance(now.state, g, x_));
    s_ = system().mass().cwiseProduct(x_);
    const Stopwatch watch(clock(), &Seconds::solve);
    ++counts().solves;
    if (const Outcome outcome = check_solve(matrix_.solve(s_, x_));
        outcome != Outcome::reached_end) {
      return outcome;
    }
    u_q_.col(i) = x_;
    u_v_.col(i) = (x_ - r_) / g;
  }
  error_q = u_q_.rightCols<1>();
  error_v = u_v_.rightCols<1>();
  q += error_q;
  v += error_v;
  return Outcome::reached_end;
}

// Factorises M - g^2 K(q) unless the last factors are of this matrix.
bool Rosenbrock::factorize(const Vec& q, double g) {
  if (has_k_ && g == factorized_g_) return true;
  if (!has_k_) stiffness(q, k_);
  has_k_ = true;
  factorized_g_ = g;
  ++counts().factorizations;
  const Stopwatch watch(clock(), &Seconds::factorization);
  const auto definiteness = matrix_.factorize(1, g * g, k_);
  if (definiteness == EffectiveMass::Definiteness::indefinite) {
    ++counts().indefinite_factorizations;
  }
  if (definiteness == EffectiveMass::Definiteness::singular) factorized_g_ = 0;
  return factorized_g_ > 0;
}

}  // namespace qddot
