#include "qddot/measure/speed/ladder.hpp"

#include <algorithm>
#include <cmath>

namespace qddot::inline measure {
namespace {

// The error falls by 4 from rung to rung if it follows the order, or by 6 with an order of 8 and
// ten rungs a decade. A fall by more than this factor is not due to the order.
constexpr double steepest_fall = 40;
// A ladder is refined up to this many times the steps of the limit. A run beyond the limit that
// reaches its end by chance is nearer to it: at twice the limit, vibrations grow by more than 10 in
// a step.
constexpr double farthest = 8;
// The ratio of two rungs at the limit, and its growth below. The cheapest step for an accuracy is
// missed by at most that ratio. It is a few percent at the limit, an eighth at half of it and a
// third at an eighth of it.
constexpr double closest_ratio = 1.04, widening = 0.125;

// The first rung after the coarse one that allows a ratio of at most `allowed` with the fewest
// rungs.
double first_between(const Rung& coarse, const Rung& fine, double allowed) {
  const double ratio = fine.steps / coarse.steps;
  const double parts = std::ceil(std::log(ratio) / std::log(allowed));
  return std::max(coarse.steps + 1, std::round(coarse.steps * std::pow(ratio, 1 / parts)));
}

}  // namespace

std::optional<double> lacking_rung(const std::vector<Rung>& ladder) {
  double limit = 0, first_good = 0;  // in steps
  for (std::size_t i = 1; i < ladder.size(); ++i) {
    const Rung &coarse = ladder[i - 1], &fine = ladder[i];
    if (!fine.is_good()) continue;
    if (first_good == 0) first_good = coarse.is_good() ? coarse.steps : fine.steps;
    const bool is_limit = !coarse.is_good() || (fine.steps <= farthest * first_good &&
                                                coarse.error > steepest_fall * fine.error);
    if (is_limit) limit = fine.steps;
    if (limit == 0 || coarse.steps >= farthest * limit) continue;
    const double allowed =
        is_limit ? 1 / nearest_to_limit : closest_ratio * std::pow(coarse.steps / limit, widening);
    if (fine.steps <= allowed * coarse.steps || fine.steps == coarse.steps + 1) continue;
    return is_limit ? std::round(std::sqrt(coarse.steps * fine.steps))
                    : first_between(coarse, fine, allowed);
  }
  return {};
}

}  // namespace qddot::inline measure
