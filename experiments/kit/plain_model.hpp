#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot {
inline namespace kit {

// A real of quadruple precision (113 bits); the language has no root of it.
using Quadruple = __float128;

inline double plain_root(double x) { return std::sqrt(x); }
inline long double plain_root(long double x) { return std::sqrt(x); }
// Newton's iteration from the root in double: 53, 106, 212 bits. Out of that range it is not used.
inline Quadruple plain_root(Quadruple x) {
  if (!(x > 0)) return 0;
  Quadruple s = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 2; ++i) s = (s + x / s) / 2;
  return s;
}

inline double plain_sine(double x) { return std::sin(x); }
inline long double plain_sine(long double x) { return std::sin(x); }
inline Quadruple plain_sine(Quadruple x) { return std::sin(static_cast<long double>(x)); }

// A component of a curve of polynomials and harmonics at t, and of its derivative.
template <class Real>
struct PlainCurve {
  Real value = 0, rate = 0;

  PlainCurve(const TimeCurve& curve, Eigen::Index c, Real t) {
    for (std::size_t k = curve.polynomial.size(); k-- > 0;) {
      rate = value + t * rate;
      value = Real(curve.polynomial[k][c]) + t * value;
    }
    const Real quarter = std::acos(-1.0L) / 2;
    for (const TimeCurve::Harmonic& harmonic : curve.harmonics) {
      const Real w = harmonic.frequency, turned = w * t + Real(harmonic.phase);
      value += Real(harmonic.amplitude[c]) * plain_sine(turned);
      rate += Real(harmonic.amplitude[c]) * w * plain_sine(turned + quarter);
    }
  }
};

// The powers of damping and driving [W], or the energies that they took and gave [J].
template <class Real>
struct PlainWork {
  Real dissipated = 0, driven = 0;

  friend PlainWork operator+(const PlainWork& a, const PlainWork& b) {
    return {a.dissipated + b.dissipated, a.driven + b.driven};
  }
  friend PlainWork operator*(Real s, const PlainWork& a) {
    return {s * a.dissipated, s * a.driven};
  }
};

// The start of a scene in Real numbers, three coordinates a node; pinned nodes rest.
template <class Real>
std::vector<Real> plain_positions(const Scene& scene) {
  std::vector<Real> x;
  for (const Node& node : scene.nodes)
    x.insert(x.end(), node.position.begin(), node.position.end());
  return x;
}
template <class Real>
std::vector<Real> plain_velocities(const Scene& scene) {
  std::vector<Real> v;
  for (const Node& node : scene.nodes) {
    for (const double c : node.velocity) v.push_back(node.pinned ? 0 : c);
  }
  return v;
}

// The equations of motion of a scene as drawn, without reductions and independent of the model
// under test. x and v are positions and velocities of all nodes, node after node, three coordinates
// each. Forces are summed one spring after the other. Real is double, long double or Quadruple.
// Forces and places may have positions from origin(), as they depend on differences alone: far from
// zero, such numbers resolve more.
template <class Real>
class PlainModel {
 public:
  using Vector = std::vector<Real>;

