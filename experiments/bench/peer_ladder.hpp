#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/bench/peers.hpp"

namespace qddot::bench {

// One measured point: a solver at one value of its knob.
struct Measured {
  std::string solver, force;
  Index unknowns = 0;
  Knob knob{};
  double value = 0;
  Outcome outcome{};
  double error = 0;    // where it reached the end
  double seconds = 0;  // the median of the timed runs, or what was spent without reaching the end
  int timed = 0;
  std::int64_t steps = 0, force_evaluations = 0;

  bool is_good() const { return outcome == Outcome::reached_end; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Measured, solver, force, unknowns, knob, value, outcome, error,
                                   seconds, timed, steps, force_evaluations)

// All points of one solver with one f, from coarse to fine.
struct PeerLadder {
  bool is_ours = false, is_stock_implicit = false, is_smallest = false;
  std::vector<Measured> points{};
};

// How long a run may take [s], how often a short one is timed, and the error that is small enough.
struct Pace {
  double limit = 20;
  int repeats = 5;
  double finest_error = 1e-8;
};

// Gives the point of that name, which may be known already, or takes it.
using Recall =
    std::function<Measured(const std::string& name, const std::function<Measured()>& take)>;

// Runs a peer over its values, until its error is small enough or no longer falls, or a run is over
// budget. Fixed steps, ours and theirs, are denser near their stability limit (see ladder.hpp).
PeerLadder measure_ladder(Peer& peer, ForceKind force, const Problem& problem, const Pace& pace,
                          const Recall& recall);

// A peer and the method of ours that takes the same steps, each over the run at one step size.
struct SameSteps {
  std::string solver, method;
  bool is_smallest = false;  // ours on the scene's smallest system, else with pins alone left out
  Index unknowns = 0;        // of ours
  std::int64_t springs = 0;  // as drawn, those between two pinned nodes left out
  double step_size = 0;      // [s]
  std::int64_t steps = 0;
  Outcome peer_outcome{}, outcome{};
  // The least time of a step of several runs [s]; ours with what begins a run, some microseconds.
  double peer_step = 0, step = 0;
  // The largest distance [m] between a node's two positions at the end, and the position error (see
  // Errors) of either if the other were right.
  double distance = 0, difference = 0;

  bool is_good() const {
    return peer_outcome == Outcome::reached_end && outcome == Outcome::reached_end;
  }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SameSteps, solver, method, is_smallest, unknowns, springs,
                                   step_size, steps, peer_outcome, outcome, peer_step, step,
                                   distance, difference)

// Runs both by turns, each `repeats` times, at h w = 1/2 of the fastest vibration at the start. The
// peer must have a twin; a run takes at most `limit` seconds.
SameSteps same_steps(Peer& peer, bool smallest, const Problem& problem, int repeats, double limit);

}  // namespace qddot::bench
