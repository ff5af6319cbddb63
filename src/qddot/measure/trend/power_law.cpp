#include "qddot/measure/trend/power_law.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "qddot/algebra/straight_line.hpp"
#include "qddot/measure/trend/student.hpp"

namespace qddot::inline measure {

PowerLaw fit_power_law(std::span<const double> n, std::span<const double> y) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto logs = [](std::span<const double> values) {
    std::vector<double> all;
    for (const double value : values) all.push_back(std::log(value));
    return all;
  };
  const StraightLine line = straight_line(logs(n), logs(y));
  if (line.spread == 0) return {nothing, nothing, nothing};
  if (n.size() < 3) return {line.slope, nothing, nothing};
  const auto freedom = static_cast<double>(n.size() - 2);
  const double half = student_half_width(freedom) * std::sqrt(line.left / freedom / line.spread);
  return {line.slope, line.slope - half, line.slope + half};
}

}  // namespace qddot::inline measure
