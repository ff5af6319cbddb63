#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "qddot/scene/scene.hpp"

namespace qddot {
inline namespace tests {

// What a random scene is made by: draws from a seed, the same on every system, and the scene so
// far.
class SceneDraws {
 protected:
  using Vector = Eigen::Vector3d;

  explicit SceneDraws(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  // 10 to a uniform power.
  double power(double low, double high) { return std::pow(10, uniform(low, high)); }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  bool is(double probability) { return uniform(0, 1) < probability; }
  // Each component by a draw of its own, up to the size; zero beyond the dimension.
  Vector vector(double size) {
    Vector x = Vector::Zero();
    for (int d = 0; d < scene_.dimension; ++d) x[d] = uniform(-size, size);
    return x;
  }
  // A random direction.
  Vector direction() {
    for (;;) {
      const Vector x = vector(1);
      const double square = x.squaredNorm();
      if (square > 0.01 && square <= 1) return x / std::sqrt(square);
    }
  }

  Scene scene_;

 private:
  std::mt19937_64 random_;
};

}  // namespace tests
}  // namespace qddot
