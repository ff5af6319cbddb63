#pragma once

#include <memory>
#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/reduce/part.hpp"
#include "qddot/scene/reduce/reductions.hpp"
#include "qddot/scene/reduce/series.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::reduce {

// A node that moves in closed form, x = x0 + D(t) with a = g + load/m. It is on no spring, or in a
// part that rests in its falling frame.
struct Flying : Flight {
  std::size_t node;
};

// The pieces that a Model consists of: a system with its start, and what leads from the unknowns
// back to all nodes and energies.
struct Pieces {
  bool is_own = false;        // of a caller's own system, which has no part
  std::vector<Node> nodes{};  // as drawn, with condensed ones at their places
  int dimension = 0;
  std::vector<Series> series{};
  std::vector<Flying> flying{};
  std::vector<Part> parts{};
  std::shared_ptr<const System> system{};
  double static_energy = 0;  // [J], of springs between pinned nodes, and of the parts' origins
  State initial{};
  std::vector<Finding> findings{};
};

// The pieces of a scene after all of `reductions` that leave each part's start as drawn. Throws
// std::logic_error, in a sentence, if none of them does.
Pieces pieces_of(const Scene& scene, const Reductions& reductions);
// The pieces of a caller's own system; errors as in Model.
Pieces pieces_of(std::shared_ptr<const System> system, State initial, int dimension);

}  // namespace qddot::reduce
