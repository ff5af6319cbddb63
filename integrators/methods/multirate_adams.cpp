// Adams' methods that take the stiff springs apart. Let p(t) be the polynomial through the soft
// accelerations a = M^-1 f_soft at the last k points of time. A step follows
//   q'' = M^-1 f_stiff(q) + p(t)
// Nodes on no stiff spring move by p integrated twice, exactly. Nodes of stiff springs take many
// short steps (see StiffFlow). Then the soft force is evaluated, once a step. It changes the
// velocity by what the polynomial through this point as well would have given:
//   v_{n+1} <- v_{n+1} + h c (a_{n+1} - p(t_{n+1}))
//   c = int_0^1 prod_j (x - x_j)/(1 - x_j) dx,   x_j = (t_j - t_n)/h of the k points
// The order is k + 1: k is 1, 3 and 4 for multirate_adams2, 4 and 5. Without stiff springs k = 1 is
// velocity Verlet. (The code calls c by the name w.) Demirel, Niegemann, Busch and Hochbruck have
// such steps without the change of the velocity.
//
// That change is small, of order h^(k+1). The kicks of a splitting are of order h and set stiff
// springs swinging. But soft forces answer vibrations of stiff springs one step late. A vibration
// that turns by about an odd multiple of pi in a step therefore grows slowly. So these methods are
// for motions that are to be known accurately, not for long runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/base/renewed_bound.hpp"
#include "qddot/integrators/base/stiff_flow.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// The most short steps in a step, far more than any run has time for.
constexpr double most_short_steps = 1e6;

template <int k>
class MultirateAdams final : public Formula {
  using Row = Eigen::Matrix<double, k, 1>;  // one number for each of the k points, the newest first

  static constexpr int stiff_order = k <= 3 ? 2 : 4;
  using Flow = StiffFlow<stiff_order>;

 public:
  explicit MultirateAdams(SystemRun& run)
      : Formula(run),
        split_(*system().split()),
        block_(*split_.stiff_block),
        flow_(block_.mass(), k),
        stiff_bound_(block_),
        a_(Eigen::MatrixXd::Zero(system().size(), k + 1)),
        f_(system().size()),
        x_(block_.size()),
        u_(block_.size()),
        from_{0, Vec(system().size()), Vec(system().size())} {}

  void begin(const State& state, State& x) {
    x = state;
    stiff_bound_.start();
    newest_ = 0;
    is_known_ = k == 1;
    evaluate(state.q, 0, newest_);
  }

  void resume(const MultirateAdams& run, const State& x, State& own) {
    if (!run.is_known_) return begin(x, own);
    own = x;
    stiff_bound_.start();
    a_ = run.a_;
    at_ = run.at_;
    newest_ = run.newest_;
    is_known_ = true;
  }

  Outcome step(const State& now, double h, State& next) {
    const Outcome outcome = is_known_ ? step_from_known(now, h, next) : first_step(now, h, next);
    for (double& t : at_) t -= h;
    return outcome;
  }

 private:
  Outcome step_from_known(const State& now, double h, State& next) {
    if (const Outcome outcome = follow(now, 0, h, next); outcome != Outcome::reached_end) {
      return outcome;
    }
    const Index oldest = column(-k);
    evaluate(next.q, h, oldest);
    correct(h, oldest, next);
    newest_ = oldest;
    return Outcome::reached_end;
  }

  // The first step is divided into k - 1 steps, whose forces are found together. Each iteration
  // integrates the polynomial through the last forces, from a constant on, and gains two orders.
  Outcome first_step(const State& now, double h, State& next) {
    const double part = h / (k - 1);
    for (int j = 1; j < k; ++j) {
      a_.col(column(j)) = a_.col(newest_);
      time(column(j)) = j * part;
    }
    newest_ = column(k - 1);
    is_known_ = true;
    for (int iteration = 0; iteration <= k / 2; ++iteration) {
      from_.q = now.q;
      from_.v = now.v;
      for (int j = 1; j < k; ++j) {
        const Outcome outcome = follow(from_, (j - 1) * part, part, next);
        if (outcome != Outcome::reached_end) return outcome;
        evaluate(next.q, j * part, column(j - (k - 1)));
        from_.q = next.q;
        from_.v = next.v;
      }
    }
    return Outcome::reached_end;
  }

  // The column of a_ of the point that is `after` points after the newest.
  Index column(int after) const { return (newest_ + after + 2 * (k + 1)) % (k + 1); }
  double& time(Index column) { return at_[static_cast<std::size_t>(column)]; }

  // Computes a at q, t [s] after the step's start.
  void evaluate(const Vec& q, double t, Index column) {
    force(*split_.soft, q, f_);
    divide(f_, system().mass(), a_.col(column));
    time(column) = t;
  }

  // x_j of the k points for a step h from t on.
  Row points(double t, double h) {
    Row x;
    for (int j = 0; j < k; ++j) x[j] = (time(column(-j)) - t) / h;
    return x;
  }

  // Row i, column j: the coefficient of x^i in the polynomial that is 1 at x_j and 0 at the other
  // points.
  static Eigen::Matrix<double, k, k> basis(const Row& x) {
    Eigen::Matrix<double, k, k> powers;
    powers.col(0).setOnes();
    for (int i = 1; i < k; ++i) powers.col(i) = powers.col(i - 1).cwiseProduct(x);
    return powers.inverse();
  }

