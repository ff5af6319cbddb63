#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/bench/acceleration.hpp"
#include "experiments/bench/problem.hpp"
#include "qddot/integrators/method.hpp"

namespace qddot::bench {

// How runs of a peer ended. The end and the counts mean something only where they reached it.
struct Run {
  Outcome outcome = Outcome::solver_failed;
  State end{};
  double seconds = 0;  // processor time of a run, set-up left out: median of `timed` runs
  int timed = 1;
  std::int64_t steps = 0, force_evaluations = 0;
};

// Somebody else's solver, set up as its users would, whose accuracy is set by one knob.
class Peer {
 public:
  Peer(std::string name, Knob knob) : name_(std::move(name)), knob_(knob) {}
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  const std::string& name() const { return name_; }
  Knob knob() const { return knob_; }

  // One run with the knob at `value` [s, or relative], over budget after `limit` seconds; a peer
  // that is slow to start may make and time several. Never throws what the solver throws.
  virtual Run run(const Problem& problem, ForceKind force, double value, double limit) = 0;
  // Values of the knob from coarse to fine.
  virtual std::vector<double> values(const Problem& problem) const = 0;
  // Whose f it can be given.
  virtual std::vector<ForceKind> forces() const { return {ForceKind::plain, ForceKind::ours}; }
  // Which of our methods takes the same steps, but for rounding; empty where none does.
  virtual std::string twin() const { return {}; }
  // The reason why the peer cannot run the scene, as a clause; empty if it can.
  virtual std::string misfit(const Scene&) const { return {}; }
  // Whether it is one of SUNDIALS' implicit methods.
  virtual bool is_stock_implicit() const { return false; }

 private:
  std::string name_;
  Knob knob_;
};

// 1e-2 to 1e-13, so many in a factor of ten.
std::vector<double> tolerances(int in_a_decade);
// Step sizes [s], `in_a_decade` in each factor of ten, each of which divides the run. The largest
// one has h w = 16 for the fastest vibration at the start, above the limit of methods of a dozen
// stages.
std::vector<double> step_sizes(const Problem& problem, int in_a_decade, int decades);

}  // namespace qddot::bench
