#include "qddot/measure/advice/frequency_error.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// Values are stored at multiples of 2 % in h w.
constexpr double per_logarithm = 50;
constexpr double least_searched = 1e-9, largest_searched = 100;
// A spectral radius that exceeds 1 by less than this is a rounding error, not growth.
constexpr double root_rounding = 1e-9;

double computed(const Method& method, double h_omega) {
  if (!has_linear_step(method) || h_omega > linear_limit(method)) return infinite;
  LinearStep step;
  try {
    step = linear_step(method, h_omega);
  } catch (const std::runtime_error&) {  // the step failed
    return infinite;
  }
  if (step.spectral_radius() > 1 + root_rounding) return infinite;
  double nearest = infinite;
  for (const std::complex<double>& root : step.roots) {
    if (root == 0.) continue;
    nearest = std::min(nearest, std::abs(std::log(root) / std::complex<double>(0, h_omega) - 1.));
  }
  return nearest;
}

double kept(const Method& method, int number) {
  static std::mutex mutex;
  static std::map<std::pair<const Method*, int>, double> values;
  const std::lock_guard lock(mutex);
  const auto [place, is_new] = values.try_emplace({&method, number}, 0);
  if (is_new) place->second = computed(method, std::exp(number / per_logarithm));
  return place->second;
}

double at(const Method& method, double h_omega) {
  return kept(method, static_cast<int>(std::floor(std::log(h_omega) * per_logarithm)));
}

// The h w below which the error is proportional to (h w)^order. Roots at this h w are still
// accurate.
double asymptotic(const Method& method) { return method.order <= 4 ? 0.1 : 0.05 * method.order; }

}  // namespace

double frequency_error(const Method& method, double h_omega) {
  if (!(h_omega > 0)) return 0;
  if (h_omega > linear_limit(method)) return infinite;
  const double small = asymptotic(method);
  if (h_omega < small) return at(method, small) * std::pow(h_omega / small, method.order);
  return at(method, h_omega);
}

double largest_h_omega(const Method& method, double error) {
  const double small = asymptotic(method), there = at(method, small);
  if (!std::isfinite(there) || !(error > 0)) return 0;
  if (there > error) return small * std::pow(error / there, 1.0 / method.order);
  const double most = std::min(largest_searched, linear_limit(method)),
               apart = std::exp(1 / per_logarithm);
  // The order says where the error is reached; beyond what is asymptotic it says so again from
  // there. Halves end the search where the error follows no order.
  constexpr int guesses = 4;
  double low = small, high = most * apart, from = small, error_there = there;
  for (int i = 0; high > low * apart; ++i) {
    double next = std::sqrt(low * high);
    if (i < guesses && std::isfinite(error_there)) {
      const double guess = from * std::pow(error / error_there, 1.0 / method.order);
      next = std::max(low * apart, std::min(guess, high / apart));
    }
    from = next = std::min(next, most);
    error_there = frequency_error(method, next);
    (error_there <= error ? low : high) = next;
  }
  return low;
}

}  // namespace qddot::inline measure
