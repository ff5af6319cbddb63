#include <array>

#include "python/extension/bindings.hpp"
#include "qddot/integrators/integrator.hpp"
#include "qddot/measure/motion/simulation.hpp"

namespace qddot::python {
namespace {

template <class Kind, std::size_t count>
py::tuple names_in(const SetOf<Kind>& set, const std::array<const char*, count>& names) {
  py::list held;
  for (std::size_t i = 0; i < count; ++i) {
    if (set.has(static_cast<Kind>(i))) held.append(names[i]);
  }
  return py::tuple(held);
}

// These have the order of the enumerations in method.hpp.
constexpr std::array trait_names = {"implicit",        "linearly_implicit", "symplectic",
                                    "cancels_torques", "accepts_massless",  "interpolates",
                                    "bounds_steps",    "reversible",        "remembers_steps"};
constexpr std::array need_names = {"stiffness", "constant_stiffness", "split_forces",
                                   "discrete_gradient", "laplacian"};
constexpr std::array option_names = {"max_order",       "stability_detection", "iterations",
                                     "solve_tolerance", "spectral_radius",     "solver",
                                     "compensated"};

py::dict method_record(const Method& method) {
  using py::arg;
  return py::dict(
      arg("name") = method.name, arg("summary") = method.summary, arg("source") = method.source,
      arg("order") = method.order, arg("family") = family_name(method.family),
      arg("knob") = knob_name(method.knob), arg("stability_limit") = method.stability_limit,
      arg("traits") = names_in(method.traits, trait_names),
      arg("needs") = names_in(method.needs, need_names),
      arg("takes") = names_in(method.takes, option_names), arg("stock_of") = method.stock_of);
}

py::list records() {
  py::list all;
  for (const Method& method : methods()) all.append(method_record(method));
  return all;
}

}  // namespace

Options options_of(const py::dict& given) {
  Options options;
  const auto take = [&](const char* name, auto& to) {
    if (given.contains(name)) to = given[name].template cast<std::decay_t<decltype(to)>>();
  };
  take("step_size", options.step_size);
  take("rtol", options.rtol);
  take("atol", options.atol);
  take("max_order", options.max_order);
  take("stability_detection", options.stability_detection);
  take("iterations", options.iterations);
  take("solve_tolerance", options.solve_tolerance);
  take("spectral_radius", options.spectral_radius);
  take("compensated", options.compensated);
  if (given.contains("solver")) {
    const auto name = given["solver"].cast<std::string>();
    const auto solver = find_solver(name);
    if (!solver)
      throw std::invalid_argument("solver: " + name + " is none; allowed are " + solver_list());
    options.solver = *solver;
  }
  return options;
}

void add_methods(py::module_& module) { module.def("methods", &records); }

}  // namespace qddot::python
