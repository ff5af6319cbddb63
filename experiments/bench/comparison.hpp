#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/bench/peer_ladder.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"

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

// A ratio for each ladder of a peer at each accuracy wanted. Our methods run with all reductions
// (`smallest`) or with pins alone. There is one more ratio for each f: that of the fastest stock
// implicit peer. Points are borrowed from the ladders.
std::vector<Ratio> ratios(const std::vector<PeerLadder>& ladders, bool smallest,
                          const std::vector<double>& wanted);

// The accuracies at which peers and our methods are compared.
inline const std::vector<double> accuracies = {1e-4, 1e-5, 1e-6, 1e-7, 1e-8};

// A scene with its end time, and our methods beside the peers on it.
struct Comparison {
  // `word`: a generator's name or a scene file, with @T behind it for another end time T [s].
  // Throws InvalidInput if there is no such scene, or no end time.
  explicit Comparison(const std::string& word);

  // Measures the ladders of our methods on both systems and of the peers, and then each peer beside
  // the method that takes the same steps. Each point is a piece of the study; results are added as
  // they come. Keeps the reference in
  // `folder` with `origin`. Throws Interrupted, InvalidInput and NoReference.
  void measure(const std::vector<std::string>& methods, const std::vector<Peer*>& peers,
               const Pace& pace, Study& study, const std::string& folder,
               const nlohmann::json& origin);

  SceneChoice choice;
  Scene drawn;
  double until;  // [s]
  std::vector<PeerLadder> ladders{};
  std::vector<SameSteps> same_steps{};
  bool is_complete = false;
  // Unknowns of the system that peers get, and of the smallest one.
  Index unknowns = 0, fewest_unknowns = 0;
};

}  // namespace qddot::bench
