#pragma once

#include <memory>
#include <string>
#include <vector>

#include "python/extension/arrays.hpp"
#include "python/extension/own_forces.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/trial.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::python {

using Names = std::vector<std::string>;

// The model that is run: the smallest system of a scene, or a system of the caller's own.
struct HeldModel {
  std::shared_ptr<const Model> model;
  // The scene as its motion starts; null for a system of the caller's own.
  std::shared_ptr<const Scene> start{};
};

// All reductions but these; throws std::invalid_argument for a name that is none.
Reductions reductions_without(const std::vector<std::string>& kept);

// A certified motion and its model.
struct HeldReference {
  HeldModel of;
  measure::Reference reference;
};

// The options of a dictionary, whose keys are those of Options; `solver` is a name.
Options options_of(const py::dict& given);

// "positions", "path" or "energy"; throws std::invalid_argument for anything else.
measure::AccuracyOf accuracy_of(const std::string& of);

// A summary, an error or a point of a chart as a dictionary.
py::dict record_of(const Counts& counts);
py::dict record_of(const Summary& summary);
py::dict record_of(const measure::Errors& errors);
py::dict record_of(const measure::Point& point);

// Each adds its functions and classes to the module.
void add_methods(py::module_& module);
void add_scenes(py::module_& module);
void add_models(py::module_& module);
void add_runs(py::module_& module);
void add_analyses(py::module_& module);
void add_measures(py::module_& module);

// The sentence with the programs' options as Python spells them: step_size for --step-size, and
// keep for --no-reduce.
std::string in_python(const std::string& sentence);

}  // namespace qddot::python
