#pragma once

#include "python/extension/arrays.hpp"
#include "qddot/scene/scene_arrays.hpp"

namespace qddot::python {

// The curve of a record with polynomial (terms, dimension), harmonics, times and values, and the
// functions `function` and `rate`, as _curve.py makes it.
TimeCurve curve_of(const py::dict& record);

// The record of a curve. Throws InvalidInput for one that no record has: several tables.
py::dict record_of(const TimeCurve& curve, int dimension);

// Gives the arrays these curves; curve_of_node: that of each node, or -1.
void set_curves(const py::list& curves, const Indices& curve_of_node, int of_gravity,
                SceneArrays& arrays);

}  // namespace qddot::python
