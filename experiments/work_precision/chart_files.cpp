#include "experiments/work_precision/chart_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/points.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/record/chart_record.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::work_precision {
namespace {

std::string knob_of(const Point& point) { return knob_in_words(*point.method, point.value); }

// The other family's best, and how many times slower it is.
std::string rival(const FrontRow& row) {
  const Point* other =
      row.fastest == row.fastest_sundials ? row.fastest_hand_written : row.fastest_sundials;
  if (!other) return "";
  return fmt::format("{} {}, {:.3g} x", other->method->name, time_in_words(other->time),
                     other->time / row.fastest->time);
}

// A sentence for each step that the front names and that stands on the edge.
std::vector<std::string> small_margins(const std::vector<FrontRow>& front) {
  std::vector<std::string> sentences;
  for (const FrontRow& row : front) {
    if (!(row.stability_margin < small_margin)) continue;
    const std::string sentence = fmt::format(
        "{} at {} is {}, w_max at the start: motion raises that, and a longer run may blow up; "
        "take half of the step there",
        row.fastest->method->name, knob_of(*row.fastest), margin_in_words(row.stability_margin));
    if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(sentence);
  }
  return sentences;
}

// A sentence for each winner that another method may beat.
std::vector<std::string> close_times(const std::vector<FrontRow>& front) {
  std::vector<std::string> sentences;
  for (const FrontRow& row : front) {
    const Point* rival = row.runner_up();
    if (!rival || !may_be_faster(*rival, *row.fastest)) continue;
    sentences.push_back(fmt::format("{:.0e}: {} may be as fast ({}, at least {}), as times vary",
                                    row.accuracy, rival->method->name, time_in_words(rival->time),
                                    time_in_words(rival->time_min)));
  }
  return sentences;
}

}  // namespace

const std::vector<std::string> front_columns = {"scene",  "accuracy",  "method",
                                                "knob",   "value",     "error_position",
                                                "time_s", "judged_by", "stability_margin"};

void tabulate(Csv& csv, const std::string& scene, const Chart& chart) {
  const char* judge = name(chart.judge);
  for (const FrontRow& row : chart.front) {
    if (const Point* p = row.fastest) {
      csv.row(scene, row.accuracy, p->method->name, knob_name(p->method->knob), p->value,
              p->errors.position, p->time, judge, row.stability_margin);
    } else {
      csv.row(scene, row.accuracy, "", "", "", "", "", judge, "");
    }
  }
}

void print_front(const std::string& scene, const Chart& chart) {
  const Reference& reference = chart.reference;
  fmt::print("{} to t = {:g} s; reference certified to {:.1e} ({})\n", scene, reference.end.t,
             reference.certified.position, reference.made_by);
  fmt::print("{}\n\n", what_divides(reference));
  if (reference.is_beyond_horizon()) {
    fmt::print(
        "The motion is chaotic (Lyapunov exponent {:.3g}/s): two runs that start one rounding "
        "apart\ndiffer from t = {:.3g} s on by more than {:g} of the motion.\nPosition errors at "
        "the end mean nothing; below, accuracy is that of the energy.\n\n",
        reference.lyapunov, reference.horizon, far_apart);
  } else if (reference.is_chaotic()) {
    fmt::print(
        "The motion is chaotic: one rounding of the start grows {:.0e} times and moves the end "
        "by {:.0e};\nerrors below that depend on how a method rounds.\n\n",
        reference.perturbation_growth, reference.rounding_effect);
  }
  const std::string symmetry = symmetry_in_words(reference);
  if (!symmetry.empty()) fmt::print("{}\n\n", symmetry);
  fmt::print("{:<9} {:<20} {:<16} {:>9}  {:>9}   {}\n", "accuracy", "fastest method", "knob",
             "error ", "time", "fastest of the other family");
  bool has_doubts = false;
  for (const FrontRow& row : chart.front) {
    if (const Point* p = row.fastest) {
      const Judged& error = chart.judged_view().points[chart.number(p)];
      has_doubts |= error.is_uncertain;
      fmt::print("{:<9.0e} {:<20} {:<16} {:>8.1e}{}  {:>9}   {}\n", row.accuracy, p->method->name,
                 knob_of(*p), error.error, error.is_uncertain ? '?' : ' ', time_in_words(p->time),
                 rival(row));
    } else {
      fmt::print("{:<9.0e} {}\n", row.accuracy, why_empty(row, reference));
    }
  }
  for (const std::string& warning : small_margins(chart.front)) fmt::print("{}\n", warning);
  for (const std::string& warning : close_times(chart.front)) fmt::print("{}\n", warning);
  if (const std::string words = disturbance_in_words(chart); !words.empty()) {
    fmt::print("{}\n", words);
  }
  if (has_doubts)
    fmt::print("? known only to within {:.1e}, the error bound of the reference itself\n",
               certified(reference));
}

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
