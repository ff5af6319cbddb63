#pragma once

#include <utility>

#include "tests/independent/plain_model.hpp"

namespace qddot {
inline namespace tests {

// Newton's iteration on -K d = f over the coordinates of the massless nodes in the scene's
// dimension, by Cholesky's factorisation without blocks. If a pivot is not positive, the place is
// no minimum. Steps are halved while they do not lower the potential of the springs.
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
    spring_forces(x, f);
    std::fill(k.begin(), k.end(), Real(0));
    Real largest_entry = 0;
    for (const Spring& spring : scene_.springs) {
      const auto [i, j] = spring.nodes;
      if (number[i] == n && number[j] == n) continue;
      Real e[3], l2 = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        e[c] = x[3 * j + c] - x[3 * i + c];
        l2 += e[c] * e[c];
      }
      const Real l = plain_root(l2);
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

}  // namespace tests
}  // namespace qddot
