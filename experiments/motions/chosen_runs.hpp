#pragma once

#include <string>
#include <vector>

#include "qddot/measure/speed/front.hpp"

namespace qddot::motions {

// A run whose motion is worth keeping, and what it shows.
struct ChosenRun {
  const Point* point = nullptr;
  std::string why;  // for people: "fastest at 1e-4", "coarsest run", "diverged"
};

// All points that can be shown, the most telling first:
// - the fastest at each accuracy,
// - the fastest of the other family there,
// - the coarsest run of each method and its first failure,
// - the others in their order.
// Runs that took too long are left out. `front`: the result of fastest_at_each_accuracy for the
// points. Pointers into `points`.
std::vector<ChosenRun> chosen_runs(const std::vector<Point>& points,
                                   const std::vector<FrontRow>& front);

}  // namespace qddot::motions
