#pragma once

#include <exception>
#include <memory>
#include <vector>

#include "qddot/integrators/integrator.hpp"

namespace qddot {

// Runs a system of uncoupled parts (see Blocks) as one run with one outcome. Each part has its own
// integrator and, if the method is adaptive, its own steps. Counts and seconds are sums over the
// parts. If a part fails, the others are brought to the time that it reached; the earliest of
// several failures decides. A run stopped from outside ends at the last time that all parts share:
// its start or an observer's time. No time is left to bring them farther.
class Parts final : public Integrator {
 public:
  Parts(const Method& method, const System& system, const Options& options);

  // The mean time [s] of the parts, which run one after another.
  double reached() const override;

 private:
  struct Part {
    Index first;  // of its unknowns
    std::unique_ptr<Integrator> integrator;
    State state, begin;           // now, and where the present run_to began
    double growth;                // of the energy, in runs that were undone
    std::exception_ptr thrown{};  // by its system or by the observer, in the present run_to
  };

  void start(const State& state) override;
  Outcome run_to(State& state, double t_stop) override;

  void start(Part& part);
  // Brings the part to t_end from its start, even if it has run from there before.
  Outcome run_part(Part& part, double t_end);
  void gather(State& state);
  EnergyChange energy_change(const State& state) override;

  std::vector<Part> parts_;
};

}  // namespace qddot
