#pragma once

#include <array>
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

// A pinned node that moves: by its curve from where it is at the start.
struct Moving {
  std::size_t node;
  TimeCurve curve;
};

// A spring between two pinned nodes, of which one moves at least.
struct DrivenSpring {
  std::array<std::size_t, 2> ends;
  SpringLaw law;

  // Its energy at t [J].
  double energy(const std::vector<Node>& nodes, const std::vector<TimeCurve>& curves,
                double t) const {
    const auto place = [&](std::size_t i) -> Eigen::Vector3d {
      const int curve = nodes[i].curve;
      if (curve < 0) return nodes[i].position;
      return nodes[i].position + curves[static_cast<std::size_t>(curve)].at(t);
    };
    return law.energy((place(ends[1]) - place(ends[0])).norm());
  }
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
  std::vector<Moving> moving{};
  std::vector<DrivenSpring> driven_springs{};
  // The scene's numbers of the springs that are not plain, by the numbers of their phases.
  std::vector<std::size_t> general{};
  // The scene's numbers of the rods, in the order of parts and of their constraints; and the share
  // of each in the multiplier of a constraint of the system.
  std::vector<std::size_t> rods{};
  std::vector<RodShare> shares{};
  Index constraints = 0;
  std::vector<TimeCurve> curves{};  // of the scene
  std::shared_ptr<const System> system{};
  // [J], of springs between pinned nodes that rest, and of the parts' origins.
  double static_energy = 0;
  State initial{};
  std::vector<Finding> findings{};
};

// The pieces of a scene after all of `reductions` that leave each part's start as drawn. Throws
// std::logic_error, in a sentence, if none of them does.
Pieces pieces_of(const Scene& scene, const Reductions& reductions);
// The pieces of a caller's own system; errors as in Model.
Pieces pieces_of(std::shared_ptr<const System> system, State initial, int dimension);

}  // namespace qddot::reduce
