#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/bench/peer_ladder.hpp"

namespace qddot::bench {

// How many times as long as ours a peer takes to an accuracy.
struct Ratio {
  double accuracy = 0;
  std::string peer, force;
  // The peer's fastest point of at most that error. nullptr if its runs were over budget before;
  // `ratio` is then a lower bound.
  const Measured* theirs = nullptr;
  const Measured* ours = nullptr;  // our fastest of no larger error than theirs (or than accuracy)
  bool is_bound = false;
  double ratio = 0;  // of the times

  bool is_known() const { return ours != nullptr; }
};

// The fastest good point of at most that error, of the ladders that `counts`; nullptr if none.
const Measured* fastest(const std::vector<PeerLadder>& ladders, double error,
                        const std::function<bool(const PeerLadder&)>& counts);

// A ratio for each ladder of a peer at each accuracy. Our methods run with all reductions
// (`smallest`) or with pins alone. There is one more ratio for each f: that of the fastest stock
// implicit peer. Points are borrowed from the ladders.
std::vector<Ratio> ratios(const std::vector<PeerLadder>& ladders, bool smallest,
                          const std::vector<double>& accuracies);

}  // namespace qddot::bench
