#include "experiments/symmetric_roots/orbit_swing.hpp"

#include <algorithm>
#include <cmath>

namespace qddot::spurious_roots {
namespace {

constexpr double radius = 1.2, speed = 0.3;  // at t = 0; speed across the spring
constexpr int sizes = 8;
// The classical Runge-Kutta method's in a step: at h w = 0.4 it errs by less than 1e-12.
constexpr int substeps = 400;

double energy(double x, double y, double kinetic) {
  const double stretch = std::hypot(x, y) - 1;
  return kinetic + stretch * stretch / 2;
}

}  // namespace

OrbitSwing::Point OrbitSwing::acceleration(const Point& q) {
  const double pull = 1 / std::sqrt(q.x * q.x + q.y * q.y) - 1;
  return {pull * q.x, pull * q.y};
}

OrbitSwing::OrbitSwing(double h_omega, int steps, int most_steps) : steps_(steps) {
  const auto moved = [](const Point& q, const Point& v, double h) {
    return Point{q.x + h * v.x, q.y + h * v.y};
  };
  for (int i = sizes; i >= 1; --i) {  // the longest steps, which are the likeliest to fail, first
    Start start{.h = h_omega / 2 * (1 + i / static_cast<double>(sizes)), .positions = {}};
    const double h = start.h / substeps;
    Point q = {radius, 0}, v = {0, speed};
    for (int n = 0; n < most_steps; ++n) {
      start.positions.push_back(q);
      for (int s = 0; s < substeps; ++s) {
        const Point a1 = acceleration(q), v2 = moved(v, a1, h / 2);
        const Point a2 = acceleration(moved(q, v, h / 2)), v3 = moved(v, a2, h / 2);
        const Point a3 = acceleration(moved(q, v2, h / 2)), v4 = moved(v, a3, h);
        const Point a4 = acceleration(moved(q, v3, h));
        q = {q.x + h / 6 * (v.x + 2 * v2.x + 2 * v3.x + v4.x),
             q.y + h / 6 * (v.y + 2 * v2.y + 2 * v3.y + v4.y)};
        v = {v.x + h / 6 * (a1.x + 2 * a2.x + 2 * a3.x + a4.x),
             v.y + h / 6 * (a1.y + 2 * a2.y + 2 * a3.y + a4.y)};
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
  const double h = start.h, scale = energy(radius, 0, speed * speed / 2);
  const auto k = static_cast<std::size_t>(formula.steps());
  const std::vector<double> w = velocity_weights(0, formula.steps() - 1);
  // Each of the last k, twice, so that they are in a row from any of them on.
  std::vector<Point> q(2 * k), g(2 * k);
  const auto keep = [&](std::size_t place, const Point& at) {
    const Point a = acceleration(at);
    q[place] = q[place + k] = at;
    g[place] = g[place + k] = {h * h * a.x, h * h * a.y};
  };
  for (std::size_t n = 0; n < k; ++n) keep(n, start.positions[n]);
  double worst = 0;
  for (std::size_t n = k; n < static_cast<std::size_t>(steps_); ++n) {
    const Point *old_q = &q[n % k], *old_g = &g[n % k];  // of n - k; then those after it
    Point next = {0, 0};
    for (std::size_t j = 0; j < k; ++j) {
      next.x -= formula.rho[j] * old_q[j].x;
      next.y -= formula.rho[j] * old_q[j].y;
    }
    for (std::size_t j = 1; j < k; ++j) {
      next.x += formula.beta[j - 1] * old_g[j].x;
      next.y += formula.beta[j - 1] * old_g[j].y;
    }
    const Point before = old_q[k - 1];
    keep(n % k, next);
    const Point* last_g = &g[n % k + k];
    Point d = {next.x - before.x, next.y - before.y};  // h v
    for (std::size_t j = 0; j < w.size(); ++j) {
      d.x += w[j] * (last_g - j)->x;
      d.y += w[j] * (last_g - j)->y;
    }
    const double kinetic = (d.x * d.x + d.y * d.y) / (2 * h * h);
    const double error = std::abs(energy(next.x, next.y, kinetic) - scale) / scale;
    if (!(error < 1)) return 1;
    worst = std::max(worst, error);
  }
  return worst;
}

}  // namespace qddot::spurious_roots
