// Is each method stable, by theory and measured: on an oscillator, in the natural modes of a
// scene, and in its whole nonlinear motion?
//
//   stability_map --scene pendulum --out results/pendulum
//   stability_map --scene strut --vary compression --amplitudes 0.5,0.7,0.9 --out results/strut
//
//  1. limits.csv and linear.csv: every method of fixed steps on q'' = -w^2 q, where each step is a
//     matrix (linear_step.hpp). They have its spectral radius, damping ratio and period error for
//     h w from 0.01 to 100. They also have the h w at which it starts to grow, predicted and found
//     by bisection (linear_limit.hpp). That h w over w_max of the scene at its start gives h.
//     adaptive.csv: the steps of methods that choose them (linear_tables.hpp).
//     damped_limits.csv, of a damped scene: the same limit for damping ratios from 0.01 to 10.
//  2. modal.csv: the same in natural modes of the scene about its equilibrium at one h
//     (modal_step.hpp), predicted as in 1 and measured by exciting the mode.
//  3. map.csv: outcomes of whole runs over h w_max and amplitude (run_outcome.hpp). A run of
//     amplitude a starts at q_rest + a (q - q_rest), a v: a = 1 is the scene itself, small
//     amplitudes are linear. With --vary, the amplitude is a parameter of the generator. Each
//     method has --cell-limit for a run.
#include <optional>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/stability_map/linear_tables.hpp"
#include "experiments/stability_map/outcome_map.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::stability_map {
namespace {

constexpr int most_columns = 1000, most_amplitudes = 1000;

void warn(const std::string& warning) { say("stability_map: warning: " + in_one_line(warning)); }

// The scene at rest, or nothing, with the reason, if it has no rest.
std::optional<Scene> at_rest(const Subject& subject) {
  try {
    return settled(subject.start(), subject.source);
  } catch (const InvalidInput& why) {
    warn(fmt::format("{}; its modes are left out", why.what()));
    return {};
  }
}

}  // namespace
}  // namespace qddot::stability_map

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::stability_map;
  Program p("stability_map", "Measures where each method is stable, and compares with theory.",
            {has_resume, has_shares});
  auto choice = p.scene();
  auto methods = p.methods(
      "a,b,...: the methods (default: all; in the map all hand-written ones of fixed steps)");
  auto vary = p.word("--vary",
                     "a parameter of the scene's generator, whose values are the amplitudes "
                     "(default: amplitudes are distances from rest, relative to the scene's)");
  auto amplitudes = p.numbers("--amplitudes", {0.03, 0.1, 0.3, 1, 3},
                              "a,b,...: the amplitudes, one for each row of the map");
  auto low = p.number("--low", 0.1, "the least h w_max of the map").positive("the least h w_max");
  auto high =
      p.number("--high", 100, "the largest h w_max of the map").positive("the largest h w_max");
  auto columns = p.whole("--columns", 22, "number of columns of the map, from --low to --high")
                     .within(1, most_columns);
  auto until = p.until("the time to run to in s, at least 100 steps (default: the scene's own)");
  auto step_size =
      p.number("--step-size",
               "the step size h in s for the modes (default: 1/w_max, w_max at rest)")
          .check([](double h, const std::string& name) { require_step_size(h, name); });
  auto tolerated =
      p.number("--tolerated", 0.5, "the part of the energy that a bounded run may lose or gain")
          .positive("a part of the energy");
  auto limit = p.number("--cell-limit", 0.3,
                        "seconds that a run of the map may take; slower ones become over_budget")
                   .positive("the seconds a run may take");
  p.out("the folder for limits.csv, linear.csv, modal.csv, map.csv, ...");
  auto& limits_csv = p.table(
      "limits.csv", {"method", "h_limit_predicted", "h_limit_measured", "h_omega_limit_predicted",
                     "h_omega_limit_measured", "relative_difference"});
  auto& linear_csv = p.table(
      "linear.csv", {"method", "h_omega", "spectral_radius", "damping_ratio", "period_error"});
  auto& adaptive_csv =
      p.table("adaptive.csv",
              {"method", "rtol", "omega_fast", "outcome", "h_omega_mean", "rejected_share",
               "energy_fast", "energy_error", "steps", "rejected", "stability_limited_steps"});
  auto& modal_csv =
      p.table("modal.csv", {"method", "h", "mode", "omega", "h_omega", "damping_ratio_predicted",
                            "damping_ratio_measured", "period_error_predicted",
                            "period_error_measured", "spectral_radius_predicted",
                            "spectral_radius_measured", "verdict", "damping_ratio_physical"});
  auto& damped_csv =
      p.table("damped_limits.csv", {"method", "damping_ratio", "h_omega_limit_predicted",
                                    "h_omega_limit_measured", "relative_difference"});
  auto& map_csv =
      p.table("map.csv", {"method", "h", "h_omega", "amplitude", "outcome", "growth_rate",
                          "predicted_growth_rate", "t_reached", "energy_end", "energy_max", "steps",
                          "rejected", "knob", "value", "omega_max", "buckling_rate"});
  return p.run(argc, argv, [&] {
    if (*high < *low) {
      throw InvalidInput(
          fmt::format("--high {} is not allowed; it is --low or more, {}", *high, *low));
    }
    if (amplitudes->size() > most_amplitudes) {
      throw InvalidInput(fmt::format("--amplitudes: {} of them are too many; allowed are {}",
                                     amplitudes->size(), most_amplitudes));
    }
    for (const double amplitude : *amplitudes) {
      if (vary->empty()) require_positive(amplitude, "--amplitudes", "a distance from rest");
    }
    const Subject subject = subject_of(choice, until);
    require_no_rods(subject.drawn, subject.source, "its small vibrations are not those of K alone");
    const auto selected = select_methods(methods, subject);
    progress().stage("finding the equilibrium");
    const std::optional<Scene> rest = at_rest(subject);
    progress().stage("finding the modes of the rows");
    const auto rows = rows_of(subject, reductions_of(choice), rest, vary, amplitudes);
    const double omega_max = omega_max_of(subject.model);
    std::vector<Limit> limits;
    std::vector<Cell> cells;
    Outcomes all;
    const auto measure = [&](Study& study) {
      const auto taken = study.taken(selected);
      add_limits(study, taken, limits);
      tabulate_linear(*linear_csv, taken);
      tabulate_adaptive(study, *adaptive_csv, taken);
      if (is_damped(subject.drawn)) tabulate_damped_limits(study, *damped_csv, taken);
      if (rest) {
        const Model at_rest(*rest, Reductions::all_directions());
        tabulate_modes(study, *modal_csv, taken, at_rest, step_size);
      }
      cells = cells_of(mapped(taken, !methods->empty()), rows, spaced(low, high, columns));
      run_outcomes(study, cells, {subject.until, tolerated, limit}, all);
    };
    const auto report = [&] {
      tabulate(*limits_csv, limits, omega_max);
      tabulate(*map_csv, cells, all);
      print(limits);
      print(cells, all);
      nlohmann::json origin = p.origin(subject);
      origin["omega_max"] = omega_max;
      origin["tolerated"] = *tolerated;
      origin["vary"] = *vary;
      return origin;
    };
    return p.study(subject.about(), {.names = names_of(selected), .chosen_by = {"--methods"}},
                   measure, report);
  });
}
