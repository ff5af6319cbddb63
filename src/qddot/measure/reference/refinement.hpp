#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference_ways.hpp"

namespace qddot::inline measure {

constexpr int most_refinements = 20;
constexpr int most_lost_levels = 3;

// Refines a solution until only rounding is left: the changes no longer shrink, and
// `is_rounding(finest, change)` says that they need not. Changes may fail to shrink before that, if
// steps are too coarse for the error to fall by an order. They may be as large as the motion for
// some levels, if it is chaotic. Refinement then goes on until time is up. `solve(level)` returns
// an empty value if it did not reach the end. Throws NoReference if no level does.
//
// `change` of the result bounds the change that further refinement would make. If rounding ends the
// refinement, it is the larger of the last two changes. If time ends it, it is the last change
// times min(1, 2 r), with r the ratio of the last two. The reason: changes that shrink by r <= 1/2
// each time add up to r / (1 - r) <= 2 r of the last.
template <class Solve, class IsRounding>
Solution refined(const Model& scene, double seconds, const Solve& solve,
                 const IsRounding& is_rounding) {
  const auto start = clock_now();
  std::optional<Solution> best;
  Errors last = no_error;                                   // change
  double before = std::numeric_limits<double>::infinity();  // the larger part of the last change
  double share = 1;
  for (int level = 0; level < most_refinements; ++level) {
    const auto begin = clock_now();
    std::optional<Solution> next = solve(level);
    if (next && best) {
      const Errors change =
          errors_between(scene, next->end, best->end, scene.energy(best->end), next->scales);
      const double now = worse(change);
      const bool is_lost = !(now < far_apart) && level < most_lost_levels;
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
  if (!best) {
    const bool needs_time = seconds_since(start) >= seconds;
    throw NoReference(std::string("no reference: the high-accuracy methods did not reach the end") +
                          (needs_time ? " in time: ask for an earlier end (--until)" : ""),
                      needs_time);
  }
  best->change = {share * last.position, share * last.velocity, share * last.energy};
  return *best;
}

}  // namespace qddot::inline measure
