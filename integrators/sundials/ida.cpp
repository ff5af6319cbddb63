// SUNDIALS IDA: BDF of variable order k (1 to 5) and variable step, in fixed-leading-coefficient
// form, on the residual
//   F(y, y') = (q' - v, M v' - f(q)) = 0,   y = (q, v)
//   h y'_n = sum_{i=0}^k alpha_i y_{n-i}
// Newton's matrix is dF/dy + c dF/dy' = [[c I, -I], [-K, c M]] with c = alpha_0/h. The method ida
// eliminates v and solves with a symmetric n x n matrix, ida_klu the stock way with KLU. All
// other settings are IDA's defaults.
//
// M may be singular. The position of a massless node is then constrained by 0 = f (index 1). The
// error test sees it like all other positions. If it moves fast, longer steps would throw
// Newton's iteration onto another balance, a saddle of its energy.
//
// The velocity v = q' of a massless node is of index 2 (Brenan, Campbell, Petzold, Numerical
// Solution of IVPs in DAEs, section 5.2). Nothing depends on it, so IDA gets 0 = -v for it. Its
// observed velocity is q'. At the ends of a run it is the velocity in which f stays zero,
// 0 = (K v)_massless. The start is made consistent to rounding: massless nodes go downhill to where
// their springs balance, while the others are held.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include <fmt/format.h>

#include "integrators/sundials/ida_stepper.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/equilibrium.hpp"
#include "qddot/analysis/stability.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/constrained_system.hpp"
#include "qddot/model/frozen_in_time.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

// The largest motion of massless nodes, in units of the motion that errors of the tolerance cause.
constexpr double most_moved_by_errors = 2;
// A massless node that is this many times as fast as nodes with mass is hardly held by its springs.
constexpr double most_times_as_fast = 1e8;

template <MakeMatrix make_matrix>
class Ida final : public IdaStepper {
 public:
  explicit Ida(SystemRun& run) : IdaStepper(run, make_matrix) {
    keep({residual, jacobian, matrix().solver(), matrix().matrix()});
    if (!system().has_massless()) return;
    std::vector<bool> has_mass;
    for (const double mass : system().mass()) has_mass.push_back(mass > 0);
    const System* whole = &system();
    if (!whole->is_autonomous()) whole = &frozen_.emplace(system(), 0);
    massless_.emplace(std::shared_ptr<const System>(std::shared_ptr<void>(), whole), has_mass);
    tolerated_ = clone(atol());
    check(IDAWFtolerances(ida(), weights), "IDAWFtolerances");
  }

 private:
  void start(const State& state) override {
    load(state);
    forget();
    is_lost_ = is_rough_ = false;
    is_consistent_ = !system().has_massless();
    set_rate_of_masses(state.t);
    has_finite_rate_ = Halves(rate()).v.allFinite();
    start_ida(state.t);
  }

  // Sets y' = (v, M^-1 f) of unknowns with mass.
  void set_rate_of_masses(double t) {
    const Halves at(y());
    Halves change(rate());
    change.q = at.v;
    change.v = force_at(system(), t, at);
    for (Index i = 0; i < system().size(); ++i) {
      change.v[i] = system().mass()[i] > 0 ? change.v[i] / system().mass()[i] : 0;
    }
    if (has_work(y())) work(rate()) = power().taken();
  }

  int take_step(double t_stop, double& t) override {
    // IDA itself takes an infinite y' for a tolerance that is too small.
    if (!has_finite_rate_) return IDA_FIRST_RES_FAIL;
    if (!is_consistent_) {
      if (const int flag = make_consistent(t); flag < 0) return flag;
      is_consistent_ = true;
      N_VScale(1, atol(), tolerated_->get());
      Halves at(tolerated_->get());
      set_massless(at.q, Vec::Constant(system().size(), most_rounded()));
      tolerate_rounding(t);
    }
    int flag = IDASolve(ida(), t_stop, &t, y(), rate(), IDA_ONE_STEP);
    const auto has_failed = [&] { return flag == IDA_CONV_FAIL || flag == IDA_ERR_FAIL; };
    if (massless_ && has_failed()) {
      // If springs hardly hold a massless node, Newton's iteration may fail from positions that are
      // right to the tolerance, however short the step. Near the loss of its balance, a node is
      // held along one direction s by a force like k L (m - (s/L)^2). It stands at s = L m^(1/2),
      // and an error of rtol L in positions changes m by rtol. If the node must move farther, it
      // would jump to another balance.
      is_lost_ = make_consistent(t, farthest_by_errors()) < 0;
      if (is_lost_) return flag;
      flag = IDASolve(ida(), t_stop, &t, y(), rate(), IDA_ONE_STEP);
      is_lost_ = has_failed();
    }
    if (flag < 0 || !massless_) return flag;
    if (frozen_) frozen_->set_time(t);
    if (is_rough_) tolerate_rounding(t);
    set_massless(Halves(y()).v, Halves(rate()).q);
    is_lost_ = !(massless_speed() < most_times_as_fast * (moving_speed() + options().speed));
    if (is_lost_) return IDA_CONV_FAIL;
    // After a short last step, q' would be the difference of two positions, each only right to the
    // tolerance.
    if (t == t_stop) set_massless_velocities(t);
    return flag;
  }

