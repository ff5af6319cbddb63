#include "experiments/symmetric_roots/orbit_swing.hpp"

#include <algorithm>
#include <cmath>

namespace qddot::spurious_roots {
namespace {

constexpr double radius = 1.2, speed = 0.3;  // at t = 0; speed across the spring
constexpr int sizes = 8;
// The classical Runge-Kutta method's in a step: at h w = 0.4 it errs by less than 1e-12.
constexpr int substeps = 400;

using Point = OrbitSwing::Point;

double energy(const Point& q, double kinetic) {
  const double stretch = std::abs(q) - 1;
  return kinetic + stretch * stretch / 2;
}

Point acceleration(const Point& q) { return (1 / std::sqrt(std::norm(q)) - 1) * q; }

}  // namespace

OrbitSwing::OrbitSwing(double h_omega, int steps, int most_steps) : steps_(steps) {
  for (int i = sizes; i >= 1; --i) {  // the longest steps, which are the likeliest to fail, first
    Start start{.h = h_omega / 2 * (1 + i / static_cast<double>(sizes)), .positions = {}};
    const double h = start.h / substeps;
    Point q(radius, 0), v(0, speed);
    for (int n = 0; n < most_steps; ++n) {
      start.positions.push_back(q);
      for (int s = 0; s < substeps; ++s) {
        const Point a1 = acceleration(q), v2 = v + h / 2 * a1;
        const Point a2 = acceleration(q + h / 2 * v), v3 = v + h / 2 * a2;
        const Point a3 = acceleration(q + h / 2 * v2), v4 = v + h * a3;
        const Point a4 = acceleration(q + h * v3);
        q += h / 6 * (v + 2. * v2 + 2. * v3 + v4);
        v += h / 6 * (a1 + 2. * a2 + 2. * a3 + a4);
      }
    }
    starts_.push_back(std::move(start));
  }
}

double OrbitSwing::operator()(const Coefficients& formula) const {
  double worst = 0;
  for (const Start& start : starts_) {
    worst = std::max(worst, swing(formula, start));
    if (worst >= 1) break;  // no other run can be worse
  }
  return worst;
}

// Velocities are computed as SymmetricMultistep computes them. The orbit is fastest where the
// spring is as long as at rest, and its kinetic energy then is all there is.
double OrbitSwing::swing(const Coefficients& formula, const Start& start) const {
  const double h = start.h, scale = energy(radius, speed * speed / 2);
  const auto k = static_cast<std::size_t>(formula.steps());
  const std::vector<double> w = velocity_weights(0, formula.steps() - 1);
  // Each of the last k, twice, so that they are in a row from any of them on.
  std::vector<Point> q(2 * k), g(2 * k);
  const auto keep = [&](std::size_t place, const Point& at) {
    q[place] = q[place + k] = at;
    g[place] = g[place + k] = h * h * acceleration(at);
  };
  for (std::size_t n = 0; n < k; ++n) keep(n, start.positions[n]);
  double worst = 0;
  for (std::size_t n = k; n < static_cast<std::size_t>(steps_); ++n) {
    const Point *old_q = &q[n % k], *old_g = &g[n % k];  // of n - k; then those after it
    Point next = 0;
    for (std::size_t j = 0; j < k; ++j) next -= formula.rho[j] * old_q[j];
    for (std::size_t j = 1; j < k; ++j) next += formula.beta[j - 1] * old_g[j];
    Point d = next - old_q[k - 1];  // h v
    keep(n % k, next);
    const Point* last_g = &g[n % k + k];
    for (std::size_t j = 0; j < w.size(); ++j) d += w[j] * *(last_g - j);
    const double error = std::abs(energy(next, std::norm(d) / (2 * h * h)) - scale) / scale;
    if (!(error < 1)) return 1;
    worst = std::max(worst, error);
  }
  return worst;
}

}  // namespace qddot::spurious_roots
