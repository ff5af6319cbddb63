#include "qddot/algebra/straight_line.hpp"

#include <Eigen/Core>

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

}  // namespace qddot
