#include "qddot/measure/stability/linear_limit.hpp"

#include <cmath>
#include <limits>

#include <boost/math/tools/minima.hpp>

#include "qddot/analysis/damped_step.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

constexpr int points = 400;  // over four decades
constexpr double growth_rounding = 1e-12;
// The distance of two roots that touch: rounding separates them by the square root of
// machine_epsilon.
constexpr double parted = 1e-6;

// A method on a vibration of one damping ratio.
struct Vibration {
  const Method& method;
  double zeta;

  LinearStep step(double h_omega) const { return linear_step(method, h_omega, {}, zeta); }
};

double growth(const Vibration& of, double h_omega) {
  return of.step(h_omega).spectral_radius() - 1;
}

bool grows(const Vibration& of, double h_omega) { return growth(of, h_omega) > growth_rounding; }

// Half the sum of the two leading roots. It is below 1 for a pair on the unit circle, and above for
// roots that have parted along the real axis.
double half_trace(const Vibration& of, double h_omega) {
  const auto roots = of.step(h_omega).roots;
  return roots.size() < 2 ? std::numeric_limits<double>::infinity()
                          : std::abs((roots[0] + roots[1]) / 2.);
}

double grid(int i) {
  return least_searched_h_omega *
         std::pow(largest_searched_h_omega / least_searched_h_omega, 1. * i / points);
}

// The h w between a and c at which the roots are nearest to separating.
double nearest_to_parting(const Vibration& of, double a, double c) {
  const auto f = [&](double h_omega) { return -half_trace(of, h_omega); };
  return boost::math::tools::brent_find_minima(f, a, c, std::numeric_limits<double>::digits / 2)
      .first;
}

double bisected(const Vibration& of, double stable, double unstable) {
  while (unstable - stable > growth_rounding * unstable) {
    const double middle = (stable + unstable) / 2;
    (grows(of, middle) ? unstable : stable) = middle;
  }
  return stable;
}

// Whether growth fades as a power of h w instead of starting at a threshold: a little above the
// limit it is still below rounding.
bool fades_out(const Vibration& of, double limit) {
  return growth(of, (1 + 1e-5) * limit) < 2 * growth_rounding;
}

}  // namespace

double measured_limit(const Method& method, double zeta) {
  const Vibration of{method, zeta};
  if (grows(of, grid(0))) return 0;
  for (int i = 1; i <= points; ++i) {
    double unstable = grid(i);
    if (!grows(of, unstable)) {
      if (i == points) break;
      const double traces[] = {half_trace(of, grid(i - 1)), half_trace(of, grid(i)),
                               half_trace(of, grid(i + 1))};
      if (traces[1] < traces[0] || traces[1] < traces[2]) continue;
      unstable = nearest_to_parting(of, grid(i - 1), grid(i + 1));
      if (growth(of, unstable) < parted) continue;
    }
    const double limit = bisected(of, grid(i - 1), unstable);
    return fades_out(of, limit) ? 0 : limit;
  }
  return std::numeric_limits<double>::infinity();
}

double stable_step(const Method& method, const System& system, const Vec& q) {
  if (!system.damping()) return linear_limit(method) / quick_frequency(system, q);
  if (method.friction_lag > 0) return damped_step_limit(system, q, method.friction_lag);
  const NaturalModes fastest = highest_modes(system, q, 1);
  if (fastest.squares.size() == 0 || !(fastest.squares[0] > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  const double omega = std::sqrt(fastest.squares[0]);
  return measured_limit(method, damping_ratio(system, q, fastest.shapes.col(0), omega)) / omega;
}

}  // namespace qddot::inline measure
