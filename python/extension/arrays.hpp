#pragma once

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::python {

namespace py = pybind11;

// Arrays of doubles in C order; another array is converted to one on its way in.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

inline Vec vec_of(const Doubles& array) { return Vec::Map(array.data(), array.size()); }

template <class Numbers>
py::array_t<double> array_of(const Numbers& x) {
  py::array_t<double> array(static_cast<py::ssize_t>(x.size()));
  std::copy(x.data(), x.data() + x.size(), array.mutable_data());
  return array;
}

// Positions or velocities of all nodes, `dimension` numbers each.
inline void write(const std::vector<Node>& nodes, Eigen::Vector3d Node::*which, int dimension,
                  double* to) {
  for (const Node& node : nodes) to = std::copy_n((node.*which).data(), dimension, to);
}
inline py::array_t<double> array_of(const std::vector<Node>& nodes, Eigen::Vector3d Node::*which,
                                    int dimension) {
  py::array_t<double> array({static_cast<py::ssize_t>(nodes.size()), py::ssize_t{dimension}});
  write(nodes, which, dimension, array.mutable_data());
  return array;
}

}  // namespace qddot::python
