#pragma once

#include <memory>

#include "src/model/system.hpp"
#include "src/scene/scene.hpp"

namespace qddot {

// The smallest System that moves exactly as a scene does, and the way back to all its nodes.
// Left out: pinned nodes (q_full = P q + c with P the rows of the free nodes), and with them the
// springs between two of them, which only add a constant to V.
class ReducedScene {
 public:
  // The scene must be valid (see validate).
  explicit ReducedScene(const Scene& scene);

  const System& system() const { return *system_; }
  // The scene's own positions and velocities at t = 0.
  const State& initial() const { return initial_; }
  int dimension() const { return dimension_; }

  // Positions [m] and velocities [m/s] of all nodes of the scene in `state`; pinned ones rest.
  std::vector<Node> expand(const State& state) const;

 private:
  std::vector<Node> nodes_;
  int dimension_;
  std::vector<std::size_t> free_;  // the scene's index of each free node
  std::unique_ptr<System> system_;
  State initial_;
};

}  // namespace qddot
