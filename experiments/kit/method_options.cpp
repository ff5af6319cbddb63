#include "experiments/kit/method_options.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "experiments/kit/catalogue.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
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
  if (program.has("--max-order")) {
    require_that(o.max_order >= 1 && o.max_order <= highest_order, "--max-order", o.max_order,
                 fmt::format("a whole number from 1 to {}", highest_order));
  }
  if (program.has("--iterations")) {
    require_that(o.iterations >= 1 && o.iterations <= most_iterations, "--iterations", o.iterations,
                 fmt::format("a whole number from 1 to {}", most_iterations));
  }
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

}  // namespace qddot::inline kit
