#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/bench/peer.hpp"

namespace qddot::bench {

// The names of our explicit methods that any scene can have, those of high order first.
std::vector<std::string> explicit_methods();

// Which peers are missing, and why.
class LeftOut {
 public:
  // Keeps the sentence and prints it.
  void add(const std::string& sentence);
  const std::vector<std::string>& sentences() const { return sentences_; }

 private:
  std::vector<std::string> sentences_;
};

// The installed peers whose names begin with one of `beginnings`, or all installed ones if there is
// none. `force_library`: see scipy().
std::vector<std::unique_ptr<Peer>> selected_peers(const std::vector<std::string>& beginnings,
                                                  const std::string& force_library,
                                                  LeftOut& left_out);

// Those that can do all that is in the scene. Borrows them.
std::vector<Peer*> fitting(const std::vector<std::unique_ptr<Peer>>& peers, const Scene& scene,
                           LeftOut& left_out);

}  // namespace qddot::bench
