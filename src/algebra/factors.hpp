#pragma once

#include "src/model/system.hpp"

namespace qddot {

// Signs of a factorised symmetric matrix. `indefinite` can still be solved with; `singular` cannot.
enum class Definiteness { positive, indefinite, singular };

// A way to factorise a D - s K, D diagonal and K of a pattern that is analysed once, and to solve
// with it. Functions as those of EffectiveMass.
class Factors {
 public:
  virtual ~Factors() = default;
  virtual Definiteness factorize(double a, double s, const SymmetricMatrix& k) = 0;
  virtual bool factorize_positive(double a, double s, const SymmetricMatrix& k) = 0;
  virtual Index negative_pivots() const = 0;
  virtual void solve(const Vec& b, Vec& x) = 0;
};

}  // namespace qddot
