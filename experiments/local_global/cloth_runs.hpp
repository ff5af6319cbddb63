#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/kit/program.hpp"
#include "experiments/local_global/swinging_cloth.hpp"
#include "qddot/integrators/method.hpp"

namespace qddot::local_global {

constexpr int standard_nodes = 33;  // along a side, unless others are asked for

// A whole run of the cloth by steps of so many iterations.
struct RunRow {
  std::string solver;
  int iterations = 0;
  Outcome outcome{};
  double seconds = 0, position_error = 0, energy_change = 0;  // [s], [m], [J]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunRow, solver, iterations, outcome, seconds, position_error,
                                   energy_change)

// Steps of h [s] over `until` [s]; `exact` is where the true motion then is.
RunRow measured_run(const SwingingCloth& cloth, const State& exact, const Method& method,
                    int iterations, double h, double until);

// The methods of these runs, with the numbers of their iterations.
std::vector<std::pair<const Method*, int>> iterated_runs();

// Prints a row for people.
void print(const RunRow& run);
// The table run.csv.
RowTable<RunRow>& run_table(Program& p);

// Writes speed.csv: what local_global takes for one iteration and before the first one, and one of
// Newton's iterations to assemble and factorise its matrix. They are medians of `repeats`
// measurements with steps of h [s]. The cloths have 33, 65 and 101 nodes along a side, and their
// stiffness [N/m] grows in proportion. Returns the exit status.
int time_iterations(Program& p, double stiffness, double h, int repeats,
                    const nlohmann::json& origin);

}  // namespace qddot::local_global
