#pragma once

#include <optional>

#include "qddot/model/capabilities.hpp"

namespace qddot {

// Finds jumps of the force between two states (see Kinks). Error estimates do not always see them:
// if a jump is before all stages but the first, or after the last one, both formulas may agree.
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
  };
  // The first change on the cubic polynomials through both states. A length of zero at a changes at
  // once if it is not zero at b.
  std::optional<Change> first(const State& a, const State& b);

 private:
  const Kinks* kinks_;
  Vec length_[2], rate_[2], place_;
};

}  // namespace qddot
