#include "experiments/kit/allowed_options.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include "experiments/kit/program.hpp"
#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::inline kit {
namespace {

constexpr double coarse_rtol = 0.1, fine_rtol = 1e-14;
// M - h^2 K needs the square of h, and all its digits.
constexpr double least_step = 1e-150, largest_step = 1e150;
constexpr double least_part_of_scale = 1e-30;

}  // namespace

void require_positive(double value, const std::string& option, const std::string& meaning) {
  if (std::isfinite(value) && value > 0) return;
  throw InvalidInput(fmt::format("{} {} is not allowed; it is {}, finite and greater than 0",
                                 option, value, meaning));
}

void require_within(int value, int low, int high, const std::string& option) {
  if (value >= low && value <= high) return;
  throw InvalidInput(fmt::format("{} {} is not allowed; it is a whole number from {} to {}", option,
                                 value, low, high));
}

void require_given(const std::string& text, const std::string& option, const std::string& meaning) {
  if (text.empty()) throw InvalidInput(fmt::format("{} is missing; it is {}", option, meaning));
}

void require_rtol(double rtol, const std::string& option) {
  require_positive(rtol, option, "a relative tolerance");
  if (rtol >= least_rtol && rtol < 1) return;
  throw InvalidInput(
      fmt::format("{} {:g} is not allowed; it is a relative tolerance from {:g} (some roundings of "
                  "a number) to below 1 (as large as the motion)",
                  option, rtol, least_rtol));
}

void require_step_size(double h, const std::string& option, double until) {
  require_positive(h, option, "h in s");
  if (h < until / most_steps) {
    throw InvalidInput(
        fmt::format("{} {:g} is not allowed; it is h in s, at least {:.3g}: in {:g} s, double "
                    "precision can tell apart at most {:g} steps",
                    option, h, until / most_steps, until, most_steps));
  }
  if (h >= least_step && h <= largest_step) return;
  throw InvalidInput(
      fmt::format("{} {:g} is not allowed; it is h in s, from {:g} to {:g}, so that "
                  "its square is a number",
                  option, h, least_step, largest_step));
}

void require_atol(const Options& options) {
  if (options.atol == 0) return;
  require_positive(options.atol, "--atol", "an absolute tolerance");
  const double least = least_part_of_scale * std::min(options.length, options.speed);
  const double most = std::max(options.length, options.speed);
  if (options.atol >= least && options.atol < most) return;
  throw InvalidInput(fmt::format(
      "--atol {:g} is not allowed; it is an absolute tolerance in m and m/s, from {:.2g} to below "
      "{:.3g}, as the scene measures {:.3g} m and its speeds are {:.3g} m/s",
      options.atol, least, most, options.length, options.speed));
}

std::string tolerance_warning(const Options& options) {
  if (options.rtol > coarse_rtol) {
    return fmt::format(
        "--rtol {:g} allows an error of {:g} of the motion in a step: the result hardly means "
        "anything",
        options.rtol, options.rtol);
  }
  if (options.rtol > 0 && options.rtol < fine_rtol) {
    return fmt::format(
        "--rtol {:g} is near the rounding of numbers, 2e-16: errors may stay above it, and steps "
        "may become very short",
        options.rtol);
  }
  if (options.atol >= std::min(options.length, options.speed)) {
    const bool is_length = options.atol >= options.length;
    return fmt::format("--atol {:g} is above the size of {}, {:.3g} {}: their errors do not count",
                       options.atol, is_length ? "positions" : "velocities",
                       is_length ? options.length : options.speed, is_length ? "m" : "m/s");
  }
  return "";
}

