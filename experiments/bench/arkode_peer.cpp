// SUNDIALS' ERKStep with the defaults of its users: y = (q, v) in the stock serial vector, the
// method of order 4 and the default step control. Absolute tolerances follow the sizes of positions
// and velocities.
#include "experiments/bench/peers.hpp"
#include "integrators/sundials/support.hpp"
#include "qddot/measure/motion/deadline.hpp"

namespace qddot::bench {
namespace {

using namespace sundials;

struct Task {
  Acceleration acceleration;
  Deadline deadline;
};

int rate(double, N_Vector y, N_Vector dy, void* user) {
  auto& task = *static_cast<Task*>(user);
  if (task.deadline.passed()) return -1;
  const Halves state(y);
  Halves derivative(dy);
  derivative.q = state.v;
  task.acceleration(state.q.data(), derivative.v.data());
  return 0;
}

// The outcome says enough.
void say_nothing(const char*, void*) noexcept {}

class Erk4 final : public Peer {
 public:
  Erk4() : Peer("ARKODE ERK4", Knob::rtol) {}

  std::vector<double> values(const Problem&) const override { return tolerances(2); }

  Run run(const Problem& problem, ForceKind force, double rtol, double limit) override {
    const State& initial = problem.scene.initial();
    const Index n = initial.q.size();
    const Context context = make_context();
    const Vector y = make_stock_vector(2 * n, context.get()), atol = clone(y.get());
    Halves(y.get()).q = initial.q;
    Halves(y.get()).v = initial.v;
    Halves(atol.get()).q.setConstant(rtol * problem.length);
    Halves(atol.get()).v.setConstant(rtol * problem.speed);

    Task task{{problem.start, problem.scene.system(), force}, Deadline(limit)};
    const std::unique_ptr<void, FreeMemoryBy<free_erk>> memory(
        check(ERKStepCreate(rate, 0, y.get(), context.get())));
    check(set_error_handler<say_nothing>(errors_of_erkstep, memory.get(), context.get(), nullptr),
          "the error handler");
    check(set_erk_user_data(memory.get(), &task), "ERKStepSetUserData");
    check(set_erk_order(memory.get(), 4), "ERKStepSetOrder");
    check(set_erk_tolerances(memory.get(), rtol, atol.get()), "ERKStepSVtolerances");
    check(set_erk_max_steps(memory.get(), -1), "ERKStepSetMaxNumSteps");
    check(set_erk_stop_time(memory.get(), problem.until), "ERKStepSetStopTime");

    Run run;
    int flag = 0;
    double t = 0;
    {
      const ProcessorTime watch(run.seconds);
      flag = evolve_erk(memory.get(), problem.until, y.get(), &t, ARK_NORMAL);
    }
    const bool has_ended = flag >= 0 && t == problem.until;
    run.outcome = has_ended                ? Outcome::reached_end
                  : task.deadline.passed() ? Outcome::over_budget
                                           : Outcome::solver_failed;
    run.end = {t, Halves(y.get()).q, Halves(y.get()).v};
    long steps = 0;
    check(get_erk_steps(memory.get(), &steps), "ERKStepGetNumSteps");
    run.steps = steps;
    run.force_evaluations = task.acceleration.evaluations();
    return run;
  }
};

}  // namespace

std::unique_ptr<Peer> arkode_erk4() { return std::make_unique<Erk4>(); }

}  // namespace qddot::bench
