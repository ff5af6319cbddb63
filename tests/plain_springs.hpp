#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <boost/numeric/odeint.hpp>

#include "qddot/scene/scene.hpp"

namespace qddot {
inline namespace tests {

// The motion of plain springs in long double, by loops over springs and Fehlberg's method of order
// 7 and 8: nothing is shared with the model or the integrators. Unknowns are displacements from the
// start, so that small ones keep their digits.
class PlainSprings {
 public:
  using Real = long double;

  explicit PlainSprings(const Scene& scene) : scene_(scene) {}

  // The displacements of all nodes from where they start [m] at t = until. `rtol` is relative to
  // the largest displacement and velocity that are expected, `size` [m] and `speed` [m/s].
  std::vector<Eigen::Vector3d> displacements_at(double until, Real rtol, Real size,
                                                Real speed) const {
    namespace odeint = boost::numeric::odeint;
    const std::size_t n = scene_.nodes.size();
    std::vector<Real> y(6 * n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t d = 0; d < 3; ++d)
        y[3 * (n + i) + d] = scene_.nodes[i].velocity[static_cast<int>(d)];
    }
    // Velocities are counted in metres by the ratio of both sizes, so that one tolerance fits.
    const Real ratio = speed / size;
    for (std::size_t k = 3 * n; k < 6 * n; ++k) y[k] /= ratio;
    const auto rate = [&](const std::vector<Real>& x, std::vector<Real>& dx, Real) {
      accelerations(x, dx);
      for (std::size_t k = 0; k < 3 * n; ++k) {
        const Real v = x[3 * n + k] * ratio;
        dx[3 * n + k] = (dx[3 * n + k] - scene_.air_damping * v) / ratio;
        dx[k] = v;
      }
      for (std::size_t i = 0; i < n; ++i) {
        if (!scene_.nodes[i].pinned) continue;
        for (std::size_t d = 0; d < 3; ++d) dx[3 * i + d] = dx[3 * (n + i) + d] = 0;
      }
    };
    using Stepper = odeint::runge_kutta_fehlberg78<std::vector<Real>, Real>;
    const auto stepper = odeint::make_controlled<Stepper>(rtol * size, Real(0));
    odeint::integrate_adaptive(stepper, rate, y, Real(0), Real(until), Real(until) * 1e-6L);
    std::vector<Eigen::Vector3d> u;
    for (std::size_t i = 0; i < n; ++i)
      u.emplace_back(static_cast<double>(y[3 * i]), static_cast<double>(y[3 * i + 1]),
                     static_cast<double>(y[3 * i + 2]));
    return u;
  }

 private:
  // M^-1 f - g is what springs give; weights and loads are added. Written behind the positions.
  void accelerations(const std::vector<Real>& x, std::vector<Real>& dx) const {
    const std::size_t n = scene_.nodes.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Node& node = scene_.nodes[i];
      for (std::size_t d = 0; d < 3; ++d) {
        const int axis = static_cast<int>(d);
        dx[3 * (n + i) + d] = scene_.gravity[axis] + static_cast<Real>(node.load[axis]) / node.mass;
      }
    }
    for (const Spring& spring : scene_.springs) {
      const auto [i, j] = spring.nodes;
      Real d[3], square = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        d[a] = static_cast<Real>(scene_.nodes[j].position[axis]) - scene_.nodes[i].position[axis] +
               x[3 * j + a] - x[3 * i + a];
        square += d[a] * d[a];
      }
      const Real l = std::sqrt(square), s = l - spring.law.rest_length;
      const Real pull = s * (spring.law.stiffness + spring.law.quartic * s * s) / l;
      for (std::size_t a = 0; a < 3; ++a) {
        dx[3 * (n + i) + a] += pull * d[a] / scene_.nodes[i].mass;
        dx[3 * (n + j) + a] -= pull * d[a] / scene_.nodes[j].mass;
      }
    }
  }

  const Scene& scene_;
};

}  // namespace tests
}  // namespace qddot
