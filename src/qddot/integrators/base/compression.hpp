#pragma once

#include <algorithm>

namespace qddot {

// The share of the sideways push of compressed springs (CountedSystem::weighted_stiffness) with
// which a matrix M - s K is still positive definite. It is all if that works, else a half, a
// quarter, ... down to a 64th, or none.
class Compression {
 public:
  void start() { kept_ = 1; }
  double kept() const { return kept_; }
  // Doubles the share for the next search.
  void harden() { kept_ = std::clamp(2 * kept_, least, 1.0); }
  // Halves the share; false if it is 0 already.
  bool soften() {
    if (kept_ == 0) return false;
    kept_ = kept_ > least ? kept_ / 2 : 0;
    return true;
  }
  // Lowers the share until works(share) is true; false if it is false even for 0.
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
