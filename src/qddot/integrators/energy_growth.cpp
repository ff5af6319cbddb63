#include "qddot/integrators/energy_growth.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

// See the class.
constexpr double part_a_gap = 0.5, longest_gap = 256, work_an_energy = 500, dear_step = 20;
// A state is kept, at the cost of a copy, if what is large there has grown by this factor.
constexpr double grown = 1.2;
// Rounding cannot have made a smaller part of D, if the motion is any.
constexpr double large_loss = 1e-3;
constexpr double largest = 1e300;
// Beyond |v| = 1e20 m/s a run is about to fail, and its last states had better be left alone.
constexpr double hopeless_squared = 1e40;
constexpr int never = 1 << 30;
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
  steps_ = 1;
  fast_ = 0;
  next_energy_ = work_an_energy;
  random_ = 1;
  if (!is_conserved_) return;
  q_ = state.q;
  const double kinetic = system_.kinetic(state.v);
  fastest_ = {kinetic, state.dissipated, state.q, state.v};
  farthest_ = {0, state.dissipated, state.q, state.v};
  lowest_ = system_.potential(state.q);
  start_ = most_ = kinetic + lowest_ + state.dissipated;
}

void EnergyGrowth::look_sooner(double squared_speed) {
  if (squared_speed >= hopeless_squared) {
    until_look_ = never;
    return;
  }
  fast_ = 2 * squared_speed;
  steps_ -= until_look_ - 1;
  until_look_ = 1;
}

// A random number in [0, 2), of mean 1.
double EnergyGrowth::drawn() {
  random_ = 1664525 * random_ + 1013904223;  // Press et al., Numerical Recipes, 2nd ed., 7.1
  return std::ldexp(static_cast<double>(random_), -31);
}

void EnergyGrowth::look(const State& state, double work) {
  const bool is_dear = work >= dear_step * steps_;
  const double gap = std::min({part_a_gap * steps_, longest_gap, work_an_energy * steps_ / work});
  until_look_ = is_dear ? 1 : std::max(1, static_cast<int>(std::lround(drawn() * gap)));
  steps_ += until_look_;
  if (!is_conserved_) return;
  propose(fastest_, system_.kinetic(state.v), state);
  propose(farthest_, (state.q - q_).squaredNorm(), state);
  if (!is_dear && work < next_energy_) return;
  see(state.q, state.v, state.dissipated);
  next_energy_ = work + drawn() * work_an_energy;
}

void EnergyGrowth::propose(Candidate& candidate, double size, const State& state) {
  if (!(size > grown * candidate.size)) return;
  candidate.size = size;
  candidate.dissipated = state.dissipated;
  candidate.q = state.q;
  candidate.v = state.v;
}

double EnergyGrowth::see(const Vec& q, const Vec& v, double dissipated) {
  const double potential = system_.potential(q);
  const double energy = system_.kinetic(v) + potential + dissipated;
  most_ = std::max(most_, std::isfinite(energy) ? energy : largest);
  lowest_ = std::min(lowest_, potential);
  return energy;
}

// The change of V by one rounding of the positions at the start.
double EnergyGrowth::rounding() {
  const double potential = system_.potential(q_);
  double most = machine_epsilon * std::abs(potential);
  for (const int period : {1, 2, 3}) {
    Vec& near = fastest_.q;  // scratch from here on
    near = q_;
    for (Index i = 0; i < q_.size(); ++i) {
      near[i] *= 1 + (i % period == 0 ? 4 : -4) * machine_epsilon;
    }
    most = std::max(most, std::abs(system_.potential(near) - potential));
  }
  return 4 * most;
}

EnergyChange EnergyGrowth::change(const State& state) {
  if (!is_conserved_) return {};
  see(fastest_.q, fastest_.v, fastest_.dissipated);
  see(farthest_.q, farthest_.v, farthest_.dissipated);
  const double lost = start_ - see(state.q, state.v, state.dissipated), gained = most_ - start_;
  EnergyChange change{.lost = std::max(0.0, lost), .own = start_ - lowest_};
  const bool is_own = gained <= change.own;
  if (is_own && change.own > 0) change.growth += gained / change.own;
  if (is_own && !(lost > large_loss * change.own)) return change;
  // A run that grew from its first step on has no other energy of its own.
  if (!is_own) {
    const double ahead = lowest_ahead(system_, q_, fastest_.q, fastest_.v);
    change.own = std::max(change.own, start_ - ahead);
  }
  const double unsure = rounding(), many = unsure + 4 * machine_epsilon * std::abs(most_);
  if (lost <= many) change.lost = 0;
  if (is_own || gained <= many) return change;
  const double growth = 1 + gained / std::max(change.own, unsure);
  // An energy that overflows at the start gives no growth.
  if (!std::isnan(growth)) change.growth = std::min(growth, largest);
  return change;
}

}  // namespace qddot
