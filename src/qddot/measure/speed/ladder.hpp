#pragma once

#include <optional>
#include <vector>

namespace qddot::inline measure {

// A run of `steps` equal steps and its relative error, infinite if it failed.
struct Rung {
  double steps = 0, error = 0;

  bool is_good() const { return error < 1; }
};

// The largest step that a ladder finds good is at least this fraction of a step that is not good.
constexpr double nearest_to_limit = 0.98;

// The next number of steps to add to a ladder (from coarse to fine) near the limit of its steps;
// empty if none is missing. A limit is between a rung that is not good and the next one, or where
// the error falls faster than any order explains. Rungs are densest at the limit and grow sparser
// below it, up to the ladder's own spacing. If even the coarsest rung is good, there is no limit
// and nothing to add.
std::optional<double> lacking_rung(const std::vector<Rung>& ladder);

}  // namespace qddot::inline measure
