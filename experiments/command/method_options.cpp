#include "experiments/command/method_options.hpp"

#include <algorithm>
#include <ranges>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/command/catalogue.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::command {
namespace {

constexpr int most_iterations = 100000;  // a step

template <class T>
void require_that(bool is_allowed, const char* option, const T& value, const std::string& what) {
  if (!is_allowed) {
    throw InvalidInput(fmt::format("{} {} is not allowed; it is {}", option, value, what));
  }
}

std::string solver_list() {
  return fmt::format("one of {}", fmt::join(solver_names | std::views::values, ", "));
}

void require_values(const CLI::App& app, const MethodOptions& o, int highest_order) {
  if (app.count("--max-order") > 0) {
    require_that(o.max_order >= 1 && o.max_order <= highest_order, "--max-order", o.max_order,
                 fmt::format("a whole number from 1 to {}", highest_order));
  }
  if (app.count("--iterations") > 0) {
    require_that(o.iterations >= 1 && o.iterations <= most_iterations, "--iterations", o.iterations,
                 fmt::format("a whole number from 1 to {}", most_iterations));
  }
  if (app.count("--solve-tolerance") > 0) {
    require_that(o.solve_tolerance > 0 && o.solve_tolerance < 1, "--solve-tolerance",
                 o.solve_tolerance, "between 0 and 1");
  }
  require_that(o.spectral_radius >= 0 && o.spectral_radius <= 1, "--spectral-radius",
               o.spectral_radius, "from 0 to 1");
  require_that(find_solver(o.solver).has_value(), "--solver", o.solver, solver_list());
}

}  // namespace

void add_method_options(CLI::App& app, MethodOptions& options) {
  app.add_option("--max-order", options.max_order,
                 "the highest order that methods of variable order may take (default: their own)")
      ->take_last();
  app.add_flag("--stability-detection", options.stability_detection,
               "let CVODE's BDF lower its order where it finds itself unstable");
  app.add_option("--iterations", options.iterations,
                 "how many a step, of methods that take as many as they are told (default: their "
                 "own)")
      ->take_last();
  const std::string own =
      options.solve_tolerance > 0 ? fmt::format("{}", options.solve_tolerance) : "the method's own";
  app.add_option("--solve-tolerance", options.solve_tolerance,
                 "what part of the error of its prediction a nonlinear solve of a hand-written "
                 "implicit method may leave (default: " +
                     own + ")")
      ->take_last();
  app.add_option("--spectral-radius", options.spectral_radius,
                 "what a step of generalised-alpha methods leaves of a vibration of infinite "
                 "frequency, from 0 to 1")
      ->take_last()
      ->capture_default_str();
  app.add_option("--solver", options.solver,
                 "what solves with the n x n matrices of implicit steps: " + solver_list())
      ->take_last()
      ->capture_default_str();
}

void require_options(const CLI::App& app, const MethodOptions& options) {
  int highest = 0;
  for (const Method& method : methods()) {
    if (method.varies_order) highest = std::max(highest, method.order);
  }
  require_values(app, options, highest);
}

void require_options(const CLI::App& app, const MethodOptions& options, const Method& method) {
  const auto require = [&](const char* option, bool Method::*has) {
    if (app.count(option) == 0 || method.*has) return;
    throw InvalidInput(
        fmt::format("{} is not for {}; it is for {}", option, method.name, names_where(has)));
  };
  require("--max-order", &Method::varies_order);
  require("--stability-detection", &Method::detects_instability);
  require("--iterations", &Method::takes_iterations);
  require("--solve-tolerance", &Method::takes_solve_tolerance);
  require("--spectral-radius", &Method::takes_spectral_radius);
  require("--solver", &Method::takes_solver);
  require_values(app, options, method.order);
}

}  // namespace qddot::command
