#include "experiments/sweep/results.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/points.hpp"
#include "experiments/kit/reference_file.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/chart.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

FrontRow row_of(const SceneResult& result, double accuracy) {
  return fastest_at_each_accuracy(result.points, result.reference, {accuracy}).front();
}

// How many times as long the next method takes; no number where there is none.
double margin(const FrontRow& row) {
  return row.runner_up() ? row.runner_up()->time / row.fastest->time : none;
}

double time_of(const FrontRow& row, const Method* method) {
  const auto found = std::ranges::find(row.ranked, method, &Point::method);
  return found == row.ranked.end() ? none : (*found)->time;
}

// Two neighbouring values of what varies, all else alike.
struct Neighbours {
  std::string along;
  const SceneResult *low, *high;

  double from() const { return low->varied.at(along); }
  double to() const { return high->varied.at(along); }
};

// Scenes of one entry that are alike but for one thing, in its order.
std::vector<Neighbours> neighbours(const std::vector<SceneResult>& results) {
  using Others = std::map<std::string, double>;
  std::map<std::tuple<std::size_t, std::string, Others>, std::vector<const SceneResult*>> rows;
  for (const SceneResult& one : results) {
    for (const auto& [along, value] : one.varied) {
      Others others = one.varied;
      others.erase(along);
      rows[{one.entry, along, others}].push_back(&one);
    }
  }
  std::vector<Neighbours> all;
  for (auto& [of, row] : rows) {
    const std::string& along = std::get<std::string>(of);
    std::ranges::sort(row, {}, [&](const SceneResult* one) { return one->varied.at(along); });
    for (std::size_t i = 1; i < row.size(); ++i) all.push_back({along, row[i - 1], row[i]});
  }
  return all;
}

// The fastest method changes between two neighbours.
struct Crossover {
  Neighbours pair;
  double accuracy = 0;
  const Method *low = nullptr, *high = nullptr;
  double at_low = none, at_high = none;  // ln of the time of the first over that of the second

  // The value at which both take equally long; NaN unless both reached the accuracy at both ends.
  double crossing() const { return equally_long(pair.from(), pair.to(), at_low, at_high); }
  // How many times as long the other takes at either end, at least; no number where that is known
  // at neither.
  double margin() const { return std::exp(std::fmin(-at_low, at_high)); }
};

// All crossovers, the clearest first.
std::vector<Crossover> crossovers(const std::vector<SceneResult>& results,
                                  const std::vector<double>& accuracies) {
  std::vector<Crossover> all;
  for (const Neighbours& pair : neighbours(results)) {
    for (const double accuracy : accuracies) {
      const FrontRow low = row_of(*pair.low, accuracy), high = row_of(*pair.high, accuracy);
      if (!low.fastest || !high.fastest || low.fastest->method == high.fastest->method) continue;
      const Method *first = low.fastest->method, *second = high.fastest->method;
      all.push_back({.pair = pair,
                     .accuracy = accuracy,
                     .low = first,
                     .high = second,
                     .at_low = std::log(time_of(low, first) / time_of(low, second)),
                     .at_high = std::log(time_of(high, first) / time_of(high, second))});
    }
  }
  std::ranges::stable_sort(all, std::ranges::greater(), [](const Crossover& one) {
    return std::isnan(one.margin()) ? 0 : one.margin();
  });
  return all;
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
    const char* judge = name(judge_of(result.reference));
    for (const double accuracy : accuracies) {
      const FrontRow row = row_of(result, accuracy);
      if (!row.fastest) {
        csv.row(result.label, result.until, accuracy, "", "", "", "", "", "", "", judge);
        continue;
      }
      const Point& best = *row.fastest;
      csv.row(result.label, result.until, accuracy, best.method->name, knob_name(best.method->knob),
              best.value, judged(best, result.reference).error, best.time,
              row.runner_up() ? row.runner_up()->method->name : "", margin(row), judge);
    }
  }
  csv.commit(origin);
}

void write_crossovers(const std::string& path, const std::vector<SceneResult>& results,
                      const std::vector<double>& accuracies, const nlohmann::json& origin) {
  CsvFile csv(path, {"along", "accuracy", "low", "high", "crossing", "scene_low", "scene_high",
                     "method_low", "method_high", "margin"});
  for (const Crossover& one : crossovers(results, accuracies)) {
    csv.row(one.pair.along, one.accuracy, one.pair.from(), one.pair.to(), one.crossing(),
            one.pair.low->label, one.pair.high->label, one.low->name, one.high->name, one.margin());
  }
  csv.commit(origin);
}

void print_winners(const std::vector<SceneResult>& results, const std::vector<double>& accuracies) {
  for (const double accuracy : accuracies) {
    std::map<std::string, std::vector<double>> margins;  // by the fastest method
    std::size_t unreached = 0;
    for (const SceneResult& result : results) {
      const FrontRow row = row_of(result, accuracy);
      if (!row.fastest) {
        ++unreached;
      } else {
        margins[row.fastest->method->name].push_back(margin(row));
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
