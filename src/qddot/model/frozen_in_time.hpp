#pragma once

#include "qddot/model/system.hpp"

namespace qddot {

// A system at one time: V, f and K as they are then, without capabilities. For searches among
// positions alone, such as that of an equilibrium.
class FrozenInTime final : public System {
 public:
  // Borrows the system, which must outlive it.
  FrozenInTime(const System& system, double t) : System(system.mass()), system_(system), t_(t) {}

  void set_time(double t) { t_ = t; }  // [s]; not while another thread uses it

  double potential(const At& at) const override { return system_.potential({t_, at.q}); }
  bool has_potential() const override { return system_.has_potential(); }
  void force(const At& at, MutableVec f) const override { system_.force({t_, at.q}, f); }
  void stiffness(const At& at, SymmetricMatrix& k) const override {
    system_.stiffness({t_, at.q}, k);
  }
  const SymmetricMatrix& stiffness_pattern() const override { return system_.stiffness_pattern(); }
  bool has_stiffness() const override { return system_.has_stiffness(); }
  bool stiffness_is_constant() const override { return system_.stiffness_is_constant(); }

 private:
  const System& system_;
  double t_;
};

}  // namespace qddot
