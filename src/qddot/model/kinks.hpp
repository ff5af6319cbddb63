#pragma once

#include "qddot/model/capabilities.hpp"

namespace qddot {

// A capability (see capabilities.hpp): the force jumps where certain lengths change sign, and the
// system gives these lengths. Example: a spring of rest length l0 > 0 on a line reverses its force
// k l0 when its length passes through zero. A system without this has a continuous force.
class Kinks {
 public:
  virtual ~Kinks() = default;
  // The number of such lengths.
  virtual Index kinks() const = 0;
  // Writes these signed lengths [m] at q (n) into `lengths`, sized by the caller. They are affine
  // in q.
  virtual void kink_lengths(const ConstVec& q, MutableVec lengths) const = 0;
};

}  // namespace qddot
