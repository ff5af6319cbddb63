#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace qddot::judged_advice {

// Random numbers that follow from a seed. The distributions of the standard library differ between
// machines.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : state_(seed) {}

  // Uniform in [0, 1): SplitMix64 (Steele, Lea and Flood, OOPSLA 2014).
  double unit() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double between(double low, double high) { return low + (high - low) * unit(); }
  double by_logarithm(double low, double high) { return low * std::pow(high / low, unit()); }
  int whole(double low, double high) {
    return static_cast<int>(std::floor(by_logarithm(low, high + 1)));
  }
  int one_of(int count) { return static_cast<int>(unit() * count); }
  bool happens(double probability) { return unit() < probability; }
  Eigen::Vector3d in_box(int dimension, double size) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int i = 0; i < dimension; ++i) x[i] = between(-size, size);
    return x;
  }

 private:
  std::uint64_t state_;
};

}  // namespace qddot::judged_advice
