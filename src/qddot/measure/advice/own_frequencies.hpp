#pragma once

#include <array>
#include <vector>

#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// The frequencies at which a motion itself changes, whatever the natural frequencies of its system.
// The error of a method of order p comes from derivatives of the motion: a vibration of amplitude a
// adds a w^p along its way a w dt. The frequency for order p is
//   w_p = (|q^(p+1)| / |q'|)^(1/p)   [rad/s],
// where norms are root mean squares over time and unknowns. All w_p of a slow motion are far below
// w_max. If the motion has fast vibrations of small amplitude, w_p grows with p.
struct OwnFrequencies {
  static constexpr int highest_order = 10;
  static constexpr int forces_a_burst = highest_order + 2;

  std::array<double, highest_order + 1> of_order{};  // w_1 ... w_10; of_order[0] means nothing
  double speed = 0;  // |q'| over the largest |q - q(0)| [1/s]; 0 if nothing moves

  // w_p for the order, rounded up to an even one, and for 10 at most.
  double at(int order) const;
};

// Estimates the frequencies from `bursts` short bursts of Verlet's method, each of twelve steps at
// h w_max = 1/2. They begin at the start and at some states of `path`; p-th differences of
// positions give the derivatives. `w_max`: the largest frequency [rad/s].
OwnFrequencies own_frequencies(const Model& model, const std::vector<State>& path, double w_max,
                               int bursts);

}  // namespace qddot::inline measure
