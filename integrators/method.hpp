#pragma once

#include <memory>
#include <string>

#include "integrators/integrator.hpp"

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
  // Of explicit methods: on q'' = -w^2 q the motion blows up where h w is above it.
  double stability_limit = 2;
  bool symplectic = false;
  bool needs_stiffness = false;
  bool accepts_massless = false;
  bool needs_constant_stiffness = false;
  bool varies_order = false;  // up to `order`, or to Knobs::max_order
  std::unique_ptr<Integrator> (*make)(const Method&, const System&, const Knobs&) = nullptr;
};

// Whether the method can be used on the system at all, as far as K decides.
inline bool applies_to(const Method& method, const System& system) {
  return !method.needs_constant_stiffness || system.stiffness_is_constant();
}

// For Method::make: constructs an integrator of class T.
template <class T>
std::unique_ptr<Integrator> create(const Method& method, const System& system, const Knobs& knobs) {
  return std::make_unique<T>(method, system, knobs);
}

}  // namespace qddot
