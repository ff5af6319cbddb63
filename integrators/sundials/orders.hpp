#pragma once

#include "qddot/integrators/counts.hpp"

namespace qddot::sundials {

// The orders that a method of variable order used.
class Orders {
 public:
  // Counts the order of each accepted step.
  void note(int order, Counts& counts) {
    counts.order_sum += order;
    counts.order_reductions += order < last_;
    last_ = order;
  }

 private:
  int last_ = 0;
};

}  // namespace qddot::sundials
