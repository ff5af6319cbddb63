#pragma once

#include "qddot/integrators/integrator.hpp"

namespace qddot::sundials {

// The orders that a method of variable order used.
class Orders {
 public:
  // Takes the order of each accepted step.
  void note(int order) {
    sum_ += order;
    reductions_ += order < last_;
    last_ = order;
  }
  void into(Counts& counts) const {
    counts.order_sum = sum_;
    counts.order_reductions = reductions_;
  }

 private:
  std::int64_t sum_ = 0, reductions_ = 0;
  int last_ = 0;
};

}  // namespace qddot::sundials
