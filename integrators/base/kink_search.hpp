#pragma once

#include <optional>

#include "qddot/model/kinks.hpp"

namespace qddot {

// Where between two states a force jumps (see Kinks). No error estimate of a formula sees that
// everywhere: where it is passed before all stages but the first, or after the last one, the
// weights of the two formulas may agree.
class KinkSearch {
 public:
  // Without kinks the system costs nothing.
  explicit KinkSearch(const System& system);
  bool has_kinks() const { return length_[0].size() > 0; }

  // A length changes its sign.
  struct Change {
    double part = 1;         // of the time from a to b after which the first one does, 0 to 1
    bool is_at_end = false;  // whether one of those that do is zero at b
    double speed = 0;        // of the first one at a [m/s]
  };
  // By the cubic polynomials through both states. A length of zero at a changes at once if it is
  // not zero at b.
  std::optional<Change> first(const State& a, const State& b);

 private:
  const Kinks* kinks_;
  Vec length_[2], rate_[2], place_;
};

}  // namespace qddot
