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

// A list of rows as a lower triangular matrix.
Eigen::MatrixXd matrix_of(const std::vector<std::vector<double>>& rows) {
  const auto stages = std::ssize(rows);
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(stages, stages);
  for (Index i = 0; i < stages; ++i) {
    for (std::size_t j = 0; j < rows[i].size(); ++j) m(i, static_cast<Index>(j)) = rows[i][j];
  }
  return m;
}

// A row of a method's table as a vector of weights.
Eigen::Map<const Vec> as_vec(const std::vector<double>& row) {
  return {row.data(), static_cast<Index>(row.size())};
}

}  // namespace

Rosenbrock::Rosenbrock(SystemRun& run, const RosenbrockTable& table, int error_order)
    : AdaptiveStep(run, {error_order, instants}),
      table_(table),
      alpha_(Vec::Zero(std::ssize(table.a))),
      gammas_(alpha_),
      u_q_(system().size(), std::ssize(table.a)),
      u_v_(system().size(), std::ssize(table.a)),
      r_(system().size()),
      s_(system().size()),
      x_(system().size()),
      k_(system().stiffness_pattern()),
      matrix_(system(), options().solver),
      a_rate_(Vec::Zero(system().size())) {
  // U = h Gamma k, C = 1/gamma - Gamma^-1 and A = (alpha_ij) Gamma^-1 (eq. IV.7.24).
  const Eigen::MatrixXd c = matrix_of(table.c), a = matrix_of(table.a);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(c.rows(), c.cols());
  const Eigen::MatrixXd gamma = (identity / table.gamma - c).inverse();
  gammas_ = gamma.rowwise().sum();
  alpha_ = (a * gamma).rowwise().sum();
}

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
  const double t = now.state.t;
  if (!factorize({t, now.state.q}, g)) return Outcome::indefinite_matrix;
  if (const Driving* driving = system().driving()) {
    driving->force_rate({t, now.state.q}, s_);
    divide(s_, system().mass(), a_rate_);
  }
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
      acceleration({t + alpha_[i] * h, q}, next.a);
    }
    r_ = g * v;
    s_ = g * (i == 0 ? now.a : next.a);
    r_.noalias() += table_.gamma * (u_q_.leftCols(i) * as_vec(table_.c[row]));
    s_.noalias() += table_.gamma * (u_v_.leftCols(i) * as_vec(table_.c[row]));
    if (is_driven()) s_ += g * gammas_[i] * h * a_rate_;
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
  next.state.work = now.state.work;
  if (is_driven()) {
    // Simpson's rule, with the middle of the cubic through both ends.
    x_ = (now.state.q + q) / 2 + h / 8 * (now.state.v - v);
    next.state.work +=
        h / 6 * (power({t, now.state.q}) + 4 * power({t + h / 2, x_}) + power({t + h, q}));
  }
  return Outcome::reached_end;
}

// Factorises M - g^2 K unless the last factors are of this matrix.
bool Rosenbrock::factorize(const At& at, double g) {
  if (has_k_ && g == factorized_g_) return true;
  if (!has_k_) stiffness(at, k_);
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
