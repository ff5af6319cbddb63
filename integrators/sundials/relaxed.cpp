// ARKODE's adaptive explicit Runge-Kutta methods with relaxation: each step keeps the energy. With
// y = (q, v), F(y) = (v, M^-1 f(q)), the coefficients a_ij and b_i of the named table, and the
// energy E(y) = v'M v/2 + V(q):
//   Y_i     = y_n + h sum_{j<i} a_ij F(Y_j),   d = h sum_{i<=s} b_i F(Y_i)
//   y_{n+1} = y_n + r d,   t_{n+1} = t_n + r h,   where E(y_n + r d) = E(y_n),   r near 1
// The order is that of the table: r = 1 + O(h^(p-1)) is in the time, too. Newton's method finds r
// from that of the last step, with a value of V and a force a round. ARKODE relaxes tables of
// b_i >= 0 only.
//
// A relaxed step cannot end on a given time. The last step, to the end of the run, is therefore not
// relaxed, nor are the separate steps to states between two ends of steps.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "integrators/sundials/arkode.hpp"
#include "integrators/sundials/imaginary_stability.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

struct RelaxedTable {
  int order;
  ARKODE_ERKTableID id;
  const char* name;
  const char* source;
};
constexpr RelaxedTable relaxed_tables[] = {
    {4, ARKODE_ZONNEVELD_5_3_4, "ARKODE_ZONNEVELD_5_3_4", "Zonneveld (1963)"},
    {5, ARKODE_CASH_KARP_6_4_5, "ARKODE_CASH_KARP_6_4_5",
     "Cash and Karp, ACM TOMS 16:3 (1990) 201-222"},
    {6, ARKODE_VERNER_8_5_6, "ARKODE_VERNER_8_5_6",
     "Verner, SIAM J. Numerical Analysis 15:4 (1978) 772-790"}};

#if QDDOT_SUNDIALS >= 70100

// A change of E below this part of its size is rounding, about 1e-16 for each of some hundred
// terms; or below so many times the largest change of V in some samples of a rounding of q. The
// first steps are often so short that there is no other.
constexpr double rounding = 1e-13, roundings_of_q = 10;
constexpr int samples = 4;
// A change of E below this part that a round of Newton's method does not halve is rounding, too.
constexpr double suspicious = 1e-6;
// ARKODE refuses an r beyond this.
constexpr double largest_r = 1.2;

ButcherTable table_of(ARKODE_ERKTableID id) {
  return ButcherTable(check(ARKodeButcherTable_LoadERK(id)));
}

// Steps of a table that are not relaxed.
class Plain final : public Arkode {
 public:
  Plain(SystemRun& run, ARKODE_ERKTableID id) : Plain(run, table_of(id)) {}

  // One step towards t_stop, and all the way if its error allows.
  Outcome take_to(double t_stop, const State& from, State& next) {
    check(ARKodeSetInitStep(memory(), t_stop - from.t), "ARKodeSetInitStep");
    begin(from, next);
    set_stop_time(t_stop);
    return take(from, t_stop, next);
  }

 private:
  Plain(SystemRun& run, ButcherTable table)
      : Arkode(run, {.explicit_table = table.get()}, right_hand_side, nullptr, nullptr,
               run.system()) {}
};

// Relaxed steps of a table, held to what the largest frequency allows, as those of arkode_erk.
class Relaxed final : public Arkode {
 public:
  Relaxed(SystemRun& run, ARKODE_ERKTableID id) : Relaxed(run, table_of(id)) {}

  // The time [s] that the next step will not pass.
  double reach(double t) const {
    double h = 0;
    check(ARKodeGetCurrentStep(memory(), &h), "ARKodeGetCurrentStep");
    return t + largest_r * h;
  }

 private:
  Relaxed(SystemRun& run, ButcherTable table)
      : Arkode(run, {.explicit_table = table.get()}, right_hand_side, nullptr, nullptr,
               run.system()) {
    limit_steps(system(), imaginary_stability(*table));
    check(ARKodeSetRelaxFn(memory(), energy, slope), "ARKodeSetRelaxFn");
    check(ARKodeSetRelaxUpperBound(memory(), largest_r), "ARKodeSetRelaxUpperBound");
  }

  void start(const State& state) override {
    Arkode::start(state);
    const double speed = options().speed;
    const double v0 = run_.counted().potential(state);
    const double size =
        std::abs(v0) + kinetic_energy(state.v) + system().mass().sum() * speed * speed / 2;
    per_size_ = 1 / std::max(size, std::numeric_limits<double>::min());
    double change = 0;
    std::minstd_rand random;
    for (int sample = 0; sample < samples; ++sample) {
      Vec q = state.q;
      for (double& x : q) x *= 1 + (random() % 2 ? 1 : -1) * machine_epsilon;
      change = std::max(change, std::abs(run_.counted().potential({state.t, q, state.v}) - v0));
    }
    check(ARKodeSetRelaxResTol(memory(), std::max(rounding, roundings_of_q * per_size_ * change)),
          "ARKodeSetRelaxResTol");
    iterate_ = nullptr;
  }

  Cause cause_of(int flag) const override {
    return flag == ARK_RELAX_FAIL ? Cause::relaxation : cause_of_arkode(flag);
  }

  double kinetic_energy(const ConstVec& v) const {
    return v.cwiseProduct(system().mass()).dot(v) / 2;
  }

