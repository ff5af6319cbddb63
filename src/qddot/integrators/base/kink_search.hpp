#pragma once

#include <optional>

#include "qddot/integrators/base/hermite.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {

// Finds jumps of the force between two instants (see Kinks). Error estimates do not always see
// them: if a jump is before all stages but the first, or after the last one, both formulas may
// agree. Between two stages a length may pass through zero and return, as the force would be
// without a jump: a mass that passes slowly is turned back by springs in compression.
class KinkSearch {
 public:
  // A system without kinks costs nothing.
  explicit KinkSearch(const System& system);
  bool has_kinks() const { return length_[0].size() > 0; }

  // A change of sign of a length.
  struct Change {
    double part = 1;         // of the time from a to b until the first change, 0 to 1
    bool is_at_end = false;  // whether a length that changes is zero at b
    double speed = 0;        // of the first length to change, at a [m/s]
    // False if all signs at b are those at a, but a length may be zero between. Then `part` is
    // where it is least, and `nearest` [m] is how far it may be from zero there.
    bool is_certain = true;
    double nearest = 0;
  };
  // The first change on the way from a to b, on the cubic polynomials through both states. A length
  // of zero at a changes at once if it is not zero at b.
  //
  // A length that has the same sign at both keeps it for certain if
  //   p(s) - c s^2 (1 - s)^2 > 0,  0 <= s <= 1
  // for its size, with p the quintic polynomial of both lengths, rates and accelerations and c the
  // largest factor that makes up the difference between p and the cubic one. That difference
  // is h^4 l''''/24 s^2 (1 - s)^2 to leading order; the error of p is less up to h w = 10.
  std::optional<Change> first(const Instant& a, const Instant& b);

  // The least way [m] that a length which has changed its sign from a to b would have gone beyond
  // zero without the jump: v^2/(2 a) if its acceleration a points back. It is infinite if the
  // accelerations at a and b do not drive the length away from zero on either side: then the force
  // jumps, but the way is the same for all lengths near zero.
  double depth(const Instant& a, const Instant& b);

 private:
  // Writes the lengths, their rates and accelerations at both instants.
  void look(const Instant& a, const Instant& b);

  const Kinks* kinks_;
  bool moves_by_itself_;  // whether lengths depend on time beside q
  Vec length_[2], rate_[2], acceleration_[2], place_, ahead_, behind_;
};

}  // namespace qddot
