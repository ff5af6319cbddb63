#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>

#include "qddot/measure/reference/reference_ways.hpp"

namespace qddot::measure {

constexpr int most_refinements = 20;
constexpr int most_lost_levels = 3;

// Refines a way of solving until rounding is all that is left: the changes no longer shrink, and
// `is_rounding(finest, change)` says that they need not. Changes that do not shrink before are
// those of steps too coarse for the expansion of the error in their powers, and of a chaotic
// motion they may be as large as the motion for some levels; refinement goes on, until time is up.
// `solve(level)` returns nothing where it did not reach the end. Throws NoReference if none does.
//
// `change` of the result bounds the change that is still to come: where rounding ends it, the
// larger of the last two; where time does, the last one times min(1, 2 r), r the ratio of the last
// two, as changes that shrink by r <= 1/2 each time add up to r / (1 - r) <= 2 r of the last.
template <class Solve, class IsRounding>
Solution refined(const ReducedScene& scene, double seconds, const Solve& solve,
                 const IsRounding& is_rounding) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<Solution> best;
  Errors last;                                              // change
  double before = std::numeric_limits<double>::infinity();  // the worse of the last change
  double share = 1;
  for (int level = 0; level < most_refinements; ++level) {
    const auto begin = std::chrono::steady_clock::now();
    std::optional<Solution> next = solve(level);
    if (next && best) {
      const Errors change =
          errors_between(scene, next->end, best->end, scene.energy(best->end), next->scales);
      const double now = worse(change);
      const bool is_lost = !(now < apart) && level < most_lost_levels;
      if (now > before / 2 && !is_lost && is_rounding(*best, now)) {
        best->change = larger(last, change);
        return *best;
      }
      share = before > 0 ? std::min(1.0, 2 * now / before) : 1;
      last = change;
      before = now;
    }
    if (next) best = std::move(next);
    if (before == 0 || seconds_since(start) + 2 * seconds_since(begin) > seconds) break;
  }
  if (!best) throw NoReference("no reference: the high-accuracy methods did not reach the end");
  best->change = {share * last.position, share * last.velocity, share * last.energy};
  return *best;
}

}  // namespace qddot::measure
