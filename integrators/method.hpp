#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "qddot/integrators/integrator.hpp"

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

// What the registry knows of a method. Tables, tests and experiments are driven by this alone.
struct Method {
  std::string name;
  std::string summary;  // one line
  std::string source;   // where the formula is from
  int order = 1;        // of the global error in q and v; 0: there is none, whatever the step
  Family family = Family::hand_written;
  Knob knob = Knob::step_size;
  bool implicit = false;
  // To be declared for explicit methods of fixed steps: on q'' = -w^2 q the motion grows where h w
  // is above it, by theory; 0 where it does so at every h. Others have none (linear_limit below).
  std::optional<double> stability_limit{};
  // Solves with M - h^2 K(q_n) once a step, whatever its signs: where compressed springs make it
  // singular a step may go anywhere.
  bool linearly_implicit = false;
  bool symplectic = false;
  bool needs_stiffness = false;
  bool accepts_massless = false;
  bool needs_constant_stiffness = false;
  bool varies_order = false;         // up to `order`, or to Knobs::max_order
  bool detects_instability = false;  // listens to Knobs::stability_detection
  bool interpolates = false;         // between its steps, for an Observer
  // Takes the forces of SplitForces, of which a system may have none when the method is made:
  // it may be asked for from start() on.
  bool needs_split = false;
  bool needs_discrete_gradient = false;  // takes the f of DiscreteGradient
  bool needs_laplacian = false;          // takes the L of Laplacian
  bool takes_iterations = false;         // listens to Knobs::iterations,
  bool takes_solve_tolerance = false;    // Knobs::solve_tolerance
  bool takes_spectral_radius = false;    // Knobs::spectral_radius,
  bool takes_solver = false;             // Knobs::solver
  bool takes_compensation = false;       // and Knobs::compensated
  std::unique_ptr<Integrator> (*make)(const Method&, const System&, const Knobs&) = nullptr;
};

// The largest h w at which the method of fixed steps does not let q'' = -w^2 q grow; infinite for
// implicit ones, which are A-stable, for the exact motion, and where no limit is known.
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
  if (method.needs_stiffness && !system.has_stiffness()) return Outcome::no_stiffness;
  if (method.needs_constant_stiffness && !system.stiffness_is_constant())
    return Outcome::stiffness_varies;
  if (method.needs_split && !is_split(system)) return Outcome::no_stiff_set;
  if (method.needs_laplacian && system.size() > 0 && !capability<Laplacian>(system))
    return Outcome::no_laplacian;
  if (method.needs_discrete_gradient && system.size() > 0 && !capability<DiscreteGradient>(system))
    return Outcome::no_discrete_gradient;
  return {};
}
inline bool applies_to(const Method& method, const System& system) {
  return !misfit(method, system);
}

// For Method::make: constructs an integrator of class T.
template <class T>
std::unique_ptr<Integrator> create(const Method& method, const System& system, const Knobs& knobs) {
  return std::make_unique<T>(method, system, knobs);
}

}  // namespace qddot
