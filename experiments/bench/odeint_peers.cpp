// boost::odeint as its users have it: std::vector for states, its own algebra, integrate_adaptive
// and integrate_n_steps.
#include <cmath>

#include <boost/numeric/odeint.hpp>

#include "experiments/bench/peers.hpp"
#include "qddot/measure/motion/deadline.hpp"

namespace qddot::bench {
namespace {

namespace odeint = boost::numeric::odeint;
using Stacked = std::vector<double>;

struct TimeIsUp {};

// Turns the exceptions of odeint into outcomes; `work` sets the end and the steps of the run.
template <class Work>
void guarded(Run& run, const Work& work) {
  try {
    const ProcessorTime watch(run.seconds);
    work();
    const bool is_finite = run.end.q.allFinite() && run.end.v.allFinite();
    run.outcome = is_finite ? Outcome::reached_end : Outcome::not_finite;
  } catch (const TimeIsUp&) {
    run.outcome = Outcome::over_budget;
  } catch (const odeint::odeint_error&) {
    run.outcome = Outcome::step_too_small;
  }
}

class Dopri5 final : public Peer {
 public:
  Dopri5() : Peer("odeint dopri5", Knob::rtol) {}

  std::vector<double> values(const Problem&) const override { return tolerances(2); }

  Run run(const Problem& problem, ForceKind force, double rtol, double limit) override {
    const State& initial = problem.scene.initial();
    const Index n = initial.q.size();
    Acceleration acceleration(problem.start, problem.scene.system(), force);
    const Deadline deadline(limit);
    const auto rate = [&](const Stacked& y, Stacked& dy, double) {
      if (deadline.passed()) throw TimeIsUp{};
      std::copy_n(y.begin() + n, n, dy.begin());
      acceleration(y.data(), dy.data() + n);
    };
    Stacked y(static_cast<std::size_t>(2 * n));
    Vec::Map(y.data(), n) = initial.q;
    Vec::Map(y.data() + n, n) = initial.v;
    Run run;
    guarded(run, [&] {
      const auto steps = odeint::integrate_adaptive(
          odeint::make_controlled<odeint::runge_kutta_dopri5<Stacked>>(rtol * problem.length, rtol),
          rate, y, 0.0, problem.until, problem.until / 1000);
      run.steps = static_cast<std::int64_t>(steps);
      run.end = {problem.until, Vec::Map(y.data(), n), Vec::Map(y.data() + n, n)};
    });
    run.force_evaluations = acceleration.evaluations();
    return run;
  }
};

class McLachlan final : public Peer {
 public:
  McLachlan() : Peer("odeint McLachlan", Knob::step_size) {}

  std::vector<double> values(const Problem& problem) const override {
    return step_sizes(problem, 10, 4);
  }

  Run run(const Problem& problem, ForceKind force, double h, double limit) override {
    const State& initial = problem.scene.initial();
    Acceleration acceleration(problem.start, problem.scene.system(), force);
    const Deadline deadline(limit);
    const auto rate = [&](const Stacked& q, Stacked& a) {
      if (deadline.passed()) throw TimeIsUp{};
      acceleration(q.data(), a.data());
    };
    std::pair<Stacked, Stacked> state{{initial.q.begin(), initial.q.end()},
                                      {initial.v.begin(), initial.v.end()}};
    Run run;
    run.steps = std::llround(problem.until / h);
    guarded(run, [&] {
      odeint::integrate_n_steps(odeint::symplectic_rkn_sb3a_mclachlan<Stacked>(), rate, state, 0.0,
                                problem.until / static_cast<double>(run.steps),
                                static_cast<std::size_t>(run.steps));
      const auto n = std::ssize(state.first);
      run.end = {problem.until, Vec::Map(state.first.data(), n), Vec::Map(state.second.data(), n)};
    });
    run.force_evaluations = acceleration.evaluations();
    return run;
  }
};

}  // namespace

std::unique_ptr<Peer> odeint_dopri5() { return std::make_unique<Dopri5>(); }
std::unique_ptr<Peer> odeint_mclachlan() { return std::make_unique<McLachlan>(); }

}  // namespace qddot::bench
