#include "qddot/measure/advice/break_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qddot::inline measure {
namespace {

double time_of(const Trial& trial, Index number) {
  const auto& breaks = trial.summary.breaks;
  const auto found = std::ranges::find(breaks, number, &Break::number);
  return found == breaks.end() ? std::numeric_limits<double>::infinity() : found->t;
}

}  // namespace

std::vector<double> break_errors(const Search& search, const Trial& trial) {
  std::vector<const Trial*> others;
  if (const auto bound = search.check().bound(trial); bound && bound->by)
    others.push_back(bound->by);
  if (const Trial* judge = search.check().judge(); judge && judge != &trial)
    others.push_back(judge);
  // Starts that are one rounding away tell what rounding does.
  for (const Trial& run : search.runs().all()) {
    if (run.is_pushed && run.reached_end() && broken_springs(run) == broken_springs(trial))
      others.push_back(&run);
  }
  // One number of two runs is often the same by chance, more so than all places of a motion: of 156
  // moments of random scenes, 5 were beyond twice the difference, and 4 of these within ten times.
  const double doubt = search.runs().rules().doubt / search.runs().rules().small;
  std::vector<double> errors;
  for (const Break& one : trial.summary.breaks) {
    double apart = others.empty() ? std::numeric_limits<double>::infinity() : 0;
    for (const Trial* other : others)
      apart = std::max(apart, std::abs(time_of(*other, one.number) - one.t));
    errors.push_back(doubt * apart + rounding_of_moment(one.t));
  }
  return errors;
}

}  // namespace qddot::inline measure
