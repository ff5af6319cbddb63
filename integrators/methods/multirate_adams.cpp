// Adams' methods with the stiff springs taken apart: with a = M^-1 f_soft,
//   q'' = M^-1 f_stiff(q) + p(t)
// over a step, p the polynomial through a at the last k points of time. Where no stiff spring ends,
// that is p integrated twice, exactly; the nodes of stiff springs take many short steps of it (see
// StiffFlow). At its end the soft force is evaluated, once a step, and the velocity gets what the
// polynomial through that as well would have given it:
//   v += h w (a_{n+1} - p(t_{n+1})),   w = int_0^1 prod_j (x - x_j)/(1 - x_j) dx,  x_j = (t_j - t_n)/h.
// Order k + 1; velocity Verlet for k = 1 without stiff springs. What is left out of the step is
// smooth and small, so that stiff springs are not set swinging as by the impulses of a splitting.
//
// The first step is divided in k - 1, whose accelerations are found together: each iteration moves
// along the polynomial through the last ones, from a constant on, and gains two orders.
#include <array>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "qddot/integrators/base/fixed_step.hpp"
#include "qddot/integrators/base/renewed_bound.hpp"
#include "qddot/integrators/base/stiff_flow.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

// More of them are taken for none that could be waited for.
constexpr double most_stiff_steps = 1e7;

template <int k>
class MultirateAdams final : public FixedStep {
  using Coefficients = Eigen::Matrix<double, k, 1>;

 public:
  MultirateAdams(const Method& method, const System& system, const Options& options)
      : FixedStep(method, system, options),
        split_(*split_of(system)),
        block_(*split_.stiff_block),
        flow_(block_.mass()),
        bound_(block_),
        soft_(Eigen::MatrixXd::Zero(system.size(), k + 1)),
        push_(block_.size(), k),
        f_(system.size()),
        x_(block_.size()),
        u_(block_.size()) {}

 private:
  void start(const State& state) override {
    bound_.start();
    newest_ = 0;
    known_ = 1;
    evaluate(state.q, state.t, newest_);
  }

  void resume(const FixedStep& run, const State& now) override {
    const auto& other = static_cast<const MultirateAdams&>(run);
    bound_.start();
    soft_ = other.soft_;
    at_ = other.at_;
    newest_ = other.newest_;
    known_ = other.known_;
    if (known_ < k) start(now);
  }

  Outcome step(const State& now, double h, State& next) override {
    if (known_ < k) {
      if (const Outcome outcome = find_first(now, h, next); outcome != Outcome::reached_end) {
        return outcome;
      }
      return Outcome::reached_end;
    }
    if (const Outcome outcome = predict(now, h, next); outcome != Outcome::reached_end) {
      return outcome;
    }
    const Index oldest = column(-k);
    evaluate(next.q, now.t + h, oldest);
    correct(now.t, h, next);
    newest_ = oldest;
    return Outcome::reached_end;
  }

  // All of the first step.
  Outcome find_first(const State& now, double h, State& next) {
    known_ = k;
    for (int j = 1; j < k; ++j) {
      soft_.col(column(j)) = soft_.col(newest_);
      at_[static_cast<std::size_t>(column(j))] = now.t + j * h / (k - 1);
    }
    newest_ = column(k - 1);
    State from = now;
    for (int i = 0; i <= (k + 1) / 2; ++i) {
      from = now;
      for (int j = 1; j < k; ++j) {
        const double part = h / (k - 1);
        from.t = now.t + (j - 1) * part;
        if (const Outcome outcome = predict(from, part, next); outcome != Outcome::reached_end) {
          return outcome;
        }
        evaluate(next.q, now.t + j * part, column(j - (k - 1)));
        from.q = next.q;
        from.v = next.v;
      }
    }
    return Outcome::reached_end;
  }

  // The accelerations' column of that many points after the newest.
  Index column(int after) const { return (newest_ + after + 2 * (k + 1)) % (k + 1); }

  void evaluate(const Vec& q, double t, Index column) {
    force(*split_.soft, q, f_);
    divide(f_, system().mass(), soft_.col(column));
    at_[static_cast<std::size_t>(column)] = t;
  }

  // x_j of the last k points, from the newest on, for a step h from t on.
  Coefficients points(double t, double h) const {
    Coefficients x;
    for (int j = 0; j < k; ++j) x[j] = (at_[static_cast<std::size_t>(column(-j))] - t) / h;
    return x;
  }

  // Column j: the polynomial in x that is 1 at x_j and 0 at the other points, by its coefficients.
  static Eigen::Matrix<double, k, k> basis(const Coefficients& x) {
    Eigen::Matrix<double, k, k> powers;
    powers.col(0).setOnes();
    for (int j = 1; j < k; ++j) powers.col(j) = powers.col(j - 1).cwiseProduct(x);
    return powers.inverse();
  }

