#include "qddot/integrators/options.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "qddot/integrators/method.hpp"

namespace qddot {
namespace {

// Throws if `is_allowed` is false. NaN satisfies no condition and throws as well.
template <class T>
void require(bool is_allowed, const Method& method, const char* option, T value, const char* what) {
  if (is_allowed) return;
  throw std::invalid_argument(fmt::format("{}: {} = {:g} is not allowed; it is {}", method.name,
                                          option, static_cast<double>(value), what));
}

bool is_size(double x) { return std::isfinite(x) && x > 0; }

}  // namespace

void check_options(const Method& method, const Options& o) {
  if (method.knob == Knob::step_size) {
    require(is_size(o.step_size), method, "step_size", o.step_size, "h in s, finite and above 0");
  } else {
    require(o.rtol >= least_rtol && std::isfinite(o.rtol), method, "rtol", o.rtol,
            "a relative tolerance, finite and at least 1e-15, some roundings of a number");
    require(o.atol >= 0 && std::isfinite(o.atol), method, "atol", o.atol,
            "an absolute tolerance, finite, or 0 for rtol times length and speed");
  }
  require(is_size(o.length), method, "length", o.length, "a size of positions in m above 0");
  require(is_size(o.speed), method, "speed", o.speed, "a size of velocities in m/s above 0");
  require(o.max_order >= 0, method, "max_order", o.max_order,
          "an order, or 0 for the method's own");
  require(o.iterations >= 0, method, "iterations", o.iterations,
          "a number of iterations, or 0 for the method's own");
  require(o.solve_tolerance >= 0 && o.solve_tolerance < 1, method, "solve_tolerance",
          o.solve_tolerance, "below 1, or 0 for the method's own");
  require(o.spectral_radius >= 0 && o.spectral_radius <= 1, method, "spectral_radius",
          o.spectral_radius, "from 0 to 1");
}

}  // namespace qddot