namespace {

constexpr int most_iterations = 100000;  // a step

struct Spelling {
  const char* name;
  Option option;
};
constexpr std::array spellings = {Spelling{"--max-order", Option::max_order},
                                  Spelling{"--stability-detection", Option::stability_detection},
                                  Spelling{"--iterations", Option::iterations},
                                  Spelling{"--solve-tolerance", Option::solve_tolerance},
                                  Spelling{"--spectral-radius", Option::spectral_radius},
                                  Spelling{"--solver", Option::solver}};

template <class T>
void require_that(bool is_allowed, const char* option, const T& value, const std::string& what) {
  if (!is_allowed) {
    throw InvalidInput(fmt::format("{} {} is not allowed; it is {}", option, value, what));
  }
}

void require_values(const Program& program, const Options& o, int highest_order) {
  if (program.has("--max-order")) require_within(o.max_order, 1, highest_order, "--max-order");
  if (program.has("--iterations")) require_within(o.iterations, 1, most_iterations, "--iterations");
  if (program.has("--solve-tolerance")) {
    require_that(o.solve_tolerance > 0 && o.solve_tolerance < 1, "--solve-tolerance",
                 o.solve_tolerance, "between 0 and 1");
  }
  require_that(o.spectral_radius >= 0 && o.spectral_radius <= 1, "--spectral-radius",
               o.spectral_radius, "from 0 to 1");
}

}  // namespace

Argument<Options> Program::method_options(const Options& usual) {
  Options& options = keep(Options(usual));
  bind("--max-order", options.max_order,
       "the highest order of methods of variable order (default: the method's own)")
      .last();
  bind("--stability-detection", options.stability_detection,
       "let CVODE's BDF lower its order when it detects an instability");
  bind(
      "--iterations", options.iterations,
      "number of iterations in a step, for methods with a fixed number (default: the method's own)")
      .last();
  const std::string own =
      options.solve_tolerance > 0 ? fmt::format("{}", options.solve_tolerance) : "the method's own";
  bind("--solve-tolerance", options.solve_tolerance,
       "tolerance of the nonlinear solves of hand-written implicit methods, relative to the error "
       "of the first guess (default: " +
           own + ")")
      .last();
  bind("--spectral-radius", options.spectral_radius,
       "the part of an infinitely fast vibration that a step of the generalised-alpha methods "
       "keeps, from 0 to 1",
       true)
      .last();
  word("--solver", std::string(qddot::name(options.solver)),
       "the solver for the n x n matrices of implicit steps, one of " + solver_list())
      .last()
      .check([&options](const std::string& name, const std::string& option) {
        const auto solver = find_solver(name);
        require_that(solver.has_value(), option.c_str(), name, "one of " + solver_list());
        options.solver = *solver;
      });
  return {*this, "--max-order", options};
}

void require_options(const Program& program, const Options& options) {
  int highest = 0;
  for (const Method& method : methods()) {
    if (method.varies_order()) highest = std::max(highest, method.order);
  }
  require_values(program, options, highest);
}

void require_options(const Program& program, const Options& options, const Method& method) {
  for (const auto& [name, option] : spellings) {
    if (!program.has(name) || method.listens_to(option)) continue;
    throw InvalidInput(fmt::format(
        "{} is not for {}; it is for {}", name, method.name,
        names_where([option = option](const Method& other) { return other.listens_to(option); })));
  }
  require_values(program, options, method.order);
}

std::vector<std::string> options_taken_by(const Method& method) {
  std::vector<std::string> names;
  for (const auto& [name, option] : spellings) {
    if (method.listens_to(option)) names.emplace_back(name);
  }
  return names;
}

Argument<std::string> accuracy_of_option(Program& program) {
  return program.word("--accuracy-of",
                      "the error that --accuracy bounds: positions (at the end), path (positions "
                      "at all times) or energy (at all times) (default: positions)");
}

AccuracyOf accuracy_of(const std::string& of) {
  if (of.empty() || of == "positions") return AccuracyOf::positions;
  if (of == "path") return AccuracyOf::path;
  if (of == "energy") return AccuracyOf::energy;
  throw InvalidInput(fmt::format("--accuracy-of {}: allowed are positions, path and energy", of));
}

void require_allowed_accuracy(double accuracy, const std::string& option) {
  try {
    require_accuracy(accuracy, option);
  } catch (const std::invalid_argument& error) {
    throw InvalidInput(error.what());
  }
}

}  // namespace qddot::inline kit
