// The Runge-Kutta-Chebyshev method of order 2 on y' = F(y), y = (q, v), F = (v, M^-1 f(q, v)). Its
// s stages follow the recurrence of Chebyshev's polynomials T_j:
//   Y_0 = y_n,   Y_1 = Y_0 + m'_1 h F_0,   F_j = F(t_n + c_j h, Y_j)
//   Y_j = (1 - m_j - n_j) Y_0 + m_j Y_{j-1} + n_j Y_{j-2} + m'_j h F_{j-1} + g'_j h F_0
//   y_{n+1} = Y_s
// With w_0 = 1 + e/s^2, e = 2/13, w_1 = T'_s(w_0)/T''_s(w_0), b_j = T''_j(w_0)/T'_j(w_0)^2:
//   m_j = 2 w_0 b_j/b_{j-1},   n_j = -b_j/b_{j-2},   m'_j = 2 w_1 b_j/b_{j-1},   m'_1 = b_1 w_1
//   g'_j = -(1 - b_{j-1} T_{j-1}(w_0)) m'_j,   c_j = w_1 T''_j(w_0)/T'_j(w_0)
// It is for motions that friction dominates. With s forces it is stable on the negative real axis
// up to 2/3 (s^2 - 1)(1 - 2 e/15), so that a step grows as s^2. Damping along springs in proportion
// to their stiffness, c = beta k, puts vibrations on a circle through zero of radius 1/beta. They
// stay bounded for h < 2.0 beta with four stages and h < 2.5 beta with many. The number of stages
// is the least that is stable for the largest eigenvalue of M^-1 C. That is found by the power
// method, anew every few steps. Without friction a vibration grows slowly at every h.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot::registered {
namespace {

constexpr double epsilon = 2. / 13;
// With fewer stages the circle of vibrations is too small; with more, rounding grows as s^2.
constexpr int fewest_stages = 4, most_stages = 250;
// The power method ends when its estimate rises by less than a part of it, or after so many
// products. The estimate comes from below, and is taken larger by a factor.
constexpr double little = 0.01, margin = 1.1;
constexpr int most_products = 50;
// Steps with one estimate.
constexpr int steps_with_one = 25;

// The largest h times an eigenvalue on the negative real axis.
double reach(int stages) { return 2. / 3 * (stages * stages - 1.) * (1 - 2 * epsilon / 15); }

// The coefficients of the stages after the first, and that of the first.
struct Stage {
  double m, n, m_rate, g_rate, c;
};
struct Stages {
  double first = 0, c_first = 0;
  std::vector<Stage> later;
};

Stages stages_of(int s) {
  const double w0 = 1 + epsilon / (s * s);
  std::vector<double> t = {1, w0}, d = {0, 1}, dd = {0, 0}, b(static_cast<std::size_t>(s) + 1);
  for (std::size_t j = 2; j < b.size(); ++j) {
    t.push_back(2 * w0 * t[j - 1] - t[j - 2]);
    d.push_back(2 * t[j - 1] + 2 * w0 * d[j - 1] - d[j - 2]);
    dd.push_back(4 * d[j - 1] + 2 * w0 * dd[j - 1] - dd[j - 2]);
    b[j] = dd[j] / (d[j] * d[j]);
  }
  b[0] = b[1] = b[2];
  const double w1 = d.back() / dd.back();
  Stages all{.first = b[1] * w1, .c_first = b[1] * w1, .later = {}};
  for (std::size_t j = 2; j < b.size(); ++j) {
    const double m_rate = 2 * w1 * b[j] / b[j - 1];
    all.later.push_back({2 * w0 * b[j] / b[j - 1], -b[j] / b[j - 2], m_rate,
                         -(1 - b[j - 1] * t[j - 1]) * m_rate, w1 * dd[j] / d[j]});
  }
  return all;
}

class Rkc final : public Formula {
  // y and its energy that friction has taken, and F there.
  struct Rate {
    Vec v, a;
    Work power;
  };

