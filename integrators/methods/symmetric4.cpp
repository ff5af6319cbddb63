// The symmetric multistep formula of four steps and order 4. With a = M^-1 f(q) it is
//   q_{n+4} - 5/2 q_{n+3} + 3 q_{n+2} - 5/2 q_{n+1} + q_n
//     = h^2/8 (9 a_{n+3} - 6 a_{n+2} + 9 a_{n+1})
// It takes one force a step. The first three steps are computed together, by more forces. The
// polynomial of the left side is (z - 1)^2 r(z) with
//   r(z) = z^2 - z/2 + 1
// The roots of r are spurious: they belong to the formula, not to the motion. They lie on the unit
// circle, at an angle of cosine 1/4. So no vibration grows or dies up to a limit of h w. The limit
// grows with the cosine, and so does the phase error. It is 1.73 at the cosine 0 (the formula of
// Lambert and Watson) and 1.83 here. Larger cosines bring the roots near those of the motion.
//
// Friction needs the velocity. Of the formulas that keep the order, this one has no growing root
// for small friction:
//   h v_n = q_n - q_{n-1} + h^2 (9/8 a_{n-1} - 11/12 a_{n-2} + 7/24 a_{n-3})
// The first steps are then those of the classical Runge-Kutta method, four for each, and the energy
// W that friction takes, W' = p = v'Cv, is that of Adams and Moulton:
//   W_{n+1} = W_n + h/24 (9 p_{n+1} + 19 p_n - 5 p_{n-1} + p_{n-2})
#include <algorithm>
#include <array>

#include "integrators/methods/tables.hpp"
#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/vector_updates.hpp"

namespace qddot::registered {

const SymmetricFormula& symmetric4_formula() {
  static const SymmetricFormula formula{.steps = 4,
                                        .rho_denominator = 2,
                                        .rho = {2, -5, 6},
                                        .beta_denominator = 8,
                                        .beta = {9, -6},
                                        .single_step = dprkn6_pair};
  return formula;
}

namespace {

class Damped4 final : public Formula {
  struct Point {
    Vec a;
    Work power;
  };

 public:
  struct X : State {
    Index begun = 0;  // steps since the start, 3 at most
    Vec d, d1, d2;    // q_n - q_{n-1} and those before it, of so many steps
    Point now, ago1, ago2;
  };

  using Formula::Formula;

  void begin(const State& state, X& x) {
    static_cast<State&>(x) = state;
    x.begun = 0;
    for (Vec* all : {&x.d, &x.d1, &x.d2, &x.now.a, &x.ago1.a, &x.ago2.a}) {
      all->resize(state.q.size());
    }
    evaluate(x, x.now);
  }

  Outcome step(const X& x, double h, X& next) {
    const bool begins = x.begun < 3 || h != options().step_size;
    if (begins) {
      first_step(x, h, next);
    } else {
      next.d = 1.5 * (x.d - x.d1) + x.d2 + h * h / 8 * (9 * x.now.a - 6 * x.ago1.a + 9 * x.ago2.a);
      next.q = x.q + next.d;
      next.v = next.d / h + h * (9. / 8 * x.now.a - 11. / 12 * x.ago1.a + 7. / 24 * x.ago2.a);
      evaluate(next, next.now);
      next.work =
          x.work +
          h / 24 * (9 * next.now.power + 19 * x.now.power - 5 * x.ago1.power + x.ago2.power);
    }
    next.begun = h == options().step_size ? std::min<Index>(x.begun + 1, 3) : 0;
    next.d1 = x.d;
    next.d2 = x.d1;
    next.ago1 = x.now;
    next.ago2 = x.ago1;
    return Outcome::reached_end;
  }

  void show(const X& x, bool, State& state) {
    state.q = x.q;
    state.v = x.v;
  }

 private:
  void evaluate(const X& x, Point& point) {
    force({x.t, x.q, x.v}, f_);
    divide(f_, system().mass(), point.a);
    point.power = power();
  }

  void first_step(const X& x, double h, X& next) {
    constexpr int parts = 4;
    const double part = h / parts;
    State at = x;
    for (int i = 0; i < parts; ++i) {
      runge_kutta_step(at, part);
      at.t = x.t + (i + 1) * part;
    }
    next.q = at.q;
    next.v = at.v;
    next.work = at.work;
    next.d = next.q - x.q;
    evaluate(next, next.now);
  }

  // A step of the classical Runge-Kutta method.
  void runge_kutta_step(State& at, double h) {
    const Mass& mass = system().mass();
    const State from = at;
    State stage = from;
    constexpr std::array<double, 4> weights = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
    constexpr std::array<double, 4> ahead = {0, 0.5, 0.5, 1};
    for (std::size_t i = 0; i < 4; ++i) {
      if (i > 0) {
        const Vec v = stage.v;
        add_quotient(from.v, ahead[i] * h, f_, mass, stage.v);
        add_scaled(from.q, ahead[i] * h, v, stage.q);
        stage.t = from.t + ahead[i] * h;
      }
      force(stage, f_);
      at.q += weights[i] * h * stage.v;
      add_quotient(at.v, weights[i] * h, f_, mass, at.v);
      at.work += weights[i] * h * power();
    }
  }

  Vec f_{system().size()};
};

// The roots of these recurrences on q'' = -w^2 q - 2 zeta w q', in units of a step: the eigenvalues
// of the matrix that leads from q_n ... q_{n-3}, a_n, a_{n-1}, a_{n-2} to the next.
std::vector<std::complex<double>> damped_roots(double h_omega, double zeta) {
  if (zeta == 0) return symmetric_roots<symmetric4_formula>(h_omega, 0);
  using Row = Eigen::Matrix<double, 1, 7>;
  Row next_q, next_v, next_a;
  next_q << 5. / 2, -3, 5. / 2, -1, 9. / 8, -6. / 8, 9. / 8;
  next_v = next_q;
  next_v += Row{{-1, 0, 0, 0, 9. / 8, -11. / 12, 7. / 24}};
  next_a = -h_omega * h_omega * next_q - 2 * zeta * h_omega * next_v;
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(7, 7);
  step.row(0) = next_q;
  step.row(4) = next_a;
  for (const int i : {1, 2, 3, 5, 6}) step(i, i - 1) = 1;
  const Eigen::VectorXcd values = general_values(step);
  std::vector<std::complex<double>> all(values.begin(), values.end());
  std::ranges::sort(all, std::ranges::greater(), [](const auto& root) { return std::abs(root); });
  return all;
}

std::unique_ptr<Stepper> create_symmetric4(SystemRun& run) {
  if (run.system().damping()) return create<Damped4>(run);
  return create_symmetric(run);
}

}  // namespace

Method symmetric4() {
  return {
      .name = "symmetric4",
      .summary =
          "symmetric multistep of order 4, one force a step; as cheap as Verlet, at h < 1.8/w_max",
      .source =
          "derived in the file, after Quinlan and Tremaine, Astronomical Journal 100 (1990) "
          "1694-1700",
      .order = 4,
      .stability_limit = 1.8257418583505537,
      .recurrence_roots = damped_roots,
      .traits = {Trait::remembers_steps},
      .needs = {Need::conservative},
      .symmetric_formula = &symmetric4_formula(),
      .damped = Damped::by_any,
      .make = create_symmetric4};
}

}  // namespace qddot::registered
