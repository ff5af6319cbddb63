#include "qddot/measure/motion/breaks.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace qddot::inline measure {

std::string unclear_order(const std::vector<Break>& breaks, const std::vector<double>& errors,
                          const std::vector<std::size_t>& springs) {
  for (std::size_t k = 1; k < breaks.size(); ++k) {
    const double apart = breaks[k].t - breaks[k - 1].t;
    if (apart <= rounding_of_moment(breaks[k].t)) continue;
    if (apart > errors[k] + errors[k - 1]) continue;
    return fmt::format(
        "springs {} and {} break within {:.1e} s at t = {:.6g} s, and their times have errors of "
        "up to {:.1e} s, so that which was first is not known",
        springs[static_cast<std::size_t>(breaks[k - 1].number)],
        springs[static_cast<std::size_t>(breaks[k].number)], apart, breaks[k].t,
        std::max(errors[k], errors[k - 1]));
  }
  return {};
}

}  // namespace qddot::inline measure
