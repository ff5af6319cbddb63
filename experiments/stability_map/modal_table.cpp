#include "experiments/stability_map/modal_table.hpp"

#include <limits>

#include <fmt/format.h>

#include "experiments/kit/progress.hpp"

namespace qddot::stability_map {
namespace {

constexpr int modes_excited = 12;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

// The result of a method for a mode; empty steps are none.
struct Row {
  const Method* method;
  const Mode* mode;
  LinearStep predicted{}, measured{};
  std::string verdict{};
};

void fill(Row& row, const ReducedScene& rest, double h) {
  try {
    row.predicted = linear_step(*row.method, h * row.mode->omega);
    row.measured = modal_step(*row.method, rest, *row.mode, {.step_size = h});
    row.verdict = modal_verdict(row.measured);
  } catch (const std::exception& why) {  // may not leave a thread
    row.verdict = why.what();
  }
}

double of(const LinearStep& step, double (LinearStep::*number)() const) {
  return step.roots.empty() ? none : (step.*number)();
}

std::string rows_of(const Method& method, const std::vector<Mode>& modes, const ReducedScene& rest,
                    double h) {
  std::vector<Row> rows;
  for (const Mode& mode : modes) rows.push_back({&method, &mode});
#pragma omp parallel for schedule(dynamic)
  for (Row& row : rows) fill(row, rest, h);
  Csv csv;
  for (const Row& row : rows) {
    csv.row(
        row.method->name, h, row.mode->rank, row.mode->omega, h * row.mode->omega,
        of(row.predicted, &LinearStep::damping_ratio), of(row.measured, &LinearStep::damping_ratio),
        of(row.predicted, &LinearStep::period_error), of(row.measured, &LinearStep::period_error),
        of(row.predicted, &LinearStep::spectral_radius),
        of(row.measured, &LinearStep::spectral_radius), row.verdict);
  }
  return std::string(csv.text());
}

}  // namespace

const std::vector<std::string>& modal_columns() {
  static const std::vector<std::string> columns = {"method",
                                                   "h",
                                                   "mode",
                                                   "omega",
                                                   "h_omega",
                                                   "damping_ratio_predicted",
                                                   "damping_ratio_measured",
                                                   "period_error_predicted",
                                                   "period_error_measured",
                                                   "spectral_radius_predicted",
                                                   "spectral_radius_measured",
                                                   "verdict"};
  return columns;
}

void tabulate_modes(Study& study, Csv& csv, const std::vector<const Method*>& methods,
                    const ReducedScene& rest, double step_size) {
  std::vector<const Method*> stepping = methods;
  std::erase_if(stepping, [&](const Method* method) {
    return !has_linear_step(*method) || !applies_to(*method, rest.system());
  });
  const auto modes = sampled_modes(rest.system(), rest.initial().q, modes_excited);
  if (modes.empty()) return;
  const double h = step_size > 0 ? step_size : 1 / modes.back().omega;
  progress().begin(stepping.size());
  for (const Method* method : stepping) {
    const auto rows = study.piece(fmt::format("modes {}", method->name),
                                  [&] { return rows_of(*method, modes, rest, h); });
    csv.rows(rows.get<std::string>());
    progress().finish(fmt::format("{} in {} modes", method->name, modes.size()));
  }
}

}  // namespace qddot::stability_map
