#pragma once

#include <vector>

#include "qddot/measure/reference/reference.hpp"

namespace qddot::inline measure {

// The motion of a reference at some times before its end.
struct ReferencePath {
  std::vector<State> states;
  // A bound of the position error of each, divided by the reference's scales: twice the largest
  // difference so far to the motion by half the steps and, at the end, what the reference
  // certifies.
  std::vector<double> certified;
};

// The motion of a reference that make_reference() made of the scene, at `times` [s], ascending from
// 0 to its end. It takes about as long as the reference took. Throws NoReference if that takes more
// than `seconds`.
ReferencePath path_of(const Model& scene, const Reference& reference,
                      const std::vector<double>& times, double seconds);

}  // namespace qddot::inline measure
