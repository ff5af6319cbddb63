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
double lowest_ahead(const System& system, const At& start, Vec& ahead, Vec& way) {
  const double t = start.t;
  const VecView& q = start.q;
  system.force({t, q}, way);
  for (Index i = 0; i < way.size(); ++i) {
    way[i] = system.mass()[i] > 0 ? way[i] / system.mass()[i] : 0;
  }
  double lowest = system.potential({t, q});
  for (double s = shortest_way; s < longest_way; s *= 2) {
    ahead = q + s * way;
    const double potential = system.potential({t, ahead});
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
  t_ = state.t;
  fastest_ = {kinetic, state};
  farthest_ = {0, state};
  lowest_ = potential(state);
  start_ = most_ = kinetic + lowest_ + state.work.taken();
  driven_ = 0;
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
  see_present(state);
  next_energy_ = work + drawn() * work_an_energy;
}

void EnergyGrowth::propose(Candidate& candidate, double size, const State& state) {
  if (!(size > grown * candidate.size)) return;
  candidate.size = size;
  candidate.state = state;
  candidate.state.phases = phases_;
}

double EnergyGrowth::see_present(const State& state) {
  if (!phases_) return see(state);
  State present = state;
  present.phases = phases_;
  return see(present);
}

double EnergyGrowth::see(const State& state) {
  const double potential = this->potential(state);
  const double energy = system_.kinetic(state.v) + potential + state.work.taken();
  driven_ = std::max(driven_, std::abs(state.work.driven));
  most_ = std::max(most_, std::isfinite(energy) ? energy : largest);
  lowest_ = std::min(lowest_, potential);
  return energy;
}

// The change of V by one rounding of the positions at the start.
double EnergyGrowth::rounding() {
  const double potential = system_.potential({t_, q_});
  double most = machine_epsilon * std::abs(potential);
  for (const int period : {1, 2, 3}) {
    Vec& near = fastest_.state.q;  // scratch from here on
    near = q_;
    for (Index i = 0; i < q_.size(); ++i) {
      near[i] *= 1 + (i % period == 0 ? 4 : -4) * machine_epsilon;
    }
    most = std::max(most, std::abs(system_.potential({t_, near}) - potential));
  }
  return 4 * most;
}

EnergyChange EnergyGrowth::change(const State& state) {
  if (!is_conserved_) return {};
  see(fastest_.state);
  see(farthest_.state);
  const double lost = start_ - see_present(state), gained = most_ - start_;
  EnergyChange change{.lost = std::max(0.0, lost), .own = start_ - lowest_ + driven_};
  const bool is_own = gained <= change.own;
  if (is_own && change.own > 0) change.growth += gained / change.own;
  if (is_own && !(lost > large_loss * change.own)) return change;
  // A run that grew from its first step on has no other energy of its own.
  if (!is_own) {
    const double ahead = lowest_ahead(system_, {t_, q_}, fastest_.state.q, fastest_.state.v);
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
