// The private module _qddot for the typed layer in python/qddot. It takes and returns plain data
// and NumPy arrays, and holds scenes, models and references.
#include <algorithm>
#include <regex>

#include "python/extension/bindings.hpp"
#include "python/extension/outside.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::python {
namespace {

// A class of exceptions of the module's own; it lives as long as the process.
template <class Thrown>
void add_exception(py::module_& module, const char* name, PyObject* base, const char* doc) {
  static PyObject* type = nullptr;
  type = PyErr_NewExceptionWithDoc((std::string("qddot.") + name).c_str(), doc, base, nullptr);
  if (!type) throw py::error_already_set();
  module.attr(name) = py::reinterpret_borrow<py::object>(type);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Thrown& error) {
      PyErr_SetString(type, in_python(error.what()).c_str());
    }
  });
}

}  // namespace

std::string in_python(const std::string& sentence) {
  static const std::regex option("--(no-reduce (?=dimension|massless)|[a-z][a-z-]*[a-z])");
  std::string words;
  auto rest = sentence.begin();
  for (std::sregex_iterator at(sentence.begin(), sentence.end(), option), end; at != end; ++at) {
    std::string name = (*at)[1];
    std::ranges::replace(name, '-', '_');
    words.append(rest, (*at)[0].first);
    words += name == "no_reduce" ? "keep" : name == "no_reduce " ? "keep=" : name;
    rest = (*at)[0].second;
  }
  return words.append(rest, sentence.end());
}

}  // namespace qddot::python

PYBIND11_MODULE(_qddot, module) {
  namespace py = pybind11;
  using namespace qddot;
  module.attr("__version__") = QDDOT_VERSION;
  python::add_exception<InvalidInput>(
      module, "InvalidInput", PyExc_ValueError,
      "Wrong input for a scene; says where, what is wrong and what is allowed.");
  python::add_exception<measure::NoReference>(module, "NoReference", PyExc_RuntimeError,
                                              "No reference can be made of a motion; says why.");
  python::prepare_for_forks();
  // Before the interpreter exits, work ends: a thread with work would not get the GIL back.
  py::module_::import("atexit").attr("register")(py::cpp_function(&python::close_outside));
  python::add_methods(module);
  python::add_scenes(module);
  python::add_models(module);
  python::add_runs(module);
  python::add_analyses(module);
  python::add_measures(module);
}
