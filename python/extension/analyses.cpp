#include <pybind11/complex.h>

#include "python/extension/bindings.hpp"
#include "python/extension/outside.hpp"
#include "qddot/analysis/equilibrium.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/stability/linear_limit.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::python {
namespace {

using py::arg;

// A scene in all directions in which its nodes may move, or an own system as it is.
std::shared_ptr<const Model> all_directions(const HeldModel& held) {
  if (!held.start) return held.model;
  return std::make_shared<const Model>(*held.start, Reductions::all_directions());
}

// The equilibrium downhill from the model's start; `length` [m] is the size of an own system.
py::dict equilibrium(const HeldModel& held, double length) {
  std::shared_ptr<const Model> model;
  Equilibrium rest;
  double energy = 0;
  outside(1, [&](const std::stop_token&) {
    model = all_directions(held);
    rest = held.start ? equilibrium_of(*model)
                      : find_equilibrium(model->system(), model->initial().q, length);
    energy = model->potential({0, rest.q, Vec::Zero(rest.q.size())});
  });
  const auto nodes = model->expand({0, rest.q, Vec::Zero(rest.q.size())});
  return py::dict(arg("outcome") = name(rest.outcome), arg("message") = in_python(rest.message),
                  arg("positions") = array_of(nodes, &Node::position, model->dimension()),
                  arg("potential") = energy, arg("residual") = rest.residual,
                  arg("smallest_eigenvalue") = rest.smallest_eigenvalue,
                  arg("isolated") = rest.isolated, arg("flat_directions") = rest.flat_directions,
                  arg("iterations") = rest.iterations);
}

// The lowest modes about the start: w^2 and their shapes as displacements of all nodes.
py::dict modes(const HeldModel& held, Index count) {
  std::shared_ptr<const Model> model;
  NaturalModes lowest;
  Vec zeta;
  double largest = 0;
  outside(1, [&](const std::stop_token&) {
    model = all_directions(held);
    lowest = lowest_modes(model->system(), model->initial().q, count);
    largest = largest_frequency(model->system(), model->initial().q);
    // Slower motions are resisted by nothing, within rounding.
    const double slowest = 1e-6 * largest;
    zeta.setConstant(lowest.squares.size(), std::numeric_limits<double>::quiet_NaN());
    for (Index j = 0; j < zeta.size(); ++j) {
      if (!(lowest.squares[j] > slowest * slowest)) continue;
      zeta[j] = damping_ratio(model->system(), model->initial().q, lowest.shapes.col(j),
                              std::sqrt(lowest.squares[j]));
    }
  });
  const int d = model->dimension();
  py::list shapes;
  for (Index j = 0; j < lowest.shapes.cols(); ++j) {
    // A displacement is expanded as a velocity.
    const auto nodes = model->expand({0, model->initial().q, lowest.shapes.col(j)});
    shapes.append(array_of(nodes, &Node::velocity, d));
  }
  return py::dict(arg("squares") = array_of(lowest.squares), arg("shapes") = shapes,
                  arg("zeta") = array_of(zeta), arg("omega_max") = largest,
                  arg("finite") = finite_modes(model->system()));
}

py::dict linear_step(const std::string& name, double h_omega, const py::dict& given) {
  const measure::LinearStep step = measure::linear_step(method(name), h_omega, options_of(given));
  return py::dict(arg("h_omega") = step.h_omega, arg("roots") = py::tuple(py::cast(step.roots)),
                  arg("spectral_radius") = step.spectral_radius(),
                  arg("damping_ratio") = step.damping_ratio(),
                  arg("period_error") = step.period_error());
}

}  // namespace

void add_analyses(py::module_& module) {
  module.def("equilibrium", &equilibrium);
  module.def("modes", &modes);
  module.def("linear_step", &linear_step);
  // The largest h w at which a method does not let an oscillation grow, by theory and as measured.
  module.def("stability_limit", [](const std::string& name) {
    const Method& chosen = method(name);
    if (chosen.knob != Knob::step_size)
      throw std::invalid_argument(name +
                                  " chooses its steps by itself, so that it has no limit of "
                                  "h w; allowed are methods whose knob is step_size");
    const double measured = made_outside([&] { return measure::measured_limit(chosen); });
    return py::make_tuple(linear_limit(chosen), measured);
  });
  module.def("largest_frequency", [](const HeldModel& held) {
    return made_outside(
        [&] { return largest_frequency(held.model->system(), held.model->initial().q); });
  });
}

}  // namespace qddot::python
