// Integrators of our registry. Our own run on the smallest system of the scene or on the one that
// peers get. SUNDIALS' implicit ones run with SUNDIALS' own matrix and solver, KLU on 2n x 2n.
#include "experiments/bench/peers.hpp"
#include "experiments/bench/processor_time.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::bench {
namespace {

// A run of one integrator over either system, its end as that of all free nodes.
Run run_of(const Method& method, const System& system, const ReducedScene& scene,
           const Problem& problem, double value, double limit) {
  const auto integrator = make_integrator(method, system, options_for(method, value, scene));
  State state = scene.initial();
  const Deadline deadline(limit);
  Summary summary;
  Run run;
  {
    const ProcessorTime watch(run.seconds);
    summary = integrator->advance(state, problem.until, {}, deadline.token());
  }
  run.outcome = summary.outcome;
  run.end = state_of(scene.expand(state), problem.start.dimension, state.t);
  run.steps = summary.counts.steps;
  run.force_evaluations = summary.counts.force_evaluations;
  return run;
}

class OurMethod final : public Peer {
 public:
  OurMethod(const Method& method, bool smallest)
      : Peer(method.name, method.knob), method_(method), is_smallest_(smallest) {}

  std::vector<ForceKind> forces() const override { return {ForceKind::ours}; }
  std::vector<double> values(const Problem& problem) const override {
    return method_.knob == Knob::rtol ? tolerances(4) : step_sizes(problem, 10, 4);
  }

  Run run(const Problem& problem, ForceKind, double value, double limit) override {
    const ReducedScene& scene = is_smallest_ ? problem.smallest : problem.scene;
    return run_of(method_, scene.system(), scene, problem, value, limit);
  }

 private:
  const Method& method_;
  bool is_smallest_;
};

class StockImplicit final : public Peer {
 public:
  explicit StockImplicit(const Method& method) : Peer(method.name, Knob::rtol), method_(method) {}

  bool is_stock_implicit() const override { return true; }
  std::vector<double> values(const Problem&) const override { return tolerances(1); }

  Run run(const Problem& problem, ForceKind force, double rtol, double limit) override {
    const PlainForce plain(problem.start);
    const auto with_plain = with_plain_force(problem.scene.system(), plain);
    const System& system = force == ForceKind::plain ? *with_plain : problem.scene.system();
    return run_of(method_, system, problem.scene, problem, rtol, limit);
  }

 private:
  const Method& method_;
};

}  // namespace

std::unique_ptr<Peer> our_method(const std::string& method, bool smallest) {
  return std::make_unique<OurMethod>(*find_method(method), smallest);
}

std::unique_ptr<Peer> stock_implicit(const std::string& method) {
  return std::make_unique<StockImplicit>(*find_method(method));
}

}  // namespace qddot::bench