  explicit PlainModel(const Scene& scene)
      : scene_(scene),
        has_loads_(has_loads(scene)),
        is_damped_(qddot::is_damped(scene)),
        is_driven_(qddot::is_driven(scene)) {
    if (is_far(scene)) std::copy_n(scene.nodes[0].position.data(), 3, origin_.begin());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
      if (!scene.nodes[i].pinned && scene.nodes[i].mass == 0) massless_.push_back(i);
    }
  }

  const Scene& scene() const { return scene_; }
  bool has_massless() const { return !massless_.empty(); }

  // The first node, if all are near it and far from zero; else zero [m].
  const std::array<Real, 3>& origin() const { return origin_; }
  Vector positions() const { return plain_positions<Real>(scene_); }
  Vector velocities() const { return plain_velocities<Real>(scene_); }

  // f = -dV/dx [N] of springs and loads, without weights, and without springs between pinned nodes.
  void forces_without_weights(const Vector& x, Vector& f) const {
    f.assign(x.size(), 0);
    for (const Spring& spring : scene_.springs) {
      const auto [i, j] = spring.nodes;
      Real d[3];
      const Real l = plain_root(squared_length(spring, x, d));
      if (!(l > 0) || is_between_pins(spring)) continue;
      const Real pull = tension(spring.law, l) / l;
      for (std::size_t c = 0; c < 3; ++c) {
        f[3 * i + c] += pull * d[c];
        f[3 * j + c] -= pull * d[c];
      }
    }
    if (!has_loads_) return;
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Eigen::Vector3d load = scene_.nodes[i].acting_load();
      for (std::size_t c = 0; c < 3; ++c) f[3 * i + c] += load[static_cast<Eigen::Index>(c)];
    }
  }

  bool is_damped() const { return is_damped_; }
  bool is_driven() const { return is_driven_; }

  // Puts supports that move where they are at t [s], with their velocities. x is from origin().
  void place_supports(Real t, Vector& x, Vector& v) const {
    for_curves([&](std::size_t i, const Node& node, const TimeCurve& curve) {
      for (std::size_t c = 0; c < 3 && node.pinned; ++c) {
        const auto axis = static_cast<Eigen::Index>(c);
        const PlainCurve<Real> support(curve, axis, t);
        x[3 * i + c] = Real(node.position[axis]) - origin_[c] + support.value;
        v[3 * i + c] = support.rate;
      }
    });
  }
  // Adds the loads that change, and gravity that does, at t to f.
  void add_driven_loads(Real t, Vector& f) const {
    for_loads([&](std::size_t i, Real factor, const TimeCurve& curve) {
      for (std::size_t c = 0; c < 3; ++c)
        f[3 * i + c] += factor * PlainCurve<Real>(curve, static_cast<Eigen::Index>(c), t).value;
    });
  }
  // Their potential energy [J], or its rate of change at constant x [W].
  Real energy_of_driven_loads(Real t, const Vector& x, bool is_rate) const {
    Real sum = 0;
    for_loads([&](std::size_t i, Real factor, const TimeCurve& curve) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto axis = static_cast<Eigen::Index>(c);
        const PlainCurve<Real> load(curve, axis, t);
        const Real moved = x[3 * i + c] + origin_[c] - Real(scene_.nodes[i].position[axis]);
        sum -= factor * (is_rate ? load.rate : load.value) * moved;
      }
    });
    return sum;
  }
  // Adds the forces of dashpots and air to f, and returns the power that they take [W]: a dashpot
  // pulls its ends together by c l' along it, and of rest or length zero by c times the rate at
  // which they part.
  Real add_friction(const Vector& x, const Vector& v, Vector& f) const {
    Real power = 0;
    for (const Spring& spring : scene_.springs) {
      const auto [i, j] = spring.nodes;
      if (spring.law.damping == 0 || is_between_pins(spring)) continue;
      Real d[3], w[3], along = 0;
      const Real l2 = squared_length(spring, x, d);
      for (std::size_t c = 0; c < 3; ++c) {
        w[c] = v[3 * j + c] - v[3 * i + c];
        along += d[c] * w[c];
      }
      const bool has_direction = spring.law.rest_length > 0 && l2 > 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Real pull = Real(spring.law.damping) * (has_direction ? along / l2 * d[c] : w[c]);
        f[3 * i + c] += pull;
        f[3 * j + c] -= pull;
        power += pull * w[c];
      }
    }
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      const Real alpha_m = node.pinned ? Real(0) : Real(scene_.air_damping) * Real(node.mass);
      for (std::size_t c = 0; c < 3; ++c) {
        f[3 * i + c] -= alpha_m * v[3 * i + c];
        power += alpha_m * v[3 * i + c] * v[3 * i + c];
      }
    }
    return power;
  }

  // a = f/m + g [m/s^2] of nodes with mass; zero for all others.
  void acceleration(const Vector& x, Vector& a) const {
    forces_without_weights(x, a);
    divide_by_masses(a);
  }
  // The same with friction, whose power is returned.
  Real acceleration(const Vector& x, const Vector& v, Vector& a) const {
    forces_without_weights(x, a);
    const Real power = add_friction(x, v, a);
    divide_by_masses(a);
    return power;
  }

  // The same at t [s] with friction and driving, whose powers are returned. Supports must be in
  // their places. The force on a support is that which it does not follow.
  PlainWork<Real> acceleration(Real t, const Vector& x, const Vector& v, Vector& a) const {
    forces_without_weights(x, a);
    PlainWork<Real> power;
    power.dissipated = add_friction(x, v, a);
    if (is_driven_) {
      for_curves([&](std::size_t i, const Node& node, const TimeCurve&) {
        for (std::size_t c = 0; c < 3 && node.pinned; ++c)
          power.driven -= a[3 * i + c] * v[3 * i + c];
      });
      power.driven += energy_of_driven_loads(t, x, true);
      add_driven_loads(t, a);
    }
    divide_by_masses(a);
    return power;
  }

  // The energy of springs between pinned nodes [J], whose supports give what it changes by.
  Real energy_between_pins(const Vector& x) const {
    Real sum = 0, d[3];
    for (const Spring& spring : scene_.springs) {
      if (!is_between_pins(spring)) continue;
      const Real s = plain_root(squared_length(spring, x, d)) - Real(spring.law.rest_length);
      sum += s * s * (Real(spring.law.stiffness) / 2 + Real(spring.law.quartic) / 4 * s * s);
    }
    return sum;
  }

  // 1/2 v'Mv + V [J]; weights and loads of pinned nodes do not count. x is from zero.
  Real energy(const Vector& x, const Vector& v) const {
    Real sum = 0;
    for (const Spring& spring : scene_.springs) {
      Real d[3];
      const Real s = plain_root(squared_length(spring, x, d)) - Real(spring.law.rest_length);
      sum += s * s * (Real(spring.law.stiffness) / 2 + Real(spring.law.quartic) / 4 * s * s);
    }
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      if (node.pinned) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const Real g = scene_.gravity[static_cast<Eigen::Index>(c)], w = v[3 * i + c];
        sum += Real(node.mass) * (w * w / 2 - g * x[3 * i + c]);
        sum -= Real(node.load[static_cast<Eigen::Index>(c)]) * x[3 * i + c];
      }
    }
    return sum;
  }

  // Moves massless nodes to a place without force, a minimum of V; false if Newton's iteration
  // finds none. Does nothing without massless nodes.
  bool place_massless(Vector& x) const;

 private:
  bool is_between_pins(const Spring& spring) const {
    return scene_.nodes[spring.nodes[0]].pinned && scene_.nodes[spring.nodes[1]].pinned;
  }
  // Calls see(i, node, its curve) for each node that has one.
  template <class See>
  void for_curves(const See& see) const {
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      if (node.curve >= 0) see(i, node, scene_.curves[static_cast<std::size_t>(node.curve)]);
    }
  }
  // Calls see(i, factor, curve) for each force factor curve(t) on a free node.
  template <class See>
  void for_loads(const See& see) const {
    for_curves([&](std::size_t i, const Node& node, const TimeCurve& curve) {
      if (!node.pinned) see(i, Real(1), curve);
    });
    if (scene_.gravity_curve < 0) return;
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      if (!node.pinned)
        see(i, Real(node.mass), scene_.curves[static_cast<std::size_t>(scene_.gravity_curve)]);
    }
  }
  // f/m + g in the place of f.
  void divide_by_masses(Vector& f) const {
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      const bool moves = !node.pinned && node.mass > 0;
      for (std::size_t c = 0; c < 3; ++c) {
        Real& own = f[3 * i + c];
        own = moves ? own / Real(node.mass) + Real(scene_.gravity[static_cast<Eigen::Index>(c)])
                    : Real(0);
      }
    }
  }
  static bool is_far(const Scene& scene) {
    double nearest = 0, farthest = 0;
    for (const Node& node : scene.nodes) {
      const Eigen::Vector3d d = node.position - scene.nodes[0].position;
      nearest = std::max(nearest, d.lpNorm<Eigen::Infinity>());
      farthest = std::max(farthest, node.position.lpNorm<Eigen::Infinity>());
    }
    return farthest > 4 * nearest;
  }
  // d, from one end of the spring to the other, and its square.
  static Real squared_length(const Spring& spring, const Vector& x, Real (&d)[3]) {
    Real l2 = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      d[c] = x[3 * spring.nodes[1] + c] - x[3 * spring.nodes[0] + c];
      l2 += d[c] * d[c];
    }
    return l2;
  }
  static Real tension(const SpringLaw& law, Real l) {
    const Real s = l - Real(law.rest_length);
    return s * (Real(law.stiffness) + Real(law.quartic) * s * s);
  }

  Scene scene_;
  bool has_loads_, is_damped_, is_driven_;
  std::vector<std::size_t> massless_;
  std::array<Real, 3> origin_{};
};

