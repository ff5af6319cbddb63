// The private module _qddot: what the typed layer in python/qddot calls. It takes and gives plain
// data and NumPy arrays; scenes, models and references are held by it.
#include "python/extension/bindings.hpp"
#include "qddot/measure/reference/no_reference.hpp"
#include "qddot/scene/invalid_input.hpp"

PYBIND11_MODULE(_qddot, module) {
  namespace py = pybind11;
  using namespace qddot;
  py::register_exception<InvalidInput>(module, "InvalidInput", PyExc_ValueError).attr("__doc__") =
      "A scene that cannot be; says where, what and what is allowed.";
  py::register_exception<measure::NoReference>(module, "NoReference", PyExc_RuntimeError)
      .attr("__doc__") = "No reference can be made of a motion; says why.";
  module.attr("__version__") = QDDOT_VERSION;
  python::add_methods(module);
  python::add_scenes(module);
  python::add_models(module);
  python::add_runs(module);
  python::add_analyses(module);
  python::add_measures(module);
  python::add_exchange(module);
}
