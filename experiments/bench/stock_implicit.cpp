// SUNDIALS' implicit methods the stock way, KLU on 2n x 2n: the twins on _klu of our own methods,
// with the same tuning.
#include "experiments/bench/peers.hpp"
#include "experiments/deadline.hpp"
#include "experiments/measurement.hpp"
#include "experiments/timing.hpp"
#include "integrators/registry.hpp"

namespace qddot::bench {
namespace {

class StockImplicit final : public Peer {
 public:
  explicit StockImplicit(const Method& method) : Peer(method.name, Knob::rtol), method_(method) {}

  bool is_stock_implicit() const override { return true; }
  std::vector<double> ladder(const Problem&) const override { return tolerances(1); }

  Run run(const Problem& problem, ForceKind force, double rtol, double limit) override {
    const PlainForce plain(problem.start);
    const auto with_plain = with_plain_force(problem.scene.system(), plain);
    const System& system = force == ForceKind::plain ? *with_plain : problem.scene.system();
    const auto integrator =
        make_integrator(method_, system, knobs_for(method_, rtol, problem.scene));
    Run run{.end = problem.scene.initial()};
    const Deadline deadline(limit);
    Summary summary;
    run.seconds = seconds_of(
        [&] { summary = integrator->advance(run.end, problem.until, {}, deadline.token()); });
    run.outcome = summary.outcome;
    run.steps = summary.counts.steps;
    run.force_evaluations = summary.counts.force_evaluations;
    return run;
  }

 private:
  const Method& method_;
};

}  // namespace

std::unique_ptr<Peer> stock_implicit(const std::string& method) {
  return std::make_unique<StockImplicit>(*find_method(method));
}

}  // namespace qddot::bench
