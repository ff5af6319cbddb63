#pragma once

#include <array>
#include <vector>

#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::measure {

// The frequencies that a motion has itself, whatever its system could vibrate with. Errors of a
// method of order p come from derivatives of the motion: on a sum of vibrations a w^p is added up
// along the way, a w dt. So what counts at order p is
//   w_p = (|q^(p+1)| / |q'|)^(1/p)   [rad/s],
// norms being root mean squares over time and unknowns. A slow motion has all w_p far below w_max;
// where fast vibrations of small amplitude are in it, w_p grows with p.
struct OwnFrequencies {
  static constexpr int highest_order = 10;

  std::array<double, highest_order + 1> of_order{};  // w_1 ... w_10; of_order[0] means nothing
  double speed = 0;  // |q'| over the largest |q - q(0)| [1/s]; 0 where nothing moves

  // w_p of the next order for which it is known.
  double at(int order) const;
};

// Estimates them from short bursts of Verlet's method, twelve steps of h w_max = 1/2 each, that
// begin at the start and at some of the states of `path`, `bursts` of them in all: p-th differences
// are derivatives. Costs twelve forces a burst. `w_max`: the largest frequency [rad/s].
OwnFrequencies own_frequencies(const ReducedScene& model, const std::vector<State>& path,
                               double w_max, int bursts);

}  // namespace qddot::measure
