#pragma once

#include <string>
#include <vector>

#include "experiments/measurement.hpp"

namespace qddot {

// The answer at one accuracy: the fastest point whose error (see judgement.hpp) is known to be at
// most that, whatever the reference's own error is: the measured one and what is certified
// together; and the fastest of each family. nullptr where there is none.
struct FrontRow {
  double accuracy = 0;
  bool may_be_reached = false;  // by a point of which it is not known
  const Point* fastest = nullptr;
  const Point* fastest_hand_written = nullptr;
  const Point* fastest_sundials = nullptr;
};

// Rows for the accuracies 1e-1, 1e-2, ... 1e-9; pointers into `points`.
std::vector<FrontRow> fastest_at_each_accuracy(const std::vector<Point>& points,
                                               const Reference& reference);

// Prints the rows as a table for people.
void print_front(const std::string& scene, double until, const std::vector<FrontRow>& front,
                 const Reference& reference);

}  // namespace qddot
