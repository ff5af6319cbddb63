#include "python/extension/curves.hpp"

#include <memory>
#include <stdexcept>

#include "python/extension/outside.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::python {
namespace {

using Vector = TimeCurve::Vector;

// The numbers of an array of the scene's dimension.
Vector vector_of(const double* numbers, Index size) {
  Vector x = Vector::Zero();
  for (Index c = 0; c < std::min<Index>(size, 3); ++c) x[c] = numbers[c];
  return x;
}

// The rows of a table of vectors.
std::vector<Vector> vectors_of(const Doubles& array) {
  std::vector<Vector> all;
  const Index size = array.ndim() == 2 ? array.shape(1) : 1;
  for (Index row = 0; row < array.shape(0); ++row)
    all.push_back(vector_of(array.data() + row * size, size));
  return all;
}

// A function of t that calls Python, with the GIL. Copies share it, and the last one frees it.
std::function<Vector(double)> function_of(const py::object& callable, const char* name) {
  const std::shared_ptr<py::object> held(new py::object(callable), [](py::object* last) {
    const py::gil_scoped_acquire acquired;
    delete last;
  });
  return [held, name](double t) {
    try {
      const py::gil_scoped_acquire acquired;
      const auto value = py::cast<Doubles>((*held)(t));
      if (value.ndim() > 1 || value.size() < 1 || value.size() > 3)
        throw std::invalid_argument(std::string(name) + ": it returned " +
                                    std::to_string(value.size()) +
                                    " numbers; allowed is one for each dimension");
      return vector_of(value.data(), value.size());
    } catch (...) {
      remember(std::current_exception());
      throw;
    }
  };
}

py::array_t<double> rows_of(const std::vector<Vector>& vectors, int dimension) {
  py::array_t<double> array(
      {static_cast<py::ssize_t>(vectors.size()), static_cast<py::ssize_t>(dimension)});
  double* to = array.mutable_data();
  for (const Vector& x : vectors) to = std::copy_n(x.data(), dimension, to);
  return array;
}

}  // namespace

TimeCurve curve_of(const py::dict& record) {
  TimeCurve curve{.polynomial = vectors_of(record["polynomial"].cast<Doubles>())};
  for (const py::handle& entry : record["harmonics"].cast<py::list>()) {
    const auto [amplitude, frequency, phase] = entry.cast<std::tuple<Doubles, double, double>>();
    curve.harmonics.push_back({vector_of(amplitude.data(), amplitude.size()), frequency, phase});
  }
  if (!record["times"].is_none()) {
    const auto times = record["times"].cast<std::vector<double>>();
    const std::vector<Vector> values = vectors_of(record["values"].cast<Doubles>());
    const bool is_straight = record["interpolation"].cast<std::string>() == "linear";
    curve.tables.push_back(is_straight ? PiecewiseCubic::straight(times, values)
                                       : PiecewiseCubic::spline(times, values));
  }
  if (!record["function"].is_none())
    curve.own.push_back(
        {function_of(record["function"], "function"), function_of(record["rate"], "rate")});
  return curve;
}

py::dict record_of(const TimeCurve& curve, int dimension) {
  using py::arg;
  if (curve.tables.size() > 1 || curve.own.size() > 1)
    throw InvalidInput("a curve has several tables or functions, which no record has");
  py::list harmonics;
  for (const TimeCurve::Harmonic& one : curve.harmonics)
    harmonics.append(
        py::make_tuple(array_of(Vec(one.amplitude.head(dimension))), one.frequency, one.phase));
  py::dict record(arg("polynomial") = rows_of(curve.polynomial, dimension),
                  arg("harmonics") = harmonics, arg("times") = py::none(),
                  arg("values") = py::none(), arg("interpolation") = "spline",
                  arg("function") = py::none(), arg("rate") = py::none());
  for (const PiecewiseCubic& table : curve.tables) {
    record["times"] = table.times();
    record["values"] = rows_of(table.values(), dimension);
    record["interpolation"] = table.is_straight() ? "linear" : "spline";
  }
  const auto callable = [dimension](const std::function<Vector(double)>& function) {
    return py::cpp_function(
        [function, dimension](double t) { return array_of(Vec(function(t).head(dimension))); });
  };
  for (const TimeCurve::Own& own : curve.own) {
    record["function"] = callable(own.value);
    record["rate"] = callable(own.rate);
  }
  return record;
}

void set_curves(const py::list& curves, const Indices& curve_of_node, int of_gravity,
                SceneArrays& arrays) {
  for (const py::handle& record : curves)
    arrays.curves.push_back(curve_of(record.cast<py::dict>()));
  arrays.gravity_curve = of_gravity;
  for (py::ssize_t i = 0; i < curve_of_node.size(); ++i)
    arrays.curve_of_node.push_back(static_cast<int>(curve_of_node.data()[i]));
}

}  // namespace qddot::python
