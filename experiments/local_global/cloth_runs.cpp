#include "experiments/local_global/cloth_runs.hpp"

#include <fmt/format.h>

#include "experiments/local_global/iterated_steps.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/algebra/laplacian_mass.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::local_global {
namespace {

// A row of speed.csv.
struct SpeedRow {
  int nodes = 0;
  std::size_t springs = 0;
  double iteration = 0, setup = 0, factorization = 0;  // [s]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SpeedRow, nodes, springs, iteration, setup, factorization)

SpeedRow measured_speed(int nodes, double stiffness, double h, int repeats) {
  const SwingingCloth cloth(nodes, stiffness, 0);
  constexpr int iterations = 10;
  const System& system = cloth.system();
  const auto median_of = [&](const auto& seconds) {
    std::vector<double> times;
    for (int i = 0; i < repeats; ++i) times.push_back(seconds());
    return median(std::move(times));
  };
  const auto integrator =
      make_integrator(*find_method("local_global"), system,
                      {.step_size = h, .iterations = iterations, .timed = true});
  const double iteration = median_of([&] {
    State state = cloth.start;
    Summary summary;
    const double all = seconds_of([&] { summary = integrator->advance(state, h); });
    return (all - summary.seconds.factorization) / iterations;
  });
  const double setup =
      median_of([&] { return seconds_of([&] { LaplacianMass(system).factorize(h * h); }); });
  EffectiveMass newton(system);
  SymmetricMatrix k = system.stiffness_pattern();
  const double factorization = median_of([&] {
    return seconds_of([&] {
      system.stiffness(cloth.start.q, k);
      newton.factorize_positive(1, h * h, k);
    });
  });
  return {nodes, cloth.drawn.springs.size(), iteration, setup, factorization};
}

}  // namespace

RunRow measured_run(const SwingingCloth& cloth, const State& exact, const Method& method,
                    int iterations, double h, double until) {
  State end = cloth.start;
  Summary summary;
  const auto integrator =
      make_integrator(method, cloth.system(), {.step_size = h, .iterations = iterations});
  const double seconds = seconds_of(
      [&] { summary = integrator->advance(end, cloth.start.t + until, {}, interruption()); });
  return {method.name,
          iterations,
          summary.outcome,
          seconds,
          cloth.distance(end, exact),
          total_energy(cloth.system(), end) - total_energy(cloth.system(), cloth.start)};
}

std::vector<std::pair<const Method*, int>> iterated_runs() {
  std::vector<std::pair<const Method*, int>> runs;
  for (const Method& method : methods()) {
    if (!method.listens_to(Option::iterations)) continue;
    for (const int n : {1, 2, 3, 5, 10, 20, 50, 100, 200}) runs.emplace_back(&method, n);
  }
  for (const int n : {1, 2, 3, 5, 10, 20}) runs.emplace_back(&newton_clamped(), n);
  runs.emplace_back(&newton_exact(), most_newton_iterations);
  return runs;
}

void print(const RunRow& run) {
  fmt::print("{:<24} {:>10} ", run.solver, run.iterations);
  if (run.outcome != Outcome::reached_end) {
    fmt::print("{}\n", name(run.outcome));
  } else {
    fmt::print("{:>9.4f} {:>9.4f} {:>9.4f}\n", run.seconds, run.position_error, -run.energy_change);
  }
}

RowTable<RunRow>& run_table(Program& p) {
  return p.table<RunRow>("run.csv", {{"solver", &RunRow::solver},
                                     {"iterations", &RunRow::iterations},
                                     {"seconds", &RunRow::seconds},
                                     {"position_error", &RunRow::position_error},
                                     {"energy_change", &RunRow::energy_change}});
}

int time_iterations(Program& p, double stiffness, double h, int repeats,
                    const nlohmann::json& origin) {
  auto& table = p.table<SpeedRow>("speed.csv", {{"nodes", &SpeedRow::nodes},
                                                {"springs", &SpeedRow::springs},
                                                {"iteration_s", &SpeedRow::iteration},
                                                {"setup_s", &SpeedRow::setup},
                                                {"factorization_s", &SpeedRow::factorization}});
  return p.study(
      origin.at("scene"),
      [&](Study& study) {
        fmt::print("{:>6} {:>8} {:>13} {:>10} {:>17}\n", "nodes", "springs", "iteration ms",
                   "set-up ms", "factorisation ms");
        for (const int nodes : {standard_nodes, 65, 101}) {
          const double k = stiffness * (nodes - 1) / (standard_nodes - 1.0);
          const SpeedRow row = study.piece(fmt::format("speed {}", nodes), [&] {
            return nlohmann::json(measured_speed(nodes, k, h, repeats));
          });
          table.add(row);
          fmt::print("{:>6} {:>8} {:>13.4f} {:>10.3f} {:>17.3f}\n", row.nodes, row.springs,
                     1e3 * row.iteration, 1e3 * row.setup, 1e3 * row.factorization);
        }
      },
      [&] { return origin; });
}

}  // namespace qddot::local_global
