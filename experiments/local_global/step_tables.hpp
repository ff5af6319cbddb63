#pragma once

#include <string>

#include "experiments/kit/program.hpp"
#include "experiments/local_global/cloth_runs.hpp"
#include "experiments/local_global/iterated_steps.hpp"

namespace qddot::local_global {

// The columns of StepRow, after the one by which cloths differ, if any.
inline Columns<StepRow> step_columns(const std::string& varied, const Columns<StepRow>& last) {
  Columns<StepRow> all = {};
  if (!varied.empty()) all += {{varied, &StepRow::varied}};
  all += {{"solver", &StepRow::solver},
          {"iteration", &StepRow::iteration},
          {"seconds", &StepRow::seconds}};
  all += last;
  return all;
}

// The tables of all but --speed.
struct StepTables {
  explicit StepTables(Program& p)
      : convergence(p.table("convergence.csv", step_columns("", error))),
        positions(p.table("positions.csv",
                          step_columns("", {{"distance_to_converged", &StepRow::distance},
                                            {"step_error", &StepRow::own}}))),
        stiffness(p.table("stiffness.csv", step_columns("stiffness", error))),
        resolution(p.table("resolution.csv", step_columns("nodes", error))),
        run(p.table<RunRow>("run.csv", {{"solver", &RunRow::solver},
                                        {"iterations", &RunRow::iterations},
                                        {"seconds", &RunRow::seconds},
                                        {"position_error", &RunRow::position_error},
                                        {"energy_change", &RunRow::energy_change}})) {}

  // Adds one step of one cloth to a table, and its setup to the table's sidecar.
  static void add(RowTable<StepRow>& table, const Comparison& step, const nlohmann::json& setup) {
    for (const StepRow& row : step.rows) table.add(row);
    table.note({{"setup", setup}});
  }

  const Columns<StepRow> error = {{"relative_error", &StepRow::relative_error}};
  RowTable<StepRow>&convergence, &positions, &stiffness, &resolution;
  RowTable<RunRow>& run;
};

}  // namespace qddot::local_global