// Newton's iteration on -K d = f over the coordinates of the massless nodes in the scene's
// dimension, by Cholesky's factorisation without blocks. If a pivot is not positive, the place is
// no minimum. Steps are halved while they do not lower the potential.
template <class Real>
bool PlainModel<Real>::place_massless(Vector& x) const {
  if (massless_.empty()) return true;
  const auto axes = static_cast<std::size_t>(scene_.dimension);
  const std::size_t n = axes * massless_.size();
  std::vector<std::size_t> number(scene_.nodes.size(), n);
  for (std::size_t k = 0; k < massless_.size(); ++k) number[massless_[k]] = axes * k;

  Vector f, k(n * n), d(n);
  const Vector still(x.size(), 0);
  Real least_residual = -1;
  for (int iteration = 0; iteration < 100; ++iteration) {
    forces_without_weights(x, f);
    std::fill(k.begin(), k.end(), Real(0));
    Real largest_entry = 0;
    for (const Spring& spring : scene_.springs) {
      const auto [i, j] = spring.nodes;
      if (number[i] == n && number[j] == n) continue;
      Real e[3];
      const Real l2 = squared_length(spring, x, e), l = plain_root(l2);
      if (!(l > 0) && spring.law.rest_length > 0) return false;
      const Real s = l - Real(spring.law.rest_length);
      const Real along = Real(spring.law.stiffness) + 3 * Real(spring.law.quartic) * s * s;
      const Real across = l > 0 ? tension(spring.law, l) / l : along;
      for (std::size_t a = 0; a < axes; ++a) {
        for (std::size_t b = 0; b < axes; ++b) {
          const Real nn = l > 0 ? e[a] * e[b] / l2 : Real(0);
          const Real entry = (along - across) * nn + (a == b ? across : Real(0));
          const auto add = [&](std::size_t p, std::size_t q, Real value) {
            if (number[p] < n && number[q] < n) k[(number[p] + a) * n + number[q] + b] += value;
          };
          add(i, i, entry), add(j, j, entry), add(i, j, -entry), add(j, i, -entry);
          largest_entry = std::max(largest_entry, entry < 0 ? -entry : entry);
        }
      }
    }
    Real residual = 0;
    for (std::size_t m = 0; m < massless_.size(); ++m) {
      for (std::size_t a = 0; a < axes; ++a) {
        d[axes * m + a] = f[3 * massless_[m] + a];
        residual += d[axes * m + a] * d[axes * m + a];
      }
    }
    // In place: k becomes L, d becomes the step.
    for (std::size_t c = 0; c < n; ++c) {
      for (std::size_t p = 0; p < c; ++p) {
        for (std::size_t r = c; r < n; ++r) k[r * n + c] -= k[r * n + p] * k[c * n + p];
      }
      if (!(k[c * n + c] > largest_entry * Real(1e-12))) return false;
      const Real root = plain_root(k[c * n + c]);
      for (std::size_t r = c; r < n; ++r) k[r * n + c] /= root;
    }
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < r; ++c) d[r] -= k[r * n + c] * d[c];
      d[r] /= k[r * n + r];
    }
    for (std::size_t r = n; r-- > 0;) {
      for (std::size_t c = r + 1; c < n; ++c) d[r] -= k[c * n + r] * d[c];
      d[r] /= k[r * n + r];
    }
    // Converged if rounding keeps the residual from falling and the residual is as small as
    // rounding: it may also rise on the way from afar.
    Real extent = 0;
    for (const Real& coordinate : x)
      extent = std::max(extent, coordinate < 0 ? -coordinate : coordinate);
    const Real rounding = Real(1e-13) * largest_entry * extent;
    const bool is_rounding = residual <= rounding * rounding;
    if (residual == 0 ||
        (iteration > 3 && least_residual >= 0 && residual >= least_residual && is_rounding))
      return true;
    least_residual = residual;
    const Vector before = x;
    const Real start = energy(x, still);
    for (Real part = 1; part > Real(1e-6); part /= 2) {
      for (std::size_t m = 0; m < massless_.size(); ++m) {
        for (std::size_t a = 0; a < axes; ++a) {
          x[3 * massless_[m] + a] = before[3 * massless_[m] + a] + part * d[axes * m + a];
        }
      }
      if (iteration > 3 || energy(x, still) <= start) break;
    }
  }
  return false;
}

}  // namespace kit
}  // namespace qddot
