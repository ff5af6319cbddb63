#include "integrators/sundials/library.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot::sundials {
namespace {

// The tolerance of constant steps is for Newton's iteration alone, whose error should be
// negligible.
constexpr double newton_rtol = 1e-10;
// The tolerance [J] of an energy that decides no step; its inverse is no subnormal number.
constexpr double unlimited = 1e200;

}  // namespace

Library::Library(SystemRun& run, Index length)
    : Library(run, run.system(), make_context(),
              [&](SUNContext context) { return make_stock_vector(length, context); }) {}

Library::Library(SystemRun& run, MakeMatrix make_matrix, const System& implicit_part)
    : Library(run, implicit_part, make_context(), [&](SUNContext context) {
        const Index length = stacked_size(run.system());
        return make_matrix == make_klu ? make_stock_vector(length, context)
                                       : make_vector(length, context);
      }) {
  if (!make_matrix) return;
  k_ = implicit_part.stiffness_pattern();
  if (implicit_part.damping()) c_ = k_;
  matrix_ = make_matrix(implicit_part, context(), options().solver);
  matrix_->time_into(clock());
}

Library::Library(SystemRun& run, const System& implicit_part, Context context,
                 const MakeVector& make)
    : Formula(run),
      implicit_part_(implicit_part),
      context_(std::move(context)),
      y_(make(context_.get())),
      atol_(clone(y())),
      per_mass_(system().mass().cwiseInverse()),
      f_(system().size()) {
  Halves absolute(atol());
  const bool is_given = options().atol > 0;
  absolute.q.setConstant(is_given ? options().atol : rtol() * options().length);
  absolute.v.setConstant(is_given ? options().atol : rtol() * options().speed);
  // Work follows the motion, and decides no step.
  if (has_work(atol())) work(atol()) = unlimited;
}

double Library::rtol() const { return has_fixed_step() ? newton_rtol : options().rtol; }

void Library::load(const State& state) {
  Halves halves(y());
  halves.q.head(state.q.size()) = state.q;
  halves.v.head(state.v.size()) = state.v;
  if (has_work(y())) work(y()) = state.work.dissipated - state.work.driven;
  if (has_matrix()) matrix().begin_run();
}

void Library::begin(const State& state, State& x) {
  parked_ = nullptr;
  is_finite_ = true;
  said_.clear();
  if (has_begun_) collect_counts();
  start(state);
  has_begun_ = true;
  collected_ = {};
  x = state;
}

void Library::collect_counts() {
  OwnCounts own = own_counts();
  if (has_matrix()) own.indefinite = matrix().indefinite();
  const OwnCounts& last = collected_;
  Counts& all = counts();
  if (!has_fixed_step()) all.steps += own.steps - last.steps;  // FixedSteps counts its own
  all.rejected += own.failed_tests + own.failed_solves - last.failed_tests - last.failed_solves;
  all.factorizations += own.setups - last.setups;
  all.newton_iterations += own.iterations - last.iterations;
  all.solves += own.iterations - last.iterations;
  all.stability_limited_steps += own.limited_steps - last.limited_steps;
  all.indefinite_factorizations += own.indefinite - last.indefinite;
  collected_ = own;
}

const Vec& Library::force_at(const System& part, double t, const Halves& y) {
  force(part, {t, y.q, y.v}, f_);
  return f_;
}

bool Library::set_rate(const System& part, double t, N_Vector y, N_Vector rate) {
  const Halves at(y);
  Halves change(rate);
  change.q = at.v;
  change.v = per_mass_.cwiseProduct(force_at(part, t, at));
  if (has_work(rate)) work(rate) = power().taken();
  return std::isfinite(change.v.sum());
}

const SymmetricMatrix& Library::stiffness_at(double t, const Halves& y) {
  stiffness(implicit_part_, {t, y.q, y.v}, k_);
  if (c_.size() > 0) implicit_part_.damping()->damping_matrix({t, y.q, y.v}, c_);
  return k_;
}

int Library::right_hand_side(double t, N_Vector y, N_Vector rate, void* user) {
  auto& self = *static_cast<Library*>(user);
  return self.guarded([&] { return self.set_rate(self.system(), t, y, rate); });
}

int Library::set_matrix(double t, N_Vector y, bool jok, int* jcur, double gamma) noexcept {
  return guarded([&] {
    if (!jok) stiffness_at(t, Halves(y));
    *jcur = !jok;
    matrix().set_explicit_form(gamma, k_, damping_matrix());
    return true;
  });
}

void Library::keep_words(const char* words, void* self) noexcept {
  try {
    static_cast<Library*>(self)->said_ = words;
  } catch (...) {  // no memory for a message: the flag alone is kept
  }
}

Outcome Library::step(const State& x, double h, State& next) {
  // No stop time is set: ARKODE 6.4.1 halves a first step that ends on one.
  set_step_size(h);
  return take(x, next.t, next);
}

// The balance is by the library's own quadrature. What driving gave in the step is told apart by
// Simpson's rule, on the cubic through both ends.
void Library::set_work(const State& from, State& next) {
  const double taken = work(y());
  if (!is_driven()) {
    next.work.dissipated = taken;
  } else if (is_damped()) {
    const double h = next.t - from.t;
    const Vec q = (from.q + next.q) / 2 + h / 8 * (from.v - next.v);
    const Vec v = 1.5 / h * (next.q - from.q) - (from.v + next.v) / 4;
    const auto rate = [&](const At& at) { return driving_rate(at); };
    next.work.driven += h / 6 * (rate(from) + 4 * rate({from.t + h / 2, q, v}) + rate(next));
    next.work.dissipated = next.work.driven + taken;
  } else {
    next.work.driven = next.work.dissipated - taken;
  }
}

Outcome Library::take(const State& from, double t_stop, State& next) {
  t_stop_ = t_stop;
  is_finite_ = true;
  double t = from.t;
  const int flag = take_step(t_stop, t);
  if (parked_) std::rethrow_exception(parked_);
  if (has_matrix()) matrix().rethrow();
  if (flag < 0) return failure(flag, from.t);
  const Halves halves(y());
  next.q = halves.q.head(system().size());
  next.v = halves.v.head(system().size());
  next.t = t;
  next.work = from.work;
  if (has_work(y())) set_work(from, next);
  return Outcome::reached_end;
}

Cause Library::named_cause(int flag, double t) {
  const Cause cause = cause_of(flag);
  const bool has_time =
      t_stop_ - t > 4 * machine_epsilon * std::max(std::abs(t), std::abs(t_stop_));
  if (cause == Cause::end_too_close && has_time) return Cause::accuracy;
  if (is_finite_) return cause;
  const bool is_force =
      cause == Cause::force || cause == Cause::convergence || cause == Cause::fast_steps;
  if (is_force && counts().force_evaluations == 1) return Cause::first_force;
  return is_force ? Cause::force : cause;
}

Outcome Library::failure(Cause cause, const std::string& flag, double t) {
  std::ranges::replace(said_, '\n', ' ');
  set_message(fmt::format("{} at t = {:.6g} s: {} ({}{}{})", what_happened(cause), t,
                          what_to_turn(cause, has_fixed_step()), flag, said_.empty() ? "" : ": ",
                          said_));
  return outcome_of(cause);
}

}  // namespace qddot::sundials
