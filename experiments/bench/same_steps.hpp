#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "experiments/bench/peer.hpp"

namespace qddot::bench {

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
