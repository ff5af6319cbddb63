#pragma once

#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/reduce/reductions.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

class Part;

// A system, its start, and the way back from its unknowns to all nodes. It implements ReducedScene,
// which documents these functions.
class WayBack {
 public:
  virtual ~WayBack() = default;

  virtual const System& system() const = 0;
  virtual const State& initial() const = 0;
  virtual int dimension() const = 0;
  // Does ReducedScene::expand if `falls`, else expand_beside_falls. `nodes`: empty, or the result
  // of an earlier call.
  virtual void expand(const State& state, bool falls, std::vector<Node>& nodes) const = 0;
  virtual double kinetic(const State& state) const = 0;
  virtual double potential(const State& state) const = 0;
  virtual double energy(const State& state) const = 0;
  virtual std::vector<std::size_t> massless_nodes() const = 0;
  virtual std::vector<std::vector<std::size_t>> nodes_by_part() const = 0;
  virtual std::vector<Index> unknowns_by_part() const = 0;
  virtual const std::vector<Finding>& findings() const = 0;
  virtual const std::vector<Part>& parts() const = 0;
};

}  // namespace qddot::reduce
