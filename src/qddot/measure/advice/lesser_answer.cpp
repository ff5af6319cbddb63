#include "qddot/measure/advice/lesser_answer.hpp"

#include <fmt/format.h>

#include "qddot/measure/advice/solve_linear.hpp"
#include "qddot/measure/advice/solve_with_rods.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::inline measure {

std::string LesserAnswer::in_words() const {
  if (by == Reduction::linear)
    return fmt::format(
        "left out: the motion is linear here, a sum of natural modes; that changes positions by at "
        "most {:.1e} of the motion, as the forces that are left out say",
        change);
  if (has_vibration)
    return fmt::format(
        "left out: {} stiff springs are rods here, and a vibration that damping ends; that changes "
        "positions at the end by at most {:.1e} of the motion, as runs from the springs' say",
        rods, change);
  return fmt::format(
      "left out: {} stiff springs are rods here; that changes positions by at most {:.1e} of the "
      "motion, as a run in which they stretch says",
      rods, change);
}

std::optional<LesserAnswer> solve_with_less(const Scene& start, const Reductions& reductions,
                                            double until, const Wanted& wanted) {
  const auto begin = clock_now();
  if (auto linear = solve_linear(start, reductions, until, wanted)) return linear;
  Wanted rest = wanted;
  rest.seconds -= seconds_since(begin);
  return solve_with_rods(start, reductions, until, rest);
}

}  // namespace qddot::inline measure