  // E as a part of its size at the start, since ARKODE compares its changes with an absolute bound.
  static int energy(N_Vector y, double* e, void* user) {
    auto& self = *static_cast<Relaxed*>(static_cast<Library*>(user));
    return self.guarded([&] {
      const Halves at(y);
      *e = self.per_size_ *
           (self.kinetic_energy(at.v) + self.run_.counted().potential({0, at.q, at.v}));
      if (!self.iterate_) {
        self.e_old_ = *e;
        self.change_ = std::numeric_limits<double>::infinity();
      } else {
        const double last = std::exchange(self.change_, std::abs(*e - self.e_old_));
        if (self.change_ < suspicious && self.change_ > last / 2) *e = self.e_old_;
      }
      self.iterate_ = y;
      return std::isfinite(*e);
    });
  }
  // The gradient of E at an iterate of Newton's method, which is where E was asked for last. ARKODE
  // asks for it at the stages, too, for the change h sum b_i g(Y_i)'F(Y_i) of E. That is zero,
  // whatever g: E is constant along the motion.
  static int slope(N_Vector y, N_Vector g, void* user) {
    auto& self = *static_cast<Relaxed*>(static_cast<Library*>(user));
    return self.guarded([&] {
      Halves change(g);
      if (y != self.iterate_) {
        self.iterate_ = nullptr;
        change.q.setZero();
        change.v.setZero();
        return true;
      }
      const Halves at(y);
      change.q = -self.per_size_ * self.force_at(self.system(), 0, at);
      change.v = self.per_size_ * self.system().mass().cwiseProduct(at.v);
      return std::isfinite(change.q.sum());
    });
  }

  double per_size_ = 1;            // [1/J]
  N_Vector iterate_ = nullptr;     // of Newton's method; nullptr before E(y_n) is known
  double e_old_ = 0, change_ = 0;  // E(y_n), and |E - E(y_n)| at the iterate, as parts of its size
};

class RelaxedSteps final : public Stepper {
 public:
  RelaxedSteps(SystemRun& run, ARKODE_ERKTableID id) : run_(run), id_(id), plain_(run, id) {}

  void start(const State& state) override {
    relaxed_.emplace(run_, id_);  // another memory, since ARKODE keeps the r of an earlier run
    relaxed_->begin(state, now_);
    before_ = next_ = aside_ = now_;
    is_first_ = true;
    is_last_ = false;
    creep_ = Creep(now_.t);
  }

  bool has_passed(double t) override { return now_.t >= t; }

  // ARKODE's own first step is at most a tenth of the run.
  Outcome step(double) override {
    const double t_end = run_.t_end();
    is_last_ = is_last_ || (!is_first_ && !(relaxed_->reach(now_.t) < t_end));
    is_first_ = false;
    Outcome outcome =
        is_last_ ? plain_.take_to(t_end, now_, next_) : relaxed_->take(now_, t_end, next_);
    if (outcome == Outcome::reached_end) outcome = run_.check_step(now_, next_);
    if (outcome != Outcome::reached_end) return outcome;
    std::swap(before_, now_);
    std::swap(now_, next_);
    run_.note(now_);
    return creep_.is_found(now_.t, t_end) ? relaxed_->creeping(now_.t) : Outcome::reached_end;
  }

  // A state between two ends of steps is the end of separate steps, which are not counted.
  Outcome show(double t, State& state) override {
    if (now_.t == t) {
      state = now_;
      return Outcome::reached_end;
    }
    collect_counts();
    const Counts kept = run_.counts();
    aside_ = before_;
    Outcome outcome = Outcome::reached_end;
    while (outcome == Outcome::reached_end && aside_.t < t) {
      outcome = run_.must_stop() ? Outcome::over_budget : plain_.take_to(t, aside_, state);
      if (outcome == Outcome::reached_end) outcome = run_.check_step(aside_, state);
      if (outcome == Outcome::reached_end) std::swap(aside_, state);
    }
    plain_.collect_counts();
    run_.counts().steps = kept.steps;
    run_.counts().rejected = kept.rejected;
    state = outcome == Outcome::reached_end ? aside_ : before_;
    return outcome;
  }

  void show_last(State& state) override {
    if (now_.t > state.t) state = now_;
  }

  void collect_counts() override {
    relaxed_->collect_counts();
    if (is_last_) plain_.collect_counts();
  }

 private:
  SystemRun& run_;
  ARKODE_ERKTableID id_;
  std::optional<Relaxed> relaxed_;
  Plain plain_;
  State before_, now_, next_, aside_;  // before_ and now_ are the ends of the last step
  bool is_first_ = true, is_last_ = false;
  Creep creep_;
};

template <int which>
std::unique_ptr<Stepper> create_relaxed(SystemRun& run) {
  return std::make_unique<RelaxedSteps>(run, relaxed_tables[which].id);
}
template <int which>
constexpr MakeStepper make_relaxed = create_relaxed<which>;

#else

template <int>
constexpr MakeStepper make_relaxed = nullptr;

#endif

template <int which>
Method relaxed() {
  const RelaxedTable& table = relaxed_tables[which];
  return {.name = fmt::format("arkode_relaxed{}", table.order),
          .summary = fmt::format("SUNDIALS ARKODE, adaptive explicit of order {} that keeps the "
                                 "energy, {}, steps held to 1/w_max",
                                 table.order, table.name),
          .source = fmt::format("Ketcheson, SIAM J. Numerical Analysis 57:6 (2019) 2850-2870; {}",
                                table.source),
          .order = table.order,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::interpolates, Trait::bounds_steps},
          .needs = {Need::potential, Need::conservative, Need::autonomous},
          .needs_sundials = 70100,
          .why_not_damped = "it keeps the energy, which damping takes",
          .make = make_relaxed<which>};
}

}  // namespace

Method arkode_relaxed4() { return relaxed<0>(); }
Method arkode_relaxed5() { return relaxed<1>(); }
Method arkode_relaxed6() { return relaxed<2>(); }

}  // namespace qddot::registered
