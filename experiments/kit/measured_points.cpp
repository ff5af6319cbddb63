#include "experiments/kit/measured_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>

#include <fmt/format.h>

#include "experiments/kit/method_options.hpp"
#include "experiments/kit/written_table.hpp"
#include "qddot/integrators/integrator.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

const std::vector<std::string> columns = {"method",
                                          "value",
                                          "outcome",
                                          "t_reached",
                                          "error_position",
                                          "error_velocity",
                                          "error_energy",
                                          "error_energy_max",
                                          "error_momentum_max",
                                          "error_modal_shares",
                                          "time_s",
                                          "time_min_s",
                                          "setup_s",
                                          "steps",
                                          "energy_growth"};

// The options of a study that decide how a method runs.
constexpr std::array of_a_run = {"--no-reduce",  "--max-order",       "--stability-detection",
                                 "--iterations", "--solve-tolerance", "--spectral-radius",
                                 "--solver"};

Point point_of(const WrittenTable& table, std::size_t row, const std::string& path) {
  const auto number = [&](const char* column) { return table.number(row, column); };
  const Method* method = find_method(table.text(row, "method"));
  const auto outcome = find_outcome(table.text(row, "outcome"));
  if (!method || !outcome) {
    throw InvalidInput(
        fmt::format("{}: row {}: {} '{}' is not known here; work_precision writes "
                    "such a table anew",
                    path, row + 1, method ? "outcome" : "method",
                    table.text(row, method ? "outcome" : "method")));
  }
  const double value = number("value");
  if (!(std::isfinite(value) && value > 0)) {
    throw InvalidInput(fmt::format("{}: row {}: value {} is not allowed; it is finite and above 0",
                                   path, row + 1, table.text(row, "value")));
  }
  return {.method = method,
          .value = value,
          .outcome = *outcome,
          .t_reached = number("t_reached"),
          .errors = {number("error_position"), number("error_velocity"), number("error_energy")},
          .path = {number("error_energy_max"), number("error_momentum_max"),
                   number("error_modal_shares")},
          .time = number("time_s"),
          .time_min = number("time_min_s"),
          .setup = number("setup_s"),
          .counts = {.steps = static_cast<std::int64_t>(number("steps"))},
          .energy_growth = number("energy_growth")};
}

// The options as the study was given them, read as a command line is.
void take_options(const nlohmann::json& given, MeasuredPoints& study) {
  Program program({.name = "study", .summary = ""});
  const auto scene = program.scene();
  const auto options = program.method_options();
  std::vector<std::string> words = {"study"};
  for (const auto& [option, values] : given.items()) {
    if (std::ranges::find(of_a_run, option) == of_a_run.end()) continue;
    for (const auto& value : values)
      words.push_back(fmt::format("{}={}", option, value.get<std::string>()));
  }
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  program.parse(static_cast<int>(argv.size()), argv.data());
  require_options(program, options);
  study.no_reduce = scene->no_reduce;
  study.options = options;
}

}  // namespace

std::vector<Point> points_in(const std::string& folder) {
  const std::string path = folder + "/points.csv";
  const WrittenTable table(path, columns);
  std::vector<Point> points;
  for (std::size_t row = 0; row < table.size(); ++row) points.push_back(point_of(table, row, path));
  return points;
}

MeasuredPoints measured_points(const std::string& folder) {
  MeasuredPoints study;
  study.points = points_in(folder);
  const std::string sidecar = folder + "/points.json";
  std::ifstream file(sidecar);
  const auto json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  try {
    study.key = json.at("study");
    const auto& about = study.key.at("about");
    study.scene_hash = about.at("scene");
    study.until = about.at("until");
    take_options(study.key.at("options"), study);
  } catch (const nlohmann::json::exception&) {
    throw InvalidInput(
        fmt::format("{}: it is missing or not as work_precision writes it beside "
                    "points.csv",
                    sidecar));
  }
  if (!(std::isfinite(study.until) && study.until > 0)) {
    throw InvalidInput(fmt::format(
        "{}: study.about.until {} is not allowed; it is finite and above 0", sidecar, study.until));
  }
  return study;
}

}  // namespace qddot::inline kit
