#include "qddot/scene/reduce/as_drawn.hpp"

#include "qddot/scene/reduce/drawn_part.hpp"

namespace qddot::reduce {
namespace {

// The error of a product below the smallest normal number is at most this; a term of a sum has some
// products.
constexpr double underflow = 8 * 0x1p-1074;

}  // namespace

Tolerances tolerances_of(double farthest, double fastest) {
  constexpr double several = 8;
  return {several * rounding * farthest, several * rounding * fastest};
}

BoundedEnergy DrawnPotential::sum() const {
  BoundedEnergy sum = sum_;
  sum.error += (rounding + static_cast<double>(terms_) * eps) * sizes_ + underflow * underflows_;
  return sum;
}

BoundedEnergy DrawnKinetic::sum() const {
  BoundedEnergy sum = sum_;
  sum.error +=
      (rounding + static_cast<double>(terms_) * 0x1p-52) * sum.value + underflow * underflows_;
  return sum;
}

}  // namespace qddot::reduce
