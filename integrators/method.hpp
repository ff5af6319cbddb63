#pragma once

#include <algorithm>
#include <complex>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "qddot/integrators/integrator.hpp"
#include "qddot/integrators/set_of.hpp"

namespace qddot {

enum class Family { hand_written, sundials };
enum class Knob { step_size, rtol };

// As they are written to tables.
constexpr const char* family_name(Family family) {
  return family == Family::hand_written ? "hand-written" : "sundials";
}
constexpr const char* knob_name(Knob knob) {
  return knob == Knob::step_size ? "step_size" : "rtol";
}

// What a method is.
enum class Trait {
  implicit,           // solves equations in each step
  linearly_implicit,  // solves with M - h^2 K(q_n) once a step, whatever its signs: where
                      // compressed springs make that singular a step may go anywhere
  symplectic,
  cancels_torques,   // keeps angular momentum without being symplectic
  accepts_massless,  // runs systems with nodes of no mass
  interpolates,      // between its steps, for an Observer
  bounds_steps,      // holds its steps to 1/w_max, where the system has K
};

// What a method asks of a system beside its forces.
enum class Need {
  stiffness,           // K
  constant_stiffness,  // K that is the same everywhere
  split_forces,        // SplitForces, of which a system may have none when the method is made: the
                       // method asks for it from start() on
  discrete_gradient,   // DiscreteGradient
  laplacian,           // Laplacian
};

// Which of Options a method listens to, beside its knob and scales.
enum class Option {
  max_order,  // then `order` is the highest that it can take
  stability_detection,
  iterations,
  solve_tolerance,
  spectral_radius,
  solver,
  compensated,
};

// What the registry knows of a method. Tables, tests and experiments are driven by this alone.
struct Method {
  std::string name;
  std::string summary;  // one line
  std::string source;   // where the formula is from
  int order = 1;        // of the global error in q and v; 0: there is none, whatever the step
  Family family = Family::hand_written;
  Knob knob = Knob::step_size;
  // To be declared for explicit methods of fixed steps: on q'' = -w^2 q the motion grows where h w
  // is above it, by theory; 0 where it does so at every h. Others have none (linear_limit below).
  std::optional<double> stability_limit{};
  // The roots, at h w, of the recurrence that positions obey on q'' = -w^2 q, the one that decides
  // first. For methods whose steps depend on more steps before than show in a run.
  std::vector<std::complex<double>> (*recurrence_roots)(double h_omega) = nullptr;
  SetOf<Trait> traits{};
  SetOf<Need> needs{};
  SetOf<Option> takes{};
  // The method that this one is with SUNDIALS' own matrix and solver; empty where it is none.
  std::string stock_of{};
  std::unique_ptr<Integrator> (*make)(const Method&, const System&, const Options&) = nullptr;

  bool is(Trait trait) const { return traits.has(trait); }
  bool asks(Need need) const { return needs.has(need); }
  bool listens_to(Option option) const { return takes.has(option); }
  // Whether it changes its order as it goes.
  bool varies_order() const { return listens_to(Option::max_order); }
};

// The largest h w at which the method of fixed steps does not let q'' = -w^2 q grow; infinite where
// there is no limit or none is known.
inline double linear_limit(const Method& method) {
  return method.stability_limit.value_or(std::numeric_limits<double>::infinity());
}

// Whether the system's forces are divided into stiff and soft ones, in each of its blocks that has
// unknowns.
inline bool is_split(const System& system) {
  const auto blocks = blocks_of(system);
  if (blocks.empty()) return system.size() == 0 || split_of(system);
  return std::ranges::all_of(blocks, [](const auto& block) { return is_split(*block); });
}

// Why the method cannot be used on the system at all, whatever its masses; nothing where it can.
inline std::optional<Outcome> misfit(const Method& method, const System& system) {
  if (method.asks(Need::stiffness) && !system.has_stiffness()) return Outcome::no_stiffness;
  if (method.asks(Need::constant_stiffness) && !system.stiffness_is_constant())
    return Outcome::stiffness_varies;
  if (method.asks(Need::split_forces) && !is_split(system)) return Outcome::no_stiff_set;
  if (method.asks(Need::laplacian) && system.size() > 0 && !capability<Laplacian>(system))
    return Outcome::no_laplacian;
  if (method.asks(Need::discrete_gradient) && system.size() > 0 &&
      !capability<DiscreteGradient>(system))
    return Outcome::no_discrete_gradient;
  return {};
}
inline bool applies_to(const Method& method, const System& system) {
  return !misfit(method, system);
}

// For Method::make: constructs an integrator of class T.
template <class T>
std::unique_ptr<Integrator> create(const Method& method, const System& system,
                                   const Options& options) {
  return std::make_unique<T>(method, system, options);
}

}  // namespace qddot
