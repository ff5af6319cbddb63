#pragma once

#include "qddot/model/capabilities.hpp"

namespace qddot {

// A capability (see capabilities.hpp): the system knows where its force jumps, which is where
// certain lengths change their sign. On a line a spring of rest length l0 > 0 that passes through
// length zero turns its force of k l0 over. A system without this has a continuous force.
class Kinks {
 public:
  virtual ~Kinks() = default;
  // How many such lengths there are.
  virtual Index kinks() const = 0;
  // These lengths, with their signs [m], into `lengths`, sized by the caller: affine functions of
  // q.
  virtual void kink_lengths(const ConstVec& q, MutableVec lengths) const = 0;
};

}  // namespace qddot
