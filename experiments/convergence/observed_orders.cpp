#include "experiments/convergence/observed_orders.hpp"

#include <cmath>
#include <limits>

namespace qddot::convergence {

std::vector<double> observed_orders(const std::vector<double>& errors,
                                    const std::vector<double>& floors) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto is_good = [&](std::size_t i) {
    return errors[i] <= largest_asymptotic && errors[i] >= floors[i] && errors[i] > 0;
  };
  std::vector<double> raw(errors.size(), nothing);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    if (is_good(i - 1) && is_good(i)) raw[i] = std::log2(errors[i - 1] / errors[i]);
  }
  std::vector<double> orders(errors.size(), nothing);
  const auto agree = [&](std::size_t i, std::size_t j) {
    return j < raw.size() && std::abs(raw[i] - raw[j]) <= agreeing;
  };
  for (std::size_t i = 1; i < raw.size(); ++i) {
    if (agree(i, i - 1) || agree(i, i + 1)) orders[i] = raw[i];
  }
  return orders;
}

double rounding_of_steps(double rounding_effect, double steps) {
  return rounding_effect * std::sqrt(steps) / 4;
}

}  // namespace qddot::convergence