 public:
  using Formula::Formula;

  void begin(const State& state, State& x) {
    x = state;
    until_estimate_ = 0;
    largest_ = 0;
    for (Vec* all : {&first_.v, &first_.a, &last_.v, &last_.a}) all->resize(state.q.size());
    before_ = now_ = state;
  }

  Outcome step(const State& x, double h, State& next) {
    const int s = stages_for(x, h);
    if (s > most_stages) {
      set_message(
          fmt::format("friction asks for more than {} stages: take a smaller step, or an "
                      "implicit method such as linear_midpoint",
                      most_stages));
      return Outcome::diverged;
    }
    if (s != stages_) coefficients_ = stages_of(stages_ = s);
    evaluate(x, first_);
    before_ = x;
    const double first = coefficients_.first * h;
    add_scaled(x.q, first, first_.v, now_.q);
    add_scaled(x.v, first, first_.a, now_.v);
    now_.work = x.work + first * first_.power;
    now_.t = x.t + coefficients_.c_first * h;
    for (const Stage& stage : coefficients_.later) {
      evaluate(now_, last_);
      const double rest = 1 - stage.m - stage.n;
      next.q = rest * x.q + stage.m * now_.q + stage.n * before_.q +
               h * (stage.m_rate * last_.v + stage.g_rate * first_.v);
      next.v = rest * x.v + stage.m * now_.v + stage.n * before_.v +
               h * (stage.m_rate * last_.a + stage.g_rate * first_.a);
      next.work = rest * x.work + stage.m * now_.work + stage.n * before_.work +
                  h * (stage.m_rate * last_.power + stage.g_rate * first_.power);
      std::swap(before_, now_);
      std::swap(now_, next);
      now_.t = x.t + stage.c * h;
    }
    std::swap(now_, next);
    return Outcome::reached_end;
  }

 private:
  void evaluate(const State& y, Rate& rate) {
    force(y, f_);
    rate.v = y.v;
    divide(f_, system().mass(), rate.a);
    rate.power = power();
  }

  // The least number of stages that is stable for the largest eigenvalue of M^-1 C.
  int stages_for(const State& x, double h) {
    if (is_damped() && until_estimate_-- <= 0) {
      estimate(x);
      until_estimate_ = steps_with_one;
    }
    int s = fewest_stages;
    while (s <= most_stages && reach(s) < h * margin * largest_) ++s;
    return s;
  }

  // The power method from the last vector, or from one of mixed signs.
  void estimate(const State& x) {
    if (largest_ == 0) {
      vector_.resize(x.q.size());
      for (Index i = 0; i < vector_.size(); ++i)
        vector_[i] = std::cos(1.7 * static_cast<double>(i));
    }
    double last = 0;
    for (int products = 0; products < most_products; ++products) {
      vector_ /= vector_.norm();
      power({x.t, x.q, vector_});
      ++counts().force_evaluations;
      divide(friction(), system().mass(), vector_);
      largest_ = vector_.norm();
      if (!(largest_ > (1 + little) * last)) break;
      last = largest_;
    }
    if (!(largest_ > 0)) largest_ = 0;
  }

  int stages_ = 0, until_estimate_ = 0;
  double largest_ = 0;  // of M^-1 C [1/s]
  Stages coefficients_;
  State before_, now_;  // Y_{j-2}, Y_{j-1}
  Rate first_, last_;   // F_0, F_{j-1}
  Vec f_{system().size()}, vector_;
};

}  // namespace

Method rkc() {
  return {.name = "rkc",
          .summary = "Runge-Kutta-Chebyshev, stages by the friction; for motions that it dominates",
          .source =
              "Sommeijer, Shampine and Verwer, J. Computational and Applied Mathematics 88 (1997) "
              "315-326",
          .order = 2,
          .stability_limit = 0,
          .make = create<Rkc>};
}

}  // namespace qddot::registered
