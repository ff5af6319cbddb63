#include "experiments/kit/allowed_options.hpp"

#include <cmath>
#include <stdexcept>

#include "experiments/kit/program.hpp"
#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/option_table.hpp"
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

// Those of Method::takes that a command line has.
std::vector<const OptionRow*> rows_of_takes() {
  std::vector<const OptionRow*> rows;
  for (const OptionRow& row : option_rows()) {
    if (is_of_takes(row) && row.is_of_programs) rows.push_back(&row);
  }
  return rows;
}

template <class T>
void require_that(bool is_allowed, const std::string& option, const T& value,
                  const std::string& what) {
  if (!is_allowed) {
    throw InvalidInput(fmt::format("{} {} is not allowed; it is {}", option, value, what));
  }
}

void require_value(const OptionRow& row, const Options& options, int highest_order) {
  const std::string option = row.program_name();
  if (const auto* whole = std::get_if<int Options::*>(&row.member)) {
    const int most = row.most_in_programs > 0 ? row.most_in_programs : highest_order;
    require_within(options.**whole, row.zero_is_own ? 1 : 0, most, option);
  } else if (const auto* number = std::get_if<double Options::*>(&row.member)) {
    const double value = options.**number;
    const bool is_allowed = row.accepts(value) && !(row.zero_is_own && value == 0);
    require_that(is_allowed, option, value, row.words_for_programs());
  }
}

void require_values(const Program& program, const Options& options, int highest_order) {
  for (const OptionRow* row : rows_of_takes()) {
    if (program.has(row->program_name())) require_value(*row, options, highest_order);
  }
}

template <class Number>
void declare_option(Program& program, const OptionRow& row, Number& value) {
  std::string text = row.words;
  if (row.zero_is_own) {
    const std::string usual = value > 0 ? fmt::format("{}", value) : "the method's own";
    text += " (default: " + usual + ")";
  }
  program.bind(row.program_name(), value, text, !row.zero_is_own).last();
}

void declare_option(Program& program, const OptionRow& row, bool& value) {
  program.bind(row.program_name(), value, row.words);
}

void declare_option(Program& program, const OptionRow& row, Solver& value) {
  program
      .word(row.program_name(), std::string(name(value)),
            std::string(row.words) + ", one of " + solver_list())
      .last()
      .check([&value](const std::string& given, const std::string& option) {
        const auto solver = find_solver(given);
        require_that(solver.has_value(), option, given, "one of " + solver_list());
        value = *solver;
      });
}

}  // namespace

Argument<Options> Program::method_options(const Options& usual) {
  Options& options = keep(Options(usual));
  const auto rows = rows_of_takes();
  for (const OptionRow* row : rows) {
    std::visit([&](auto member) { declare_option(*this, *row, options.*member); }, row->member);
  }
  return {*this, rows.front()->program_name(), options};
}

void require_options(const Program& program, const Options& options) {
  int highest = 0;
  for (const Method& method : methods()) {
    if (method.varies_order()) highest = std::max(highest, method.order);
  }
  require_values(program, options, highest);
}

void require_options(const Program& program, const Options& options, const Method& method) {
  for (const OptionRow* row : rows_of_takes()) {
    if (!program.has(row->program_name()) || takes(method, *row)) continue;
    throw InvalidInput(
        fmt::format("{} is not for {}; it is for {}", row->program_name(), method.name,
                    names_where([row](const Method& other) { return takes(other, *row); })));
  }
  require_values(program, options, method.order);
}

std::vector<std::string> options_taken_by(const Method& method) {
  std::vector<std::string> names;
  for (const OptionRow* row : rows_of_takes()) {
    if (takes(method, *row)) names.push_back(row->program_name());
  }
  return names;
}

bool decides_how_a_method_runs(const std::string& option) {
  return std::ranges::any_of(rows_of_takes(),
                             [&](const OptionRow* row) { return row->program_name() == option; });
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
