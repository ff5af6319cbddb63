#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "qddot/integrators/integrator.hpp"
#include "qddot/integrators/set_of.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {

struct Splitting;
struct NystromPair;
struct SymmetricFormula;

// Makes the stepper of a run (see create in base/fixed_steps.hpp).
using MakeStepper = std::unique_ptr<Stepper> (*)(SystemRun&);

enum class Family { hand_written, sundials };
// The option by which a method trades speed for accuracy.
enum class Knob { step_size, rtol };

// Their names in tables.
constexpr const char* family_name(Family family) {
  return family == Family::hand_written ? "hand-written" : "sundials";
}
constexpr const char* knob_name(Knob knob) {
  return knob == Knob::step_size ? "step_size" : "rtol";
}

// The damping with which a method keeps its order and stays stable (capability Damping): none, air
// without dashpots, or any. Methods of forces that depend on velocities take any.
enum class Damped { none, by_air, by_any };

// Properties of a method.
enum class Trait {
  implicit,           // solves equations in each step
  linearly_implicit,  // one solve with M - h^2 K(q_n) a step, whatever its signs: a step may go
                      // anywhere if compressed springs make it singular
  symplectic,
  cancels_torques,            // keeps angular momentum without being symplectic
  accepts_massless,           // runs systems with nodes of no mass,
  accepts_massless_dashpots,  // and where such nodes are on dashpots
  interpolates,               // interpolates between its steps for an Observer
  bounds_steps,               // holds its steps to 1/w_max if the system has K
  reversible,                 // fixed steps from the end with v turned round lead back to the start
  remembers_steps,  // a fixed step depends on earlier ones, not on q and v at its start alone
};

// Properties of a system, beside its forces, that a method needs.
enum class Need {
  constraints,         // Constraints, in a block at least; other methods refuse them
  stiffness,           // K
  constant_stiffness,  // K that is the same everywhere
  split_forces,        // Split, in each block
  discrete_gradient,   // DiscreteGradient
  laplacian,           // Laplacian
  potential,           // V
  conservative,        // a force that does not depend on velocities
  autonomous,          // a force, V and K that do not depend on time,
  rate_in_time,        // or Driving, for df/dt
  balance_in_time,     // or Driving, for the change of V in time
  known_in_time,       // or Driving, for forces that are sums of known functions of time
};

// A method as the registry knows it. Tables, tests and experiments use nothing else.
struct Method {
  std::string name;
  std::string summary;  // one line
  std::string source;   // the formula's publication
  int order = 1;        // of the global error in q and v; 0: no error at any step size
  Family family = Family::hand_written;
  Knob knob = Knob::step_size;
  // The largest h w at which the motion q'' = -w^2 q does not grow, by theory; 0 if it grows at
  // every h. Given for explicit fixed-step methods only (see linear_limit below).
  std::optional<double> stability_limit{};
  // The number of half steps by which friction of a leapfrog method is late; 0 for other methods.
  // With it a vibration q'' = -w^2 q - 2 zeta w q' does not grow up to the limit below.
  double friction_lag = 0;
  // The roots, at h w, of the recurrence of positions on such a vibration, the deciding one first;
  // zeta is 0 unless the method takes dashpots. Given for methods whose steps depend on more
  // earlier steps than a run shows.
  std::vector<std::complex<double>> (*recurrence_roots)(double h_omega, double zeta) = nullptr;
  // Whether a step solves linear equations, for the unknowns with stiff forces alone if a scene
  // names stiff springs.
  bool solves_stiff_part = false;
  SetOf<Trait> traits{};
  SetOf<Need> needs{};
  SetOf<Option> takes{};
  // The name of the method that this one repeats with SUNDIALS' own matrix and solver; else empty.
  std::string stock_of{};
  // The coefficients of a method of one of these families; nullptr for all others. Tests try the
  // order conditions of each.
  const Splitting* splitting = nullptr;                 // base/kick_drift.hpp
  const NystromPair* nystrom_pair = nullptr;            // base/nystrom_stages.hpp
  const SymmetricFormula* symmetric_formula = nullptr;  // base/symmetric_formula.hpp
  // The oldest SUNDIALS that has the method, 70100 for 7.1; 0 for all that qddot builds with.
  int needs_sundials = 0;
  // The damping that a method of conservative forces takes.
  Damped damped = Damped::none;
  // The reason for which it takes no damping, or no dashpots: "its kicks ...". Empty if it takes
  // any.
  const char* why_not_damped = "";
  // nullptr if this build's SUNDIALS is older.
  MakeStepper make = nullptr;

