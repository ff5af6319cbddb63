#pragma once

#include <algorithm>

namespace qddot {

// How much of the push that compressed springs give to the side a matrix M - s K may keep
// (Integrator::weighted_stiffness) and still be positive definite: all of it where that works, else
// a half, a quarter, ... down to a 64th, or none.
class Compression {
 public:
  void start() { kept_ = 1; }
  double kept() const { return kept_; }
  // Twice as much, to begin the next search with.
  void harden() { kept_ = std::clamp(2 * kept_, least, 1.0); }
  // Half as much; false where none is kept already.
  bool soften() {
    if (kept_ == 0) return false;
    kept_ = kept_ > least ? kept_ / 2 : 0;
    return true;
  }
  // Finds the most, from what is kept now, for which works(kept); false where none of it is still
  // too much.
  template <class Works>
  bool find(const Works& works) {
    while (!works(kept_)) {
      if (!soften()) return false;
    }
    return true;
  }

 private:
  static constexpr double least = 1.0 / 64;
  double kept_ = 1;
};

}  // namespace qddot
