#include "experiments/work_precision/chart_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/measured_points.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/kit/written_table.hpp"
#include "experiments/record/chart_record.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::work_precision {
namespace {

bool is_there(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

// The object that a JSON file holds; an empty one if there is no such file.
nlohmann::json object_in(const std::string& path) {
  if (!is_there(path)) return nlohmann::json::object();
  std::ifstream file(path);
  auto json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) throw InvalidInput(fmt::format("{}: it is damaged or no JSON", path));
  return json;
}

// The accuracies of front.csv, from coarse to fine, and w_max [rad/s] from a margin there; 0 if it
// has none.
struct FrontFile {
  std::vector<double> accuracies = usual_accuracies();
  double w_max = 0;
};

FrontFile front_in(const std::string& folder) {
  const std::string path = folder + "/front.csv";
  if (!is_there(path)) return {};
  const WrittenTable table(path, {"accuracy", "method", "value", "stability_margin"});
  FrontFile front{.accuracies = {}};
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double accuracy = table.number(row, "accuracy");
    if (!(accuracy > 0 && accuracy < 1)) {
      throw InvalidInput(
          fmt::format("{}: row {}: accuracy '{}' is not allowed; it is above 0 and "
                      "below 1",
                      path, row + 1, table.text(row, "accuracy")));
    }
    front.accuracies.push_back(accuracy);
    const double margin = table.number(row, "stability_margin");
    const Method* method = find_method(table.text(row, "method"));
    if (method && std::isfinite(margin))  // margin = 1 - h w / limit
      front.w_max = (1 - margin) * linear_limit(*method) / table.number(row, "value");
  }
  std::ranges::sort(front.accuracies, std::ranges::greater());
  return front;
}

// The certified error of positions that the bounds in points.csv were made with; NaN if there are
// none. The bound of the least error has the most of its digits.
double certified_in(const std::string& folder) {
  const WrittenTable table(folder + "/points.csv", {"error_position", "error_position_at_most"});
  double least = std::numeric_limits<double>::infinity();
  double certified = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double error = table.number(row, "error_position");
    if (!(error < least)) continue;
    least = error;
    certified = table.number(row, "error_position_at_most") - error;
  }
  return certified;
}

Reference reference_in(const std::string& folder, const nlohmann::json& file) {
  try {
    Reference reference = reference_without_end(file);
    if (file.empty()) reference.certified.position = certified_in(folder);
    return reference;
  } catch (const nlohmann::json::exception&) {
    throw InvalidInput(
        fmt::format("{}/reference.json: it is not as work_precision writes it", folder));
  }
}

// A member that is text; empty if it is missing or anything else.
std::string text(const nlohmann::json& json, const char* member) {
  const auto found = json.find(member);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace

void write_chart(WholeFile& file, const Chart& chart, const std::string& scene,
                 const StudyEnd& end) {
  const std::string name =
      nlohmann::json(scene).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  file.write(record::chart_record(chart, name, end));
}

void judge(const std::string& folder) {
  const std::vector<Point> points = points_in(folder);
  const nlohmann::json sidecar = object_in(folder + "/points.json");
  const nlohmann::json kept = object_in(folder + "/reference.json");
  const FrontFile front = front_in(folder);
  const Reference reference = reference_in(folder, kept);
  const WrittenTable table(folder + "/points.csv", {"scene"});
  const Chart chart = chart_of(points, reference, front.accuracies, StabilityMargins(front.w_max));
  WholeFile file(folder + "/chart.json", record::chart_beginning);
  write_chart(file, chart, table.size() > 0 ? table.text(0, "scene") : text(kept, "scene"),
              {.interrupted_by = text(sidecar, "interrupted"),
               .are_times_of_work = text(sidecar, "times") == "work"});
  file.commit();
}

}  // namespace qddot::work_precision
