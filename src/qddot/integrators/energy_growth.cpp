#include "qddot/integrators/energy_growth.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

// The number of steps between two looks at the kinetic energy, each a tenth of a step's time. Then
// the number of such looks between two at the whole energy, each several forces' time.
constexpr int steps_a_look = 32, looks_an_energy = 32;
constexpr double largest = 1e300;
// [s^2]: vibrations of 1e9 to 1 rad/s.
constexpr double shortest_way = 1e-18, longest_way = 1;

// The lowest V on the path q + s M^-1 f, along which a motion from rest at q begins. V falls there
// at first. Each s is twice the last one. `ahead` and `way` are scratch.
double lowest_ahead(const System& system, const Vec& q, Vec& ahead, Vec& way) {
  system.force(q, way);
  for (Index i = 0; i < way.size(); ++i) {
    way[i] = system.mass()[i] > 0 ? way[i] / system.mass()[i] : 0;
  }
  double lowest = system.potential(q);
  for (double s = shortest_way; s < longest_way; s *= 2) {
    ahead = q + s * way;
    const double potential = system.potential(ahead);
    if (potential < lowest) lowest = potential;
  }
  return lowest;
}

}  // namespace

void EnergyGrowth::start(const State& state) {
  until_look_ = 1;
  looks_ = 0;
  if (!system_.has_potential()) return;
  q_ = q_of_kinetic_ = state.q;
  v_of_kinetic_ = state.v;
  kinetic_ = system_.kinetic(state.v);
  lowest_ = system_.potential(state.q);
  start_ = most_ = kinetic_ + lowest_;
}

void EnergyGrowth::look(const State& state) {
  until_look_ = steps_a_look;
  if (!system_.has_potential()) return;
  const double kinetic = system_.kinetic(state.v);
  if (kinetic > 2 * kinetic_) {
    kinetic_ = kinetic;
    q_of_kinetic_ = state.q;
    v_of_kinetic_ = state.v;
  }
  if (++looks_ % looks_an_energy == 0) see(state.q, state.v);
}

void EnergyGrowth::see(const Vec& q, const Vec& v) {
  const double potential = system_.potential(q), energy = system_.kinetic(v) + potential;
  most_ = std::max(most_, std::isfinite(energy) ? energy : largest);
  lowest_ = std::min(lowest_, potential);
}

// The change of V by one rounding of the positions at the start.
double EnergyGrowth::rounding() {
  const double potential = system_.potential(q_);
  double most = machine_epsilon * std::abs(potential);
  for (const int period : {1, 2, 3}) {
    q_of_kinetic_ = q_;
    for (Index i = 0; i < q_.size(); ++i) {
      q_of_kinetic_[i] *= 1 + (i % period == 0 ? 4 : -4) * machine_epsilon;
    }
    most = std::max(most, std::abs(system_.potential(q_of_kinetic_) - potential));
  }
  return 4 * most;
}

double EnergyGrowth::factor(const State& state) {
  if (!system_.has_potential()) return 1;
  see(q_of_kinetic_, v_of_kinetic_);
  see(state.q, state.v);
  const double gained = most_ - start_;
  double own = start_ - lowest_;
  if (gained <= own) return own > 0 ? 1 + gained / own : 1;
  // A run that grew from its first step on has no other energy of its own.
  own = std::max(own, start_ - lowest_ahead(system_, q_, q_of_kinetic_, v_of_kinetic_));
  const double unsure = rounding();
  if (gained <= unsure + 4 * machine_epsilon * std::abs(most_)) return 1;
  const double growth = 1 + gained / std::max(own, unsure);
  // An energy that overflows at the start gives no growth.
  return std::isnan(growth) ? 1 : std::min(growth, largest);
}

}  // namespace qddot
