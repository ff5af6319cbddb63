#include "qddot/measure/stability/linear_limit.hpp"

#include <cmath>
#include <limits>

#include <boost/math/tools/minima.hpp>

#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

constexpr int points = 400;  // over four decades
constexpr double growth_rounding = 1e-12;
// The distance of two roots that touch: rounding separates them by the square root of
// machine_epsilon.
constexpr double parted = 1e-6;

double growth(const Method& method, double h_omega) {
  return linear_step(method, h_omega).spectral_radius() - 1;
}

bool grows(const Method& method, double h_omega) {
  return growth(method, h_omega) > growth_rounding;
}

// Half the sum of the two leading roots. It is below 1 for a pair on the unit circle, and above for
// roots that have parted along the real axis.
double half_trace(const Method& method, double h_omega) {
  const auto roots = linear_step(method, h_omega).roots;
  return roots.size() < 2 ? std::numeric_limits<double>::infinity()
                          : std::abs((roots[0] + roots[1]) / 2.);
}

double grid(int i) {
  return least_searched_h_omega *
         std::pow(largest_searched_h_omega / least_searched_h_omega, 1. * i / points);
}

// The h w between a and c at which the roots are nearest to separating.
double nearest_to_parting(const Method& method, double a, double c) {
  const auto f = [&](double h_omega) { return -half_trace(method, h_omega); };
  return boost::math::tools::brent_find_minima(f, a, c, std::numeric_limits<double>::digits / 2)
      .first;
}

double bisected(const Method& method, double stable, double unstable) {
  while (unstable - stable > growth_rounding * unstable) {
    const double middle = (stable + unstable) / 2;
    (grows(method, middle) ? unstable : stable) = middle;
  }
  return stable;
}

// Whether growth fades as a power of h w instead of starting at a threshold: a little above the
// limit it is still below rounding.
bool fades_out(const Method& method, double limit) {
  return growth(method, (1 + 1e-5) * limit) < 2 * growth_rounding;
}

}  // namespace

double measured_limit(const Method& method) {
  if (grows(method, grid(0))) return 0;
  for (int i = 1; i <= points; ++i) {
    double unstable = grid(i);
    if (!grows(method, unstable)) {
      if (i == points) break;
      const double traces[] = {half_trace(method, grid(i - 1)), half_trace(method, grid(i)),
                               half_trace(method, grid(i + 1))};
      if (traces[1] < traces[0] || traces[1] < traces[2]) continue;
      unstable = nearest_to_parting(method, grid(i - 1), grid(i + 1));
      if (growth(method, unstable) < parted) continue;
    }
    const double limit = bisected(method, grid(i - 1), unstable);
    return fades_out(method, limit) ? 0 : limit;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace qddot::inline measure
