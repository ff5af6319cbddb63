#pragma once

#include <cmath>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot {
inline namespace tests {

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

// The equations of motion of a scene as drawn, without reductions and independent of the model
// under test. x and v are positions and velocities of all nodes, node after node, three coordinates
// each. Forces are summed one spring after the other. Real is double, long double or Quadruple.
template <class Real>
class PlainModel {
 public:
  using Vector = std::vector<Real>;

  explicit PlainModel(const Scene& scene) : scene_(scene) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
      if (!scene.nodes[i].pinned && scene.nodes[i].mass == 0) massless_.push_back(i);
    }
  }

  const Scene& scene() const { return scene_; }
  bool has_massless() const { return !massless_.empty(); }

  Vector positions() const {
    Vector x;
    for (const Node& node : scene_.nodes)
      x.insert(x.end(), node.position.begin(), node.position.end());
    return x;
  }
  Vector velocities() const {
    Vector v;
    for (const Node& node : scene_.nodes) {
      for (const double c : node.velocity) v.push_back(node.pinned ? 0 : c);
    }
    return v;
  }

  // f = -dV/dx [N] of springs alone.
  void spring_forces(const Vector& x, Vector& f) const {
    f.assign(x.size(), 0);
    for (const Spring& spring : scene_.springs) {
      const auto [i, j] = spring.nodes;
      Real d[3], l2 = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        d[c] = x[3 * j + c] - x[3 * i + c];
        l2 += d[c] * d[c];
      }
      const Real l = plain_root(l2);
      if (!(l > 0)) continue;
      const Real pull = tension(spring.law, l) / l;
      for (std::size_t c = 0; c < 3; ++c) {
        f[3 * i + c] += pull * d[c];
        f[3 * j + c] -= pull * d[c];
      }
    }
  }

  // a = f/m + g [m/s^2] of nodes with mass; zero for all others.
  void acceleration(const Vector& x, Vector& a) const {
    spring_forces(x, a);
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      const bool moves = !node.pinned && node.mass > 0;
      for (std::size_t c = 0; c < 3; ++c) {
        Real& own = a[3 * i + c];
        own = moves ? own / Real(node.mass) + Real(scene_.gravity[static_cast<Eigen::Index>(c)])
                    : Real(0);
      }
    }
  }

  // 1/2 v'Mv + V [J]; weights of pinned nodes do not count.
  Real energy(const Vector& x, const Vector& v) const {
    Real sum = 0;
    for (const Spring& spring : scene_.springs) {
      const auto [i, j] = spring.nodes;
      Real l2 = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Real d = x[3 * j + c] - x[3 * i + c];
        l2 += d * d;
      }
      const Real s = plain_root(l2) - Real(spring.law.rest_length);
      sum += s * s * (Real(spring.law.stiffness) / 2 + Real(spring.law.quartic) / 4 * s * s);
    }
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Node& node = scene_.nodes[i];
      if (node.pinned) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const Real g = scene_.gravity[static_cast<Eigen::Index>(c)], w = v[3 * i + c];
        sum += Real(node.mass) * (w * w / 2 - g * x[3 * i + c]);
      }
    }
    return sum;
  }

  // Moves massless nodes to a place without force, a minimum of V; false if Newton's iteration
  // finds none. Does nothing without massless nodes.
  bool place_massless(Vector& x) const;

 private:
  static Real tension(const SpringLaw& law, Real l) {
    const Real s = l - Real(law.rest_length);
    return s * (Real(law.stiffness) + Real(law.quartic) * s * s);
  }

  Scene scene_;
  std::vector<std::size_t> massless_;
};

}  // namespace tests
}  // namespace qddot

#include "tests/independent/plain_massless.hpp"
