#include "qddot/algebra/straight_line.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <boost/math/distributions/students_t.hpp>

namespace qddot {

StraightLine straight_line(std::span<const double> x, std::span<const double> y) {
  if (x.empty()) return {};
  const auto array = [](std::span<const double> all) {
    return Eigen::Map<const Eigen::ArrayXd>(all.data(), std::ssize(all));
  };
  StraightLine line{.level = array(y).mean(), .middle = array(x).mean()};
  const Eigen::ArrayXd a = array(x) - line.middle, b = array(y) - line.level;
  line.spread = a.square().sum();
  if (line.spread > 0) line.slope = (a * b).sum() / line.spread;
  line.left = (b - line.slope * a).square().sum();
  return line;
}

double student_half_width(double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), 0.975);
}

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

}  // namespace qddot
