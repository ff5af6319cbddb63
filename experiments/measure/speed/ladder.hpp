#pragma once

#include <optional>
#include <vector>

namespace qddot::measure {

// A run of so many equal steps and the error that it leaves, infinite where it failed.
struct Rung {
  double steps = 0, error = 0;

  bool is_good() const { return error < 1; }
};

// The largest step that a ladder finds good is at least this part of one that is not.
constexpr double nearest_to_limit = 0.98;

// The number of steps that a ladder, from coarse to fine, lacks near the limit of its steps;
// nothing where it lacks none. A limit is between a rung that is not good and the next one, and
// where an error falls as no order makes it fall. Below it steps are nearly as dense as at it, and
// the less so the farther from it, up to what the ladder has by itself. Without a limit, where even
// the coarsest rung is good, none is lacking.
std::optional<double> lacking_rung(const std::vector<Rung>& ladder);

}  // namespace qddot::measure
