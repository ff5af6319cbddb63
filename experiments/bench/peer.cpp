#include "experiments/bench/peer.hpp"

#include <cmath>

#include "qddot/analysis/largest_frequency.hpp"

namespace qddot::bench {

std::vector<double> tolerances(int in_a_decade) {
  std::vector<double> values;
  for (int i = 2 * in_a_decade; i <= 13 * in_a_decade; ++i) {
    values.push_back(std::pow(10.0, -static_cast<double>(i) / in_a_decade));
  }
  return values;
}

std::vector<double> step_sizes(const Problem& problem, int in_a_decade, int decades) {
  const double w = frequency_bound(problem.scene.system(), problem.scene.initial().q);
  const double fewest = std::max(1.0, problem.until * w / 16);
  std::vector<double> values;
  for (int i = 0; i <= decades * in_a_decade; ++i) {
    const double steps = std::ceil(fewest * std::pow(10.0, static_cast<double>(i) / in_a_decade));
    values.push_back(problem.until / steps);
  }
  return values;
}

}  // namespace qddot::bench
