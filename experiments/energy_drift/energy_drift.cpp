// The energy error of every method over 10^5 to 10^7 steps: whether it stays bounded, drifts, is
// dissipated, blows up or is nothing but round-off.
//
//   energy_drift --scene cloth --out results/cloth
//   energy_drift --scene orbit --step-size 0.01 --until 1e4 --methods verlet --out results/orbit
//   energy_drift --scene orbit --methods verlet --compensated --out results/compensated
//
//  1. Scales come from one accurate run: errors are (E(t) - E(0)) over the largest kinetic energy.
//  2. Fixed-step methods take steps of H, adaptive ones run at each tolerance, all on one thread
//     each, side by side on all cores. They are looked at after some thousands of steps in each
//     octave of the run. These are drawn at random: no oscillation is in step with them. Implicit
//     stages are solved to 1e-9 (--solve-tolerance), so that what drifts is the method.
//  3. Means over 64 blocks of time are fitted by a line and noise together with a random walk,
//     coloured noise or a slow wave (energy_trend.hpp, block_fit.hpp). summary.csv has the slope
//     with its 95 % interval and a verdict in words. If the run is too short for one, it says which
//     length would do. The program `verdicts` finds out how often that is right.
//  4. tolerance.csv says how the error of adaptive methods follows rtol.
#include <optional>

#include <fmt/format.h>

#include "experiments/energy_drift/drift_jobs.hpp"
#include "experiments/energy_drift/drift_record.hpp"
#include "experiments/energy_drift/drift_tables.hpp"
#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/program.hpp"
#include "qddot/measure/motion/timing.hpp"

// The methods' own tolerances are made for positions in shorter runs. The errors of their solves
// add up over a million steps. Generalised-alpha then loses only half the energy that it should on
// the scene orbit, and the trapezoidal rule, which should keep it, gains energy.
constexpr double standard_solve_tolerance = 1e-9;

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::energy_drift;
  Program p("energy_drift",
            "Finds out where each integrator's energy goes over a long run of one scene.",
            {has_resume, has_shares});
  auto scene = p.scene();
  auto step_size =
      p.number("--step-size",
               "the step size h in s, for methods of fixed steps (default: 1/2 over "
               "the largest frequency)")
          .check([](double h, const std::string& name) { require_step_size(h, name); });
  auto until = p.until("the time to run to in s (default: a million steps)")
                   .positive("the time to run to in s");
  auto methods =
      p.methods("a,b,...: the methods (default: all but the stock ways of SUNDIALS, _klu)");
  auto rtols =
      p.numbers("--rtol", {1e-4, 1e-6, 1e-8}, "a,b,...: relative tolerances, for adaptive methods")
          .check_each(require_rtol);
  auto compensated = p.flag("--compensated",
                            "use compensated sums in splittings (verlet, symplectic_euler, "
                            "kahan_li8, ...), which add up less rounding");
  auto limit = p.number("--method-limit", 10,
                        "seconds that a method may take with all of its tolerances; if they run "
                        "out, the verdict is on the time that it reached")
                   .last()
                   .positive("the seconds a method may take");
  auto options = p.method_options({.solve_tolerance = standard_solve_tolerance});
  p.out(
      "the folder for drift.csv (energies over time; relative_error is (E(t) - E(0)) over the "
      "largest kinetic energy), summary.csv (a verdict for each run) and tolerance.csv");
  auto& paths = p.table("drift.csv", path_columns());
  auto& summary = p.table("summary.csv", summary_columns());
  auto& tolerance = p.table("tolerance.csv", tolerance_columns());
  return p.run(argc, argv, [&] {
    const auto begin = std::chrono::steady_clock::now();
    require_options(p, options);
    const Subject subject = subject_of(scene);
    const Course course = course_of(step_size, until, subject);
    auto selected = select_methods(methods, subject);
    if (methods->empty()) {
      std::erase_if(selected, [](const Method* method) { return !method->stock_of.empty(); });
    }
    const Momenta momenta(subject.start());
    MotionScales scales{};
    std::vector<std::optional<DriftRun>> runs;
    const auto measure = [&](Study& study) {
      progress().stage("measuring the scales of the motion");
      scales = motion_scales(subject.model, momenta, course.until);
      stop_if_interrupted();
      const auto jobs = jobs_of(study.taken(selected), course.step_size, rtols, limit);
      runs.resize(jobs.size());
      progress().begin(jobs.size());
      side_by_side(jobs.size(), [&](std::size_t i) {
        const auto& [method, value, seconds] = jobs[i];
        Options own = options_for(*method, value, subject.model, options);
        own.compensated = compensated && method->listens_to(Option::compensated);
        const std::string name = fmt::format("{} {:.17g}", method->name, value);
        runs[i] = drift_run_of(study.piece(name, [&, by = method, limit = seconds] {
          return record_of(run_drift(*by, own, subject.model, momenta, scales,
                                     {course.step_size, course.until, limit}));
        }));
        progress().finish(fmt::format("{} {:.3g}: {}", method->name, value,
                                      verdict_name(runs[i]->energy.verdict)));
      });
    };
    const auto report = [&] {
      std::vector<DriftRun> made;
      for (auto& run : runs) {
        if (run) made.push_back(std::move(*run));
      }
      for (const DriftRun& run : made) {
        for (const DriftPoint& point : run.path) paths.add({run, point});
        paths->flush_if_large();
        summary.add({run, course.until, compensated});
        if (run.method->knob == Knob::rtol) tolerance.add({run, scales});
      }
      fmt::print("{} to t = {:g} s, {:.3g} steps of {:.4g} s; energy errors over {:.4g} J\n\n",
                 subject.drawn.name, course.until, course.until / course.step_size,
                 course.step_size, scales.kinetic);
      print_verdicts(made, course.until);
      fmt::print("\n");
      print_tolerances(made, scales);
      nlohmann::json origin = p.origin(subject);
      origin.update({{"step_size", course.step_size},
                     {"until", course.until},
                     {"method_limit", *limit},
                     {"energy", scales.energy},
                     {"energy_scale", scales.kinetic},
                     {"excess_energy", scales.excess * scales.kinetic},
                     {"frequency", scales.frequency},
                     {"rounding", scales.rounding},
                     {"seconds", seconds_since(begin)}});
      return origin;
    };
    return p.study(subject.about(), {.names = names_of(selected), .chosen_by = {"--methods"}},
                   measure, report);
  });
}