  bool is(Trait trait) const { return traits.has(trait); }
  bool asks(Need need) const { return needs.has(need); }
  bool listens_to(Option option) const { return takes.has(option); }
  // The damping that it takes.
  Damped takes_damping() const { return asks(Need::conservative) ? damped : Damped::by_any; }
  // Whether it ends steps at the times of an Observer, so that those change its steps.
  bool ends_steps_at_looks() const { return knob == Knob::rtol && !is(Trait::interpolates); }
  // Whether the method changes its order in a run.
  bool varies_order() const { return listens_to(Option::max_order); }
};

// The largest h w at which a fixed-step method does not let q'' = -w^2 q grow; infinite if there is
// no limit or none is known.
inline double linear_limit(const Method& method) {
  return method.stability_limit.value_or(std::numeric_limits<double>::infinity());
}

// The same with the damping ratio zeta, of a leapfrog method: 4 - 4 lag zeta h w - (h w)^2 = 0.
// NaN for other methods, unless zeta is 0.
inline double damped_limit(const Method& method, double zeta) {
  if (zeta == 0) return linear_limit(method);
  if (method.friction_lag == 0) return std::numeric_limits<double>::quiet_NaN();
  const double late = method.friction_lag * zeta;
  return 2 / (std::sqrt(1 + late * late) + late);
}

// Whether the forces are divided into stiff and soft ones, in each block that has unknowns.
inline bool is_split(const System& system) {
  const auto blocks = system.blocks();
  if (blocks.empty()) return system.size() == 0 || system.split();
  return std::ranges::all_of(blocks, [](const auto& block) { return is_split(*block); });
}

// Whether the forces are sums of known functions of time, in each block.
inline bool is_known_in_time(const System& system) {
  const auto blocks = system.blocks();
  if (blocks.empty())
    return system.is_autonomous() || (system.driving() && system.driving()->forcing(0));
  return std::ranges::all_of(blocks, [](const auto& block) { return is_known_in_time(*block); });
}

// The reason why the method cannot run on the system, whatever its masses; nothing if it can.
inline std::optional<Outcome> misfit(const Method& method, const System& system) {
  if (system.size() > 0 && method.asks(Need::constraints) != is_constrained(system))
    return method.asks(Need::constraints) ? Outcome::no_constraints : Outcome::refuses_constraints;
  if (method.asks(Need::stiffness) && !system.has_stiffness()) return Outcome::no_stiffness;
  if (method.asks(Need::constant_stiffness) && !system.stiffness_is_constant())
    return Outcome::stiffness_varies;
  if (method.asks(Need::split_forces) && !is_split(system)) return Outcome::no_stiff_set;
  if (method.asks(Need::laplacian) && system.size() > 0 && !system.laplacian())
    return Outcome::no_laplacian;
  if (method.asks(Need::discrete_gradient) && system.size() > 0 && !system.discrete_gradient())
    return Outcome::no_discrete_gradient;
  if (method.asks(Need::potential) && !system.has_potential()) return Outcome::no_potential;
  if (!system.is_conservative()) {
    const Damping* damping = system.damping();
    if (!damping && method.asks(Need::conservative)) return Outcome::not_conservative;
    const Damped takes = method.takes_damping();
    if (damping && takes != Damped::by_any && (damping->has_dashpots() || takes == Damped::none)) {
      return Outcome::refuses_damping;
    }
  }
  if (!system.is_autonomous() && system.size() > 0) {
    const bool needs_driving = method.asks(Need::rate_in_time) ||
                               method.asks(Need::balance_in_time) ||
                               method.asks(Need::known_in_time);
    if (method.asks(Need::autonomous) || (needs_driving && !system.driving()))
      return Outcome::not_autonomous;
    if (method.asks(Need::known_in_time) && !is_known_in_time(system))
      return Outcome::not_autonomous;
  }
  return {};
}
// Whether the method can run on the system, whatever its masses.
inline bool applies_to(const Method& method, const System& system) {
  return !misfit(method, system);
}

}  // namespace qddot
