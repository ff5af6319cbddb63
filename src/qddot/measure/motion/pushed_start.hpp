#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "qddot/measure/motion/error.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {

// The push of a start away from what was drawn.
struct Push {
  // Different seeds push in different directions.
  std::uint32_t seed = 1;
  // The mean change of each number, in roundings of the largest one.
  double roundings = 1;
};

// Moves numbers up or down at random by 3/4 to 5/4 of the push, in roundings of a size. Less might
// be rounded to no move at all. Equal moves might all be at right angles to the direction in which
// errors grow.
class Shift {
 public:
  explicit Shift(const Push& push) : by_(push.roundings * machine_epsilon), random_(push.seed) {}
  void operator()(double& number, double size) {
    const double part = part_(random_);
    number += (std::copysign(0.75, part) + part / 2) * by_ * size;
  }

 private:
  double by_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> part_{-1, 1};
};

// The start with each unknown pushed (see Shift): positions by roundings of the extent or
// displacement of their part, the larger of both, and velocities by those of its speed.
State pushed_start(const Model& model, const Scales& scales, const Push& push = {});

// The scene with all that was drawn pushed likewise: its nodes, pinned ones by their own
// coordinates, and rest lengths that are longer than all of these. So forces change as by rounding.
Scene pushed_scene(const Scene& drawn, const Scales& scales, const Push& push = {});

}  // namespace qddot::inline measure
