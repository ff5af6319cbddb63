// Integrators of our registry. Our own run on the smallest system of the scene or on the one that
// peers get. SUNDIALS' implicit ones run with SUNDIALS' own matrix and solver, KLU on 2n x 2n.
#include "experiments/bench/peers.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::bench {
namespace {

// The system with the plain f in the place of its own, as far as SUNDIALS uses it. Borrows both.
class WithPlainForce final : public System {
 public:
  WithPlainForce(const System& system, const PlainForce& plain)
      : System(system.mass()), system_(system), plain_(plain) {}

  void force(const At& at, MutableVec f) const override { plain_.force(at.q.data(), f.data()); }
  double potential(const At& at) const override { return system_.potential(at); }
  void stiffness(const At& at, SymmetricMatrix& k) const override { system_.stiffness(at, k); }
  const SymmetricMatrix& stiffness_pattern() const override { return system_.stiffness_pattern(); }
  bool stiffness_is_constant() const override { return system_.stiffness_is_constant(); }

 private:
  const System& system_;
  const PlainForce& plain_;
};

// A run of one integrator over either system, its end as that of all free nodes.
Run run_of(const Method& method, const System& system, const Model& scene, const Problem& problem,
           double value, double limit) {
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

class Registered final : public Peer {
 public:
  Registered(const Method& method, bool smallest, bool is_stock)
      : Peer(method.name, method.knob),
        method_(method),
        is_smallest_(smallest),
        is_stock_(is_stock) {}

  bool is_stock_implicit() const override { return is_stock_; }
  std::vector<ForceKind> forces() const override {
    return is_stock_ ? Peer::forces() : std::vector{ForceKind::ours};
  }
  std::vector<double> values(const Problem& problem) const override {
    if (method_.knob == Knob::rtol) return tolerances(is_stock_ ? 1 : 4);
    return step_sizes(problem, 10, 4);
  }

  Run run(const Problem& problem, ForceKind force, double value, double limit) override {
    const Model& scene = is_smallest_ ? problem.smallest : problem.scene;
    if (force == ForceKind::ours)
      return run_of(method_, scene.system(), scene, problem, value, limit);
    const PlainForce plain(problem.start);
    return run_of(method_, WithPlainForce(scene.system(), plain), scene, problem, value, limit);
  }

 private:
  const Method& method_;
  bool is_smallest_, is_stock_;
};

}  // namespace

std::unique_ptr<Peer> our_method(const std::string& method, bool smallest) {
  return std::make_unique<Registered>(*find_method(method), smallest, /*is_stock=*/false);
}

std::unique_ptr<Peer> stock_implicit(const std::string& method) {
  return std::make_unique<Registered>(*find_method(method), /*smallest=*/false, /*is_stock=*/true);
}

}  // namespace qddot::bench
