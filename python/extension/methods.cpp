#include <array>

#include "python/extension/bindings.hpp"
#include "qddot/integrators/integrator.hpp"
#include "qddot/integrators/option_table.hpp"
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

// These have the order of the enumerations in method.hpp. Every force of Python is conservative and
// autonomous.
constexpr std::array trait_names = {"implicit",        "linearly_implicit", "symplectic",
                                    "cancels_torques", "accepts_massless",  "interpolates",
                                    "bounds_steps",    "reversible",        "remembers_steps"};
constexpr std::array need_names = {"constraints",  "stiffness",         "constant_stiffness",
                                   "split_forces", "discrete_gradient", "laplacian",
                                   "potential"};

py::tuple names_of_options(const Method& method) {
  py::list taken;
  for (const OptionRow& row : option_rows()) {
    if (is_of_takes(row) && takes(method, row)) taken.append(row.name);
  }
  return py::tuple(taken);
}

// "all", a knob's name, or "takes", after the option's row.
const char* takers_of(const OptionRow& row) {
  if (const Knob* knob = std::get_if<Knob>(&row.takers)) return knob_name(*knob);
  return is_of_takes(row) ? "takes" : "all";
}

py::dict method_record(const Method& method) {
  using py::arg;
  return py::dict(arg("name") = method.name, arg("summary") = method.summary,
                  arg("source") = method.source, arg("order") = method.order,
                  arg("family") = family_name(method.family), arg("knob") = knob_name(method.knob),
                  arg("stability_limit") = method.stability_limit,
                  arg("traits") = names_in(method.traits, trait_names),
                  arg("needs") = names_in(method.needs, need_names),
                  arg("takes") = names_of_options(method), arg("stock_of") = method.stock_of);
}

py::list records() {
  py::list all;
  for (const Method& method : methods()) all.append(method_record(method));
  return all;
}

py::list option_records() {
  using py::arg;
  py::list all;
  for (const OptionRow& row : option_rows()) {
    all.append(py::dict(arg("name") = row.name, arg("unit") = row.unit, arg("kind") = row.kind(),
                        arg("words") = in_python(row.words), arg("takers") = takers_of(row)));
  }
  return all;
}

void set(double& member, const py::handle& value) { member = value.cast<double>(); }
void set(int& member, const py::handle& value) { member = value.cast<int>(); }
void set(bool& member, const py::handle& value) { member = value.cast<bool>(); }
void set(Solver& member, const py::handle& value) {
  const auto name = value.cast<std::string>();
  const auto solver = find_solver(name);
  if (!solver)
    throw std::invalid_argument("solver: " + name + " is none; allowed are " + solver_list());
  member = *solver;
}

}  // namespace

Options options_of(const py::dict& given) {
  Options options;
  for (const OptionRow& row : option_rows()) {
    if (!given.contains(row.name)) continue;
    const py::handle value = given[row.name];
    std::visit([&](auto member) { set(options.*member, value); }, row.member);
  }
  return options;
}

void add_methods(py::module_& module) {
  module.def("methods", &records);
  module.def("why_not_built", &why_not_built);
  module.def("options", &option_records);
}

}  // namespace qddot::python