  // In the order of the columns of soft_, from those of the points.
  std::array<double, k + 1> by_column(const Coefficients& c) const {
    std::array<double, k + 1> all{};
    for (int j = 0; j < k; ++j) all[static_cast<std::size_t>(column(-j))] = c[j];
    return all;
  }

  // `next` a step h after `now`, along the polynomial.
  Outcome predict(const State& now, double h, State& next) {
    const auto polynomials = basis(points(now.t, h));
    Coefficients once, twice;
    for (int j = 0; j < k; ++j) {
      once[j] = twice[j] = 0;
      for (int i = 0; i < k; ++i) {
        once[j] += polynomials(i, j) / (i + 1);
        twice[j] += polynomials(i, j) / ((i + 1) * (i + 2));
      }
    }
    add_combination(now.q, h, now.v, h * h, soft_, by_column(twice), next.q);
    add_combination(now.v, h, soft_, by_column(once), next.v);
    if (block_.size() == 0) return Outcome::reached_end;

    const double w_max = bound_.at(counts().steps, [&](SymmetricMatrix& stiffness_matrix) {
      gather(now);
      stiffness(block_, x_, stiffness_matrix);
    });
    const double steps = std::max(1.0, std::ceil(h * w_max / Flow::step_times_frequency));
    if (!std::isfinite(steps)) return Outcome::not_finite;
    if (steps > most_stiff_steps) return Outcome::step_too_small;
    gather(now);
    const std::vector<Index>& stiff = split_.stiff_unknowns;
    for (int i = 0; i < k; ++i) {
      double* out = push_.col(i).data();
      for (std::size_t a = 0; a < stiff.size(); ++a) out[a] = 0;
      for (int j = 0; j < k; ++j) {
        const double c = polynomials(i, j);
        const double* in = soft_.col(column(-j)).data();
        for (std::size_t a = 0; a < stiff.size(); ++a) out[a] += c * in[stiff[a]];
      }
    }
    flow_.advance(
        h, steps, push_, [&](const Vec& x, Vec& f) { force(block_, x, f); }, x_, u_);
    for (std::size_t a = 0; a < stiff.size(); ++a) {
      next.q[stiff[a]] = x_[static_cast<Index>(a)];
      next.v[stiff[a]] = u_[static_cast<Index>(a)];
    }
    return Outcome::reached_end;
  }

  void gather(const State& now) {
    const std::vector<Index>& stiff = split_.stiff_unknowns;
    for (std::size_t a = 0; a < stiff.size(); ++a) {
      x_[static_cast<Index>(a)] = now.q[stiff[a]];
      u_[static_cast<Index>(a)] = now.v[stiff[a]];
    }
  }

  // v += h w (a_{n+1} - p), with a_{n+1} where the oldest was before.
  void correct(double t, double h, State& next) {
    const Coefficients x = points(t, h);
    Eigen::Matrix<double, k + 1, 1> product;
    product.setZero();
    product[0] = 1;
    double at_end = 1;
    for (int j = 0; j < k; ++j) {
      for (int i = j + 1; i > 0; --i) product[i] = product[i - 1] - x[j] * product[i];
      product[0] *= -x[j];
      at_end *= 1 - x[j];
    }
    double w = 0;
    for (int i = 0; i <= k; ++i) w += product[i] / ((i + 1) * at_end);
    const auto polynomials = basis(x);
    Coefficients extrapolation;
    for (int j = 0; j < k; ++j) extrapolation[j] = -polynomials.col(j).sum();
    auto all = by_column(extrapolation);
    all[static_cast<std::size_t>(column(-k))] = 1;
    add_combination(next.v, h * w, soft_, all, next.v);
  }

  using Flow = StiffFlow<k == 1 ? 2 : 4>;

  const Split& split_;
  const System& block_;
  Flow flow_;
  RenewedBound bound_;
  Eigen::MatrixXd soft_;               // accelerations, one column for each point of time
  std::array<double, k + 1> at_{};     // [s], of the columns
  Index newest_ = 0;                   // column
  int known_ = 0;                      // columns
  Eigen::MatrixXd push_;               // the polynomial over the stiff unknowns
  Vec f_, x_, u_;
};

template <int k>
Method multirate() {
  return {.name = fmt::format("multirate_adams{}", k + 1),
          .summary = fmt::format("Adams' explicit order {} for soft forces, one a step; stiff "
                                 "springs alone in short steps of order {}",
                                 k + 1, k == 1 ? 2 : 4),
          .source =
              "Demirel, Niegemann, Busch and Hochbruck, J. Computational Physics 285 (2015) "
              "133-148",
          .order = k + 1,
          .needs = {Need::stiffness, Need::split_forces},
          .make = create<MultirateAdams<k>>};
}

}  // namespace

Method multirate_adams2() { return multirate<1>(); }
Method multirate_adams3() { return multirate<2>(); }
Method multirate_adams4() { return multirate<3>(); }
Method multirate_adams5() { return multirate<4>(); }
Method multirate_adams6() { return multirate<5>(); }

}  // namespace qddot::registered
