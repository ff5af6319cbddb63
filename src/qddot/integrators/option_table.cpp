#include "qddot/integrators/option_table.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace qddot {
namespace {

bool is_size(double x) { return x > 0; }
bool is_share(double x) { return x >= 0 && x <= 1; }
bool is_share_below_one(double x) { return x >= 0 && x < 1; }
bool is_not_negative(double x) { return x >= 0; }
bool is_rtol(double x) { return x >= least_rtol; }

const OptionRow rows[] = {
    {.name = "step_size",
     .unit = "s",
     .member = &Options::step_size,
     .takers = Knob::step_size,
     .words = "the step size h in s, for methods of fixed steps",
     .allows = is_size,
     .allowed = "h in s, finite and above 0"},
    {.name = "rtol",
     .unit = "",
     .member = &Options::rtol,
     .takers = Knob::rtol,
     .words = "relative tolerance, for adaptive methods",
     .allows = is_rtol,
     .allowed = "a relative tolerance, finite and at least 1e-15, some roundings of a number"},
    {.name = "atol",
     .unit = "m and m/s",
     .member = &Options::atol,
     .takers = Knob::rtol,
     .words =
         "absolute tolerance in m and m/s, for adaptive methods (default: --rtol times the scene's "
         "extent, and times its typical speed)",
     .allows = is_not_negative,
     .allowed = "an absolute tolerance, finite, or 0 for rtol times length and speed"},
    {.name = "length",
     .unit = "m",
     .member = &Options::length,
     .takers = EveryMethod(),
     .words = "a typical size of positions",
     .allows = is_size,
     .allowed = "a size of positions in m above 0",
     .is_of_programs = false},
    {.name = "speed",
     .unit = "m/s",
     .member = &Options::speed,
     .takers = EveryMethod(),
     .words = "a typical size of velocities",
     .allows = is_size,
     .allowed = "a size of velocities in m/s above 0",
     .is_of_programs = false},
    {.name = "max_order",
     .unit = "",
     .member = &Options::max_order,
     .takers = Option::max_order,
     .words = "the highest order of methods of variable order",
     .allows = is_not_negative,
     .allowed = "an order, or 0 for the method's own",
     .zero_is_own = true},
    {.name = "stability_detection",
     .unit = "",
     .member = &Options::stability_detection,
     .takers = Option::stability_detection,
     .words = "let CVODE's BDF lower its order when it detects an instability"},
    {.name = "iterations",
     .unit = "",
     .member = &Options::iterations,
     .takers = Option::iterations,
     .words = "number of iterations in a step, for methods with a fixed number",
     .allows = is_not_negative,
     .allowed = "a number of iterations, or 0 for the method's own",
     .zero_is_own = true,
     .most_in_programs = 100000},
    {.name = "solve_tolerance",
     .unit = "",
     .member = &Options::solve_tolerance,
     .takers = Option::solve_tolerance,
     .words = "tolerance of the nonlinear solves of hand-written implicit methods, relative to the "
              "error of the first guess",
     .allows = is_share_below_one,
     .allowed = "below 1, or 0 for the method's own",
     .zero_is_own = true,
     .allowed_in_programs = "between 0 and 1"},
    {.name = "spectral_radius",
     .unit = "",
     .member = &Options::spectral_radius,
     .takers = Option::spectral_radius,
     .words = "the part of an infinitely fast vibration that a step of the generalised-alpha "
              "methods keeps, from 0 to 1",
     .allows = is_share,
     .allowed = "from 0 to 1"},
    {.name = "solver",
     .unit = "",
     .member = &Options::solver,
     .takers = Option::solver,
     .words = "the solver for the n x n matrices of implicit steps"},
    {.name = "compensated",
     .unit = "",
     .member = &Options::compensated,
     .takers = Option::compensated,
     .words = "add the rounding error of each sum to the next one, in splittings",
     .is_of_programs = false}};

}  // namespace

std::string OptionRow::program_name() const {
  std::string spelling = std::string("--") + name;
  std::ranges::replace(spelling, '_', '-');
  return spelling;
}

bool OptionRow::accepts(double number) const {
  return std::isfinite(number) && (!allows || allows(number));
}

const char* OptionRow::words_for_programs() const {
  return *allowed_in_programs ? allowed_in_programs : allowed;
}

const char* OptionRow::kind() const {
  constexpr const char* kinds[] = {"number", "integer", "flag", "solver"};
  return kinds[member.index()];
}

std::span<const OptionRow> option_rows() { return rows; }

const OptionRow& option_row(const std::string& name) {
  const auto found =
      std::ranges::find_if(rows, [&](const OptionRow& row) { return row.name == name; });
  if (found == std::end(rows)) throw std::invalid_argument(name + " is no option of a run");
  return *found;
}

bool takes(const Method& method, const OptionRow& row) {
  if (const Knob* knob = std::get_if<Knob>(&row.takers)) return *knob == method.knob;
  if (const Option* option = std::get_if<Option>(&row.takers)) return method.listens_to(*option);
  return true;
}

}  // namespace qddot
