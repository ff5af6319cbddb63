#pragma once

#include <cmath>

#include "qddot/model/system.hpp"

namespace qddot::inline measure {

// The frequency of a motion's kinetic energy, sqrt(<q'' M q''> / <q' M q'>) [rad/s], from the
// states that it is shown. It is w for a vibration q'' = -w^2 q seen over whole periods.
class KineticFrequency {
 public:
  // Borrows the system, which must outlive it.
  explicit KineticFrequency(const System& system) : system_(system), f_(system.size()) {}

  // Takes one force.
  void see(const State& state) {
    const Vec& mass = system_.mass();
    system_.force(state, f_);
    for (Index i = 0; i < f_.size(); ++i) {
      if (mass[i] > 0) accelerations_ += f_[i] * f_[i] / mass[i];
    }
    velocities_ += 2 * system_.kinetic(state.v);
  }
  // Zero if nothing moved.
  double value() const { return velocities_ > 0 ? std::sqrt(accelerations_ / velocities_) : 0; }

 private:
  const System& system_;
  Vec f_;
  double accelerations_ = 0, velocities_ = 0;
};

}  // namespace qddot::inline measure
