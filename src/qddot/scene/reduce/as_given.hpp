#pragma once

#include <memory>

#include "qddot/scene/reduce/part.hpp"
#include "qddot/scene/reduce/way_back.hpp"

namespace qddot::reduce {

// A caller's own system, of which nothing is left out. Node i has the unknowns dimension i to
// dimension (i + 1) - 1, none is pinned, and all energy is the system's.
class AsGiven final : public WayBack {
 public:
  // Throws std::invalid_argument, in a sentence, if the dimension or the sizes are not allowed.
  AsGiven(std::shared_ptr<const System> system, State initial, int dimension);

  const System& system() const override { return *system_; }
  const State& initial() const override { return initial_; }
  int dimension() const override { return dimension_; }
  void expand(const State& state, bool falls, std::vector<Node>& nodes) const override;
  double kinetic(const State& state) const override { return system_->kinetic(state.v); }
  double potential(const State& state) const override { return system_->potential(state.q); }
  double energy(const State& state) const override { return total_energy(*system_, state); }
  std::vector<std::size_t> massless_nodes() const override;
  std::vector<std::vector<std::size_t>> nodes_by_part() const override;
  std::vector<Index> unknowns_by_part() const override { return {system_->size()}; }
  const std::vector<Finding>& findings() const override { return findings_; }
  const std::vector<Part>& parts() const override { return parts_; }

 private:
  std::shared_ptr<const System> system_;
  State initial_;
  int dimension_;
  std::vector<Finding> findings_;  // none
  std::vector<Part> parts_;        // none
};

}  // namespace qddot::reduce
