#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"

namespace qddot::local_global {

// The tables of local_global but speed.csv, in one folder.
struct StepTables {
  explicit StepTables(const std::string& folder)
      : convergence(folder + "/convergence.csv",
                    {"solver", "iteration", "seconds", "relative_error"}),
        positions(folder + "/positions.csv",
                  {"solver", "iteration", "seconds", "distance_to_converged", "step_error"}),
        stiffness(folder + "/stiffness.csv",
                  {"stiffness", "solver", "iteration", "seconds", "relative_error"}),
        resolution(folder + "/resolution.csv",
                   {"nodes", "solver", "iteration", "seconds", "relative_error"}),
        run(folder + "/run.csv",
            {"solver", "iterations", "seconds", "position_error", "energy_change"}) {}
  static std::vector<std::string> names() {
    return {"convergence.csv", "positions.csv", "stiffness.csv", "resolution.csv", "run.csv"};
  }

  CsvFile convergence, positions, stiffness, resolution, run;
  bool all_held = true;  // whether no solver failed
  // What their sidecars have of their own.
  nlohmann::json of_step = nlohmann::json::object(), of_stiffness = nlohmann::json::object(),
                 of_resolution = nlohmann::json::object();
};

}  // namespace qddot::local_global
