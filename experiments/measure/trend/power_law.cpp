#include "qddot/measure/trend/power_law.hpp"

#include <limits>

#include <Eigen/Core>

#include "qddot/measure/trend/student.hpp"

namespace qddot::measure {

PowerLaw fit_power_law(std::span<const double> n, std::span<const double> y) {
  using Array = Eigen::ArrayXd;
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto count = std::ssize(n);
  if (count == 0) return {nothing, nothing, nothing};
  const auto centred_logs = [&](std::span<const double> values) -> Array {
    const Array logs = Eigen::Map<const Array>(values.data(), count).log();
    return logs - logs.mean();
  };
  const Array a = centred_logs(n), b = centred_logs(y);
  const double spread = a.square().sum();
  if (spread == 0) return {nothing, nothing, nothing};
  const double slope = (a * b).sum() / spread;
  if (count < 3) return {slope, nothing, nothing};
  const double freedom = static_cast<double>(count - 2);
  const double variance = (b - slope * a).square().sum() / freedom / spread;
  const double half = student_half_width(freedom) * std::sqrt(variance);
  return {slope, slope - half, slope + half};
}

}  // namespace qddot::measure
