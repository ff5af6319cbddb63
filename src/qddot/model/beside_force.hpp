#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// Work on vectors that is done beside a force, part by part, while the part is in a near cache.
// Both functions are called once for each of some ranges [first, end) of unknowns, which together
// are all n. Several threads may call them for ranges that do not overlap.
class BesideForce {
 public:
  virtual ~BesideForce() = default;
  // Before q of these unknowns is read: may write it.
  virtual void before(Index first, Index end) = 0;
  // After f of these unknowns is written. Returns a number that is summed over all ranges.
  virtual double after(Index first, Index end) = 0;
};

}  // namespace qddot
