#include "experiments/error.hpp"

#include <algorithm>
#include <cmath>

namespace qddot {
namespace {

double divided(double error, double scale) { return scale > 0 ? error / scale : error; }

}  // namespace

double largest_norm(const Vec& x, int dimension) {
  return x.size() == 0 ? 0
                       : x.reshaped(dimension, x.size() / dimension).colwise().norm().maxCoeff();
}

void extend(Scales& scales, const ReducedScene& scene, const State& state) {
  const int d = scene.dimension();
  scales.displacement = std::max(scales.displacement, largest_norm(state.q - scene.initial().q, d));
  scales.speed = std::max(scales.speed, largest_norm(state.v, d));
  scales.kinetic = std::max(scales.kinetic, scene.system().kinetic(state.v));
}

Errors errors_between(const ReducedScene& scene, const State& state, const State& reference,
                      double energy, const Scales& scales) {
  const int d = scene.dimension();
  return {divided(largest_norm(state.q - reference.q, d), scales.displacement),
          divided(largest_norm(state.v - reference.v, d), scales.speed),
          divided(std::abs(total_energy(scene.system(), state) - energy), scales.kinetic)};
}

}  // namespace qddot