  // Moves massless nodes to where their forces balance, and sets y' there. Returns 0, or a flag if
  // they do not balance or only farther away than `farthest` along some axis [m].
  int make_consistent(double t_start, double farthest = std::numeric_limits<double>::infinity()) {
    Halves at(y());
    if (frozen_) frozen_->set_time(t_start);
    const Equilibrium balance = find_equilibrium(*massless_, at.q, options().length);
    if (balance.outcome != Equilibrium::Outcome::reached) return IDA_CONV_FAIL;
    if ((balance.q - at.q).lpNorm<Eigen::Infinity>() > farthest) return IDA_CONV_FAIL;
    at.q = balance.q;
    if (is_loose()) return IDA_CONV_FAIL;
    set_massless_velocities(t_start);
    set_rate_of_masses(t_start);
    set_massless(at.v, Vec::Zero(system().size()));
    restart_ida(t_start);
    return 0;
  }

  // The largest speed of massless nodes along an axis [m/s].
  double massless_speed() const {
    return (system().mass().array() > 0)
        .select(0, Halves(y()).v)
        .template lpNorm<Eigen::Infinity>();
  }
  double moving_speed() const {
    return (system().mass().array() > 0)
        .select(Halves(y()).v, 0)
        .template lpNorm<Eigen::Infinity>();
  }

  // Whether springs fail to hold a massless node in place, as compressed ones do.
  bool is_loose() const {
    const CurvatureSigns signs = curvature_signs(*massless_, Halves(y()).q);
    return signs.negative + signs.flat > (system().mass().array() > 0).count();
  }

  // Factors a M - K with an a [1/s^2] so large that nodes with mass keep their given values to
  // rounding. Returns a; NaN if the matrix is singular.
  double hold_masses(EffectiveMass& heavy, const SymmetricMatrix& k) const {
    const double stiffest = k.coeffs().cwiseAbs().maxCoeff();
    const double heaviest = system().mass().maxCoeff();  // 0 without other nodes
    const double a = heaviest > 0 ? 1e18 * stiffest / heaviest : 0;
    const bool is_singular = heavy.factorize(a, 1, k) == EffectiveMass::Definiteness::singular;
    return is_singular ? std::numeric_limits<double>::quiet_NaN() : a;
  }

  // Sets the velocities of massless nodes that keep their forces balanced: (a M - K) x = a M v, or
  // df/dt for massless nodes.
  void set_massless_velocities(double t) {
    Halves at(y());
    SymmetricMatrix k = system().stiffness_pattern();  // Newton's matrix still needs its own K
    stiffness({t, at.q}, k);
    EffectiveMass heavy(system());
    const double a = hold_masses(heavy, k);
    if (std::isnan(a)) return;
    Vec x, b = a * system().mass().cwiseProduct(at.v);
    if (const Driving* driving = system().driving()) {
      driving->force_rate({t, at.q}, f_rate_);
      set_massless(b, f_rate_);
    }
    heavy.solve(b, x);
    set_massless(at.v, x);
  }

  // The distance [m] that errors of the tolerance may move a massless node.
  double farthest_by_errors() const {
    return most_moved_by_errors * std::sqrt(rtol()) * options().length;
  }

  // The distance [m] of two places near a minimum of the potential below which their potentials
  // differ by rounding only: k s^2 = eps k L^2.
  double most_rounded() const { return std::sqrt(machine_epsilon) * options().length; }