  // The weights in the order of the columns of a_; 0 for the column without a point.
  std::array<double, k + 1> by_column(const Row& weights) const {
    std::array<double, k + 1> all{};
    for (int j = 0; j < k; ++j) all[static_cast<std::size_t>(column(-j))] = weights[j];
    return all;
  }

  // Advances the state by h from `now`, which is t after the step's start, with soft accelerations
  // p.
  Outcome follow(const State& now, double t, double h, State& next) {
    const Eigen::Matrix<double, k, k> polynomials = basis(points(t, h));
    Row once = Row::Zero(), twice = Row::Zero();
    for (int i = 0; i < k; ++i) {
      once += polynomials.row(i).transpose() / (i + 1);
      twice += polynomials.row(i).transpose() / ((i + 1) * (i + 2));
    }
    add_combination(now.q, h, now.v, h * h, a_, by_column(twice), next.q);
    add_combination(now.v, h, a_, by_column(once), next.v);
    return block_.size() > 0 ? follow_stiff(now, polynomials, h, next) : Outcome::reached_end;
  }

  // Advances the nodes of stiff springs.
  Outcome follow_stiff(const State& now, const Eigen::Matrix<double, k, k>& polynomials, double h,
                       State& next) {
    const std::vector<Index>& stiff = split_.stiff_unknowns;
    for (Index i = 0; i < x_.size(); ++i) {
      x_[i] = now.q[stiff[static_cast<std::size_t>(i)]];
      u_[i] = now.v[stiff[static_cast<std::size_t>(i)]];
    }
    const double w_max = stiff_bound_.at(
        counts().steps, [&](SymmetricMatrix& matrix) { stiffness(block_, x_, matrix); });
    const double steps = w_max > 0 ? short_steps(h * w_max) : 1;
    if (!std::isfinite(steps)) return Outcome::not_finite;
    if (steps > most_short_steps) return Outcome::step_too_small;

    for (int i = 0; i < k; ++i) {
      auto c = flow_.coefficient(i);
      c.setZero();
      for (int j = 0; j < k; ++j) {
        const auto a = a_.col(column(-j));
        for (Index e = 0; e < c.size(); ++e) {
          c[e] += polynomials(i, j) * a[stiff[static_cast<std::size_t>(e)]];
        }
      }
      c.array() *= block_.mass().array();
    }
    flow_.advance(
        h, steps, [&](const Vec& x, MutableVec f) { force(block_, x, f); }, x_, u_);
    for (Index i = 0; i < x_.size(); ++i) {
      next.q[stiff[static_cast<std::size_t>(i)]] = x_[i];
      next.v[stiff[static_cast<std::size_t>(i)]] = u_[i];
    }
    return Outcome::reached_end;
  }

  // The number of short steps in a step, x being the step times w_max of the stiff forces. It is
  // the least stable number. If that is one, it is the number that makes their error fall as that
  // of the step, until both are rounding.
  static double short_steps(double x) {
    constexpr double most = Flow::largest_step_times_frequency, most_for_order = 1000;
    const double for_order = std::pow(1 / x, (k + 1.0) / stiff_order - 1);
    return std::ceil(std::max(x / most, std::min(for_order, most_for_order)));
  }

  // v += h w (a_{n+1} - p), a_{n+1} in the column `end`.
  void correct(double h, Index end, State& next) {
    const Row x = points(0, h);
    // prod_j (x - x_j)/(1 - x_j) by its coefficients
    Eigen::Matrix<double, k + 1, 1> product = Eigen::Matrix<double, k + 1, 1>::Unit(0);
    for (int j = 0; j < k; ++j) {
      for (int i = j + 1; i > 0; --i) product[i] = product[i - 1] - x[j] * product[i];
      product[0] *= -x[j];
      product /= 1 - x[j];
    }
    double w = 0;
    for (int i = 0; i <= k; ++i) w += product[i] / (i + 1);
    auto weights = by_column(-basis(x).colwise().sum().transpose());
    weights[static_cast<std::size_t>(end)] = 1;
    add_combination(next.v, h * w, a_, weights, next.v);
  }

  const Split& split_;
  const System& block_;
  Flow flow_;
  RenewedBound stiff_bound_;
  Eigen::MatrixXd a_;               // a column for each point, and one for the next
  std::array<double, k + 1> at_{};  // [s], times of the columns relative to the run's present time
  Index newest_ = 0;                // column of the newest point
  bool is_known_ = false;           // whether a is known at k points
  Vec f_, x_, u_;                   // x_, u_: of the stiff block
  State from_;
};

template <int k>
Method multirate_adams() {
  return {.name = fmt::format("multirate_adams{}", k + 1),
          .summary = fmt::format("Adams' method of order {} with one soft force a step; stiff "
                                 "springs alone take short steps inside",
                                 k + 1),
          .source =
              "Demirel, Niegemann, Busch and Hochbruck, J. Computational Physics 285 (2015) "
              "133-148",
          .order = k + 1,
          .traits = SetOf<Trait>{}.with(Trait::remembers_steps, k > 1),
          .needs = {Need::conservative, Need::autonomous, Need::stiffness, Need::split_forces},
          .why_not_damped = "its polynomials are for forces of positions",
          .make = create<MultirateAdams<k>>};
}

}  // namespace

Method multirate_adams2() { return multirate_adams<1>(); }
Method multirate_adams4() { return multirate_adams<3>(); }
Method multirate_adams5() { return multirate_adams<4>(); }

}  // namespace qddot::registered
