#include "experiments/sweep/results.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/command/csv.hpp"
#include "experiments/command/measured_points.hpp"
#include "experiments/command/reference_file.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/front.hpp"
#include "qddot/measure/speed/judgement.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {

using namespace command;
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

using Ranking = std::vector<const Point*>;  // the fastest point of each method, the fastest first

Ranking ranking(const SceneResult& result, double accuracy) {
  return fastest_of_each_method(result.points, result.reference, accuracy);
}

// How many times as long the next method takes; no number where there is none.
double margin(const Ranking& ranked) {
  return ranked.size() > 1 ? ranked[1]->time / ranked[0]->time : none;
}

double time_of(const Ranking& ranked, const Method* method) {
  const auto found = std::ranges::find(ranked, method, &Point::method);
  return found == ranked.end() ? none : (*found)->time;
}

// Two neighbouring values of what varies, all else alike.
struct Neighbours {
  std::string along;
  const SceneResult *low, *high;

  double from() const { return low->varied.at(along); }
  double to() const { return high->varied.at(along); }
};

// In what alone two scenes of one entry differ, if it is one thing.
std::optional<std::string> only_difference(const SceneResult& a, const SceneResult& b) {
  std::optional<std::string> along;
  if (a.entry != b.entry) return {};
  for (const auto& [name, value] : a.varied) {
    if (!b.varied.contains(name)) return {};
    if (b.varied.at(name) == value) continue;
    if (along) return {};
    along = name;
  }
  return along;
}

std::vector<Neighbours> neighbours(const std::vector<SceneResult>& results) {
  std::vector<Neighbours> all;
  for (const SceneResult& low : results) {
    std::map<std::string, const SceneResult*> next;  // by what it differs in
    for (const SceneResult& other : results) {
      const auto along = only_difference(low, other);
      if (!along || other.varied.at(*along) < low.varied.at(*along)) continue;
      const SceneResult*& nearest = next[*along];
      if (!nearest || other.varied.at(*along) < nearest->varied.at(*along)) nearest = &other;
    }
    for (const auto& [along, high] : next) all.push_back({along, &low, high});
  }
  return all;
}

// Where two methods take equally long, of which the one is faster at the lower end and the other
// at the upper; no number where one of them did not get there at both.
double crossing(const Neighbours& pair, const Ranking& low, const Ranking& high) {
  const Method *first = low.front()->method, *second = high.front()->method;
  const double at_low = std::log(time_of(low, first) / time_of(low, second));
  const double at_high = std::log(time_of(high, first) / time_of(high, second));
  const double part = at_low / (at_low - at_high);
  if (!std::isfinite(part)) return none;
  if (!(pair.from() > 0)) return pair.from() + (pair.to() - pair.from()) * part;
  return pair.from() * std::pow(pair.to() / pair.from(), part);
}

}  // namespace

std::vector<double> accuracies_of(const Task& task) {
  const auto& options = task.key.at("options");
  if (!options.contains("--accuracies")) return usual_accuracies();
  std::vector<double> accuracies;
  for (const auto& word : options.at("--accuracies"))
    accuracies.push_back(std::stod(word.get<std::string>()));
  std::ranges::sort(accuracies, std::ranges::greater());
  return accuracies;
}

SceneResult read_result(const Task& task, const std::string& folder) {
  MeasuredPoints measured = measured_points(folder);
  const std::string path = folder + "/reference.json";
  std::ifstream file(path);
  const auto json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  try {
    return {.label = task.folder,
            .entry = task.entry,
            .varied = task.varied,
            .until = measured.until,
            .reference = reference_from_json(json),
            .points = std::move(measured.points)};
  } catch (const nlohmann::json::exception&) {
    throw InvalidInput(fmt::format("{}: it is missing or no reference", path));
  }
}

void write_fastest(const std::string& path, const std::vector<SceneResult>& results,
                   const std::vector<double>& accuracies, const nlohmann::json& origin) {
  CsvFile csv(path, {"scene", "until", "accuracy", "method", "knob", "value", "error", "time_s",
                     "runner_up", "margin", "judged_by"});
  for (const SceneResult& result : results) {
    const char* judge = judged_by(result.reference);
    for (const double accuracy : accuracies) {
      const Ranking ranked = ranking(result, accuracy);
      if (ranked.empty()) {
        csv.row(result.label, result.until, accuracy, "", "", "", "", "", "", "", judge);
        continue;
      }
      const Point& best = *ranked.front();
      csv.row(result.label, result.until, accuracy, best.method->name, knob_name(best.method->knob),
              best.value, judged_error(best, result.reference), best.time,
              ranked.size() > 1 ? ranked[1]->method->name : "", margin(ranked), judge);
    }
  }
  csv.commit(origin);
}

void write_crossovers(const std::string& path, const std::vector<SceneResult>& results,
                      const std::vector<double>& accuracies, const nlohmann::json& origin) {
  CsvFile csv(path, {"along", "accuracy", "low", "high", "crossing", "scene_low", "scene_high",
                     "method_low", "method_high"});
  for (const Neighbours& pair : neighbours(results)) {
    for (const double accuracy : accuracies) {
      const Ranking low = ranking(*pair.low, accuracy), high = ranking(*pair.high, accuracy);
      if (low.empty() || high.empty() || low.front()->method == high.front()->method) continue;
      csv.row(pair.along, accuracy, pair.from(), pair.to(), crossing(pair, low, high),
              pair.low->label, pair.high->label, low.front()->method->name,
              high.front()->method->name);
    }
  }
  csv.commit(origin);
}

void print_winners(const std::vector<SceneResult>& results, const std::vector<double>& accuracies) {
  for (const double accuracy : accuracies) {
    std::map<std::string, std::vector<double>> margins;  // by the fastest method
    std::size_t unreached = 0;
    for (const SceneResult& result : results) {
      const Ranking ranked = ranking(result, accuracy);
      if (ranked.empty()) {
        ++unreached;
      } else {
        margins[ranked.front()->method->name].push_back(margin(ranked));
      }
    }
    std::vector<std::pair<std::string, std::vector<double>>> order(margins.begin(), margins.end());
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [](const auto& one) { return one.second.size(); });
    std::vector<std::string> words;
    for (auto& [method, own] : order) {
      std::erase_if(own, [](double x) { return std::isnan(x); });
      words.push_back(fmt::format("{} on {}", method, margins[method].size()));
      if (!own.empty()) words.back() += fmt::format(" (by {:.2g})", median(own));
    }
    if (unreached > 0) words.push_back(fmt::format("none on {}", unreached));
    fmt::print("{:<8.0e} {}\n", accuracy, fmt::join(words, ", "));
  }
}

}  // namespace qddot::sweep