  // Adds the effect of rounding to the tolerance of massless nodes. Rounding of the forces moves
  // their balance, (a M - K) x = +-rounding. If springs hardly hold a node at the start, this may
  // exceed the tolerance, and no step would be short enough. The tolerance shrinks as they come to
  // hold the node.
  void tolerate_rounding(double t) {
    constexpr double roundings = 4 * machine_epsilon;
    const Vec q = Halves(y()).q;
    SymmetricMatrix k = system().stiffness_pattern();
    stiffness({t, q}, k);
    EffectiveMass heavy(system());
    const bool is_known = !std::isnan(hold_masses(heavy, k));
    const Vec stiffness_of = row_sums(k);
    Vec error(system().size()), x;
    Vec moved = Vec::Constant(system().size(), is_known ? 0 : most_rounded());
    std::minstd_rand random(1);
    for (int i = 0; i < 3 && is_known; ++i) {
      for (Index j = 0; j < system().size(); ++j) {
        const double size = system().mass()[j] == 0 ? stiffness_of[j] : 0;
        error[j] = (random() % 2 == 0 ? 1 : -1) * roundings * size * q.lpNorm<Eigen::Infinity>();
      }
      heavy.solve(error, x);
      moved = moved.cwiseMax(x.cwiseAbs());
    }
    is_rough_ = false;
    Halves tolerated(tolerated_->get());
    const Halves least(atol());
    for (Index j = 0; j < system().size(); ++j) {
      if (system().mass()[j] > 0) continue;
      tolerated.q[j] = std::max(least.q[j], std::min(moved[j], tolerated.q[j]));
      is_rough_ = is_rough_ || tolerated.q[j] > least.q[j];
    }
  }

  // The weights of IDA's error norm, 1/w = rtol |y| + tolerated error.
  static int weights(N_Vector y, N_Vector w, void* user) {
    const auto& self = *static_cast<const Ida*>(static_cast<const Library*>(user));
    N_VAbs(y, w);
    N_VLinearSum(self.rtol(), w, 1, self.tolerated_->get(), w);
    N_VInv(w, w);
    return 0;
  }

  // Gives v the entries of `values` that belong to massless nodes.
  template <class Values>
  void set_massless(MutableVec v, const Values& values) const {
    for (Index i = 0; i < system().size(); ++i) {
      if (system().mass()[i] == 0) v[i] = values[i];
    }
  }

  static int residual(double t, N_Vector y, N_Vector rate, N_Vector residual, void* user) {
    auto& self = *static_cast<Ida*>(static_cast<Library*>(user));
    return self.guarded([&] {
      const Halves at(y), change(rate);
      Halves out(residual);
      out.q = change.q - at.v;
      if (self.massless_) self.set_massless(out.q, -at.v);
      out.v = self.system().mass().cwiseProduct(change.v) - self.force_at(self.system(), t, at);
      if (has_work(y)) work(residual) = work(rate) - self.power().taken();
      return std::isfinite(out.v.sum());
    });
  }

  static int jacobian(double t, double c, N_Vector y, N_Vector, N_Vector, SUNMatrix, void* user,
                      N_Vector, N_Vector, N_Vector) {
    auto& self = *static_cast<Ida*>(static_cast<Library*>(user));
    return self.guarded([&] {
      const SymmetricMatrix& k = self.stiffness_at(t, Halves(y));
      self.matrix().set_implicit_form(c, k, self.damping_matrix());
      return true;
    });
  }

  Cause cause_of(int flag) const override {
    if (!is_consistent_) return Cause::consistent_start;
    if (is_lost_) return Cause::loose_massless;
    const bool is_about_a_step = flag == IDA_ERR_FAIL || flag == IDA_CONV_FAIL ||
                                 flag == IDA_NLS_FAIL || flag == IDA_LSETUP_FAIL;
    if (is_about_a_step && massless_ && is_loose()) return Cause::loose_massless;
    return IdaStepper::cause_of(flag);
  }

  std::optional<Vector> tolerated_;  // absolute tolerance, with that of massless nodes
  Vec f_rate_{system().size()};
  // A system that depends on time, at the time reached; only with massless nodes.
  std::optional<FrozenInTime> frozen_;
  // The system with all unknowns held but the massless ones; empty without massless nodes.
  std::optional<ConstrainedSystem> massless_;
  bool is_consistent_ = true, has_finite_rate_ = true;
  bool is_lost_ = false;   // whether no balance is left near the massless nodes
  bool is_rough_ = false;  // whether rounding moves a massless node by more than the tolerance
};

template <MakeMatrix make_matrix>
Method ida(const char* name, const char* solver, const char* stock_of = "") {
  return {.name = name,
          .summary = fmt::format("SUNDIALS IDA, adaptive BDF of order 1 to 5 in residual form, {}",
                                 solver),
          .source = "Hindmarsh et al., SUNDIALS, ACM TOMS 31:3 (2005) 363-396, section 2.3",
          .order = 5,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::implicit, Trait::accepts_massless},
          .needs = {Need::conservative, Need::stiffness, Need::rate_in_time},
          .takes =
              SetOf<Option>{Option::max_order}.with(Option::solver, make_matrix == make_structured),
          .stock_of = stock_of,
          .damped = Damped::by_any,
          .make = create_steps<Ida<make_matrix>>};
}

}  // namespace

Method ida() { return ida<make_structured>("ida", "n x n solves"); }
Method ida_klu() { return ida<make_klu>("ida_klu", "stock KLU", "ida"); }

}  // namespace qddot::registered
