#include "experiments/sweep/work_costs.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::sweep {

// Looked for in the namespace of the type.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WorkCosts, force, stiffness, factorization, solve)

namespace {

constexpr double seconds_each = 0.05;

// The value of an option among a program's words.
std::string value_of(const std::vector<std::string>& words, const std::string& option) {
  const auto found = std::ranges::find(words, option);
  return found == words.end() || found + 1 == words.end() ? "" : *(found + 1);
}

// The scene of the task as its program reduces it.
WorkCosts costs_of(const Task& task) {
  SceneChoice choice{.name = value_of(task.arguments, "--scene"), .no_reduce = {}};
  std::istringstream kept_as_drawn(value_of(task.arguments, "--no-reduce"));
  for (std::string one; std::getline(kept_as_drawn, one, ',');) choice.no_reduce.push_back(one);
  const Scene drawn = load(choice);
  return measured_costs(ReducedScene(started(drawn, choice), reductions_of(choice)));
}

}  // namespace

WorkCosts measured_costs(const ReducedScene& scene) {
  const System& system = scene.system();
  const Vec& q = scene.initial().q;
  Vec f(system.size());
  WorkCosts costs;
  costs.force = measure::least_seconds(seconds_each, [&] { system.force(q, f); });
  if (!system.has_stiffness()) return costs;
  SymmetricMatrix k = system.stiffness_pattern();
  costs.stiffness = measure::least_seconds(seconds_each, [&] { system.stiffness(q, k); });
  const double w = quick_frequency(system, q);
  const double h_squared = w > 0 ? 1 / (w * w) : 1;
  EffectiveMass matrix(system);
  costs.factorization =
      measure::least_seconds(seconds_each, [&] { matrix.factorize(1, h_squared, k); });
  Vec x(system.size());
  costs.solve = measure::least_seconds(seconds_each, [&] { matrix.solve(f, x); });
  return costs;
}

WorkCosts costs_for(const Task& task, const std::string& folder) {
  const std::string path = folder + "/costs.json";
  const nlohmann::json key = {{"key", task.key}, {"machine", machine()}};
  std::ifstream file(path);
  const auto kept = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (kept.is_object() && kept.value("of", nlohmann::json()) == key)
    return kept.at("seconds").get<WorkCosts>();
  const WorkCosts costs = costs_of(task);
  nlohmann::json json = provenance({});
  json["of"] = key;
  json["seconds"] = costs;
  WholeFile whole(path);
  whole.write(json.dump(1) + "\n");
  whole.complete();
  whole.commit();
  return costs;
}

nlohmann::json by_work(nlohmann::json piece, const WorkCosts& costs) {
  if (!piece.is_object() || !piece.contains("counts") || !piece.contains("time")) return piece;
  const auto& counts = piece["counts"];
  const auto times = [&](const char* what) { return counts.at(what).get<double>(); };
  const double work = times("force_evaluations") * costs.force +
                      times("stiffness_evaluations") * costs.stiffness +
                      times("factorizations") * costs.factorization + times("solves") * costs.solve;
  piece["time"] = work;
  piece["time_min"] = work;
  piece["setup"] = 0;
  return piece;
}

}  // namespace qddot::sweep
