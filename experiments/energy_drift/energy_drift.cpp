// Where the energy goes: for every method, whether its energy error stays bounded, drifts, is
// dissipated, blows up or is nothing but round-off, over 10^5 to 10^7 steps.
//
//   energy_drift --scene cloth --out results/cloth
//   energy_drift --scene orbit --step-size 0.01 --until 1e4 --methods verlet --out results/orbit
//   energy_drift --scene orbit --methods verlet --compensated --out results/compensated
//
//  1. Scales come from one accurate run: errors are (E(t) - E(0)) over the largest kinetic energy.
//  2. Fixed-step methods take steps of H, adaptive ones run at each tolerance, all on one thread
//     each, side by side on all cores. They are looked at after some thousands of steps in each
//     octave of the run, drawn at random, so that no oscillation is in step with that. Implicit
//     stages are solved to 1e-9 (--solve-tolerance), so that what drifts is the method.
//  3. Means over 64 blocks of time are fitted by a line and noise together with a random walk,
//     coloured noise or a slow wave (energy_trend.hpp, block_fit.hpp); summary.csv has the slope
//     with its 95 % interval and a verdict in words, or that the run is too short for one and which
//     length would do. The program `verdicts` finds out how often that is right.
//  4. tolerance.csv says how the error of adaptive methods follows rtol.
#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <omp.h>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/energy_drift/drift_record.hpp"
#include "experiments/energy_drift/drift_tables.hpp"
#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/method_options.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/shared_seconds.hpp"
#include "experiments/kit/study.hpp"
#include "qddot/algebra/straight_line.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/trend/drift_run.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::energy_drift {
namespace {

constexpr double standard_resolution = 0.5;  // h w_max
constexpr double standard_steps = 1e6, most_steps = 1e12;
// The methods' own tolerances are made for positions in shorter runs. The errors of their solves
// add up over a million steps. Generalised-alpha then loses only half the energy that it should on
// the scene orbit, and the trapezoidal rule, which should keep it, gains energy.
constexpr double standard_solve_tolerance = 1e-9;

struct Arguments {
  SceneChoice scene;
  std::string out;
  double step_size = 0, until = 0, method_limit = 10;
  std::vector<std::string> methods;
  std::vector<double> rtols = {1e-4, 1e-6, 1e-8};
  bool compensated = false;
  Options options{.solve_tolerance = standard_solve_tolerance};
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option(
      "--step-size", a.step_size,
      "the step size h in s, for methods of fixed steps (default: 1/2 over the largest frequency)");
  line.add_option("--until", a.until, "the time to run to in s (default: a million steps)");
  line.add_option("--methods", a.methods,
                  "a,b,...: the methods (default: all but the stock ways of SUNDIALS, _klu)")
      .delimiter(',');
  line.add_option("--rtol", a.rtols, "a,b,...: relative tolerances, for adaptive methods")
      .delimiter(',')
      .capture_default_str();
  line.add_flag("--compensated", a.compensated,
                "use compensated sums in splittings (verlet, symplectic_euler, kahan_li8, ...), "
                "which add up less rounding");
  line.add_option("--method-limit", a.method_limit,
                  "seconds that a method may take with all of its tolerances; if they run out, the "
                  "verdict is on the time that it reached")
      .take_last()
      .capture_default_str();
  add_method_options(line, a.options);
  line.add_option("--out", a.out,
                  "the folder for drift.csv (energies over time; relative_error is (E(t) - E(0)) "
                  "over the largest kinetic energy), summary.csv (a verdict for each run) and "
                  "tolerance.csv");
}

struct Course {
  double step_size, until;
};

Course course_of(const CommandLine& line, const Arguments& a, const ReducedScene& scene) {
  Course h{a.step_size, a.until};
  if (line.has("--step-size")) {
    require_step_size(a.step_size, "--step-size");
  } else {
    h.step_size = standard_resolution / fastest_frequency(scene);
    if (!std::isfinite(h.step_size)) {
      throw InvalidInput(
          fmt::format("--step-size is missing, and nothing in {} vibrates that could give a "
                      "default; it is h in s, greater than 0",
                      a.scene.name));
    }
  }
  if (line.has("--until")) {
    require_positive(a.until, "--until", "the time to run to in s");
  } else {
    h.until = standard_steps * h.step_size;
  }
  const double steps = h.until / h.step_size;
  if (!(steps >= 1 && steps <= most_steps)) {
    throw InvalidInput(
        fmt::format("--until {}: that is {:.3g} steps of {} s; allowed are 1 to {:.0e}", h.until,
                    steps, h.step_size, most_steps));
  }
  return h;
}

// One run to be made.
struct Job {
  const Method* method;
  double value;
  double seconds;  // that it may take
};

std::vector<Job> jobs_of(const Arguments& a, double step_size, const ReducedScene& scene) {
  std::vector<Job> jobs;
  for (const Method* method : select_methods(a.methods, scene, a.scene.name)) {
    if (a.methods.empty() && !method->stock_of.empty()) continue;
    if (method->knob == Knob::step_size) {
      jobs.push_back({method, step_size, a.method_limit});
    } else {
      const double share = a.method_limit / static_cast<double>(a.rtols.size());
      for (const double rtol : a.rtols) jobs.push_back({method, rtol, share});
    }
  }
  return jobs;
}

// The methods' names, each once.
std::vector<std::string> methods_of(const std::vector<Job>& jobs) {
  std::vector<std::string> names;
  for (const Job& job : jobs) {
    if (names.empty() || names.back() != job.method->name) names.push_back(job.method->name);
  }
  return names;
}

// What is left of the jobs, for the user.
class JobsLeft {
 public:
  explicit JobsLeft(std::vector<Job> jobs) : jobs_(std::move(jobs)) {
    progress().begin(jobs_.size());
  }

  void finish(std::size_t job, const std::string& what) {
    jobs_[job].seconds = 0;
    double sum = 0, longest = 0;
    for (const Job& one : jobs_) {
      // A run is stopped when its time is up; what is made of it then is short.
      const double seconds = one.seconds > 0 ? one.seconds + analysis : 0;
      sum += seconds;
      longest = std::max(longest, seconds);
    }
    progress().left_at_most(shared_seconds_at_most(sum, longest, omp_get_max_threads()));
    progress().finish(what);
  }

 private:
  static constexpr double analysis = 1;  // [s], of the trends of a run

  std::vector<Job> jobs_;
};

// The runs that were made before the program is to end, in the order of the jobs.
std::vector<DriftRun> run_all(Study& study, const std::vector<Job>& jobs, const Arguments& a,
                              const ReducedScene& scene, const Momenta& momenta,
                              const MotionScales& scales, const Course& course) {
  std::vector<std::optional<DriftRun>> runs(jobs.size());
  JobsLeft left(jobs);
  std::exception_ptr trouble;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    try {
      Options options = options_for(*jobs[i].method, jobs[i].value, scene, a.options);
      options.compensated = a.compensated && jobs[i].method->listens_to(Option::compensated);
      const std::string name = fmt::format("{} {:.17g}", jobs[i].method->name, jobs[i].value);
      runs[i] = drift_run_of(study.piece(name, [&] {
        return record_of(run_drift(*jobs[i].method, options, scene, momenta, scales,
                                   {course.step_size, course.until, jobs[i].seconds}));
      }));
#pragma omp critical
      left.finish(i, fmt::format("{} {:.3g}: {}", jobs[i].method->name, jobs[i].value,
                                 verdict_name(runs[i]->energy.verdict)));
    } catch (const Interrupted&) {
      // The run is missing.
    } catch (...) {
#pragma omp critical
      trouble = std::current_exception();
    }
  }
  progress().wipe();
  if (trouble) std::rethrow_exception(trouble);
  std::vector<DriftRun> made;
  for (auto& run : runs) {
    if (run) made.push_back(std::move(*run));
  }
  return made;
}

// The root mean square of the errors from 0.9 t to t.
double error_near(const DriftRun& run, double t) {
  double sum = 0;
  int count = 0;
  for (const DriftPoint& point : run.path) {
    if (point.t < 0.9 * t || point.t > t) continue;
    sum += point.error * point.error;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

// The slope of ln error over ln rtol, of the errors at the time that all runs reached; none where
// there are fewer than two.
std::optional<double> tolerance_exponent(const std::vector<const DriftRun*>& runs, double& t) {
  t = INFINITY;
  for (const DriftRun* run : runs) t = std::min(t, run->path.back().t);
  std::vector<double> x, y;
  for (const DriftRun* run : runs) {
    const double error = error_near(*run, t);
    if (!(error > 0)) continue;
    x.push_back(std::log(run->value));
    y.push_back(std::log(error));
  }
  const StraightLine line = straight_line(x, y);
  if (!(line.spread > 0)) return {};
  return line.slope;
}

void print_verdicts(const std::vector<DriftRun>& runs, double until) {
  for (const DriftRun& run : runs) {
    const bool fixed = run.method->knob == Knob::step_size;
    const std::string who =
        fixed ? run.method->name : fmt::format("{} {:g}", run.method->name, run.value);
    fmt::print("{:<30} {}\n", who, verdict(run, until));
  }
}

void print_tolerances(const std::vector<DriftRun>& runs, const MotionScales& scales) {
  std::map<std::string, std::vector<const DriftRun*>> adaptive;
  std::vector<std::string> order;
  for (const DriftRun& run : runs) {
    if (run.method->knob != Knob::rtol) continue;
    auto& own = adaptive[run.method->name];
    if (own.empty()) order.push_back(run.method->name);
    own.push_back(&run);
  }
  for (const std::string& method : order) {
    double t = 0;
    if (const auto exponent = tolerance_exponent(adaptive[method], t)) {
      fmt::print("{:<30} the energy error goes as rtol^{:.2f}, over {:.3g} periods\n", method,
                 *exponent, t * scales.frequency / (2 * M_PI));
    }
  }
}

int energy_drift(const CommandLine& line, const Arguments& a,
                 const std::vector<std::string>& command_line) {
  const auto begin = std::chrono::steady_clock::now();
  require_given(a.out, "--out", "the folder for the results");
  require_positive(a.method_limit, "--method-limit", "the seconds a method may take");
  require_options(line, a.options);
  for (const double rtol : a.rtols) require_rtol(rtol, "--rtol");
  const Scene drawn = load(a.scene);
  const Scene start = started(drawn, a.scene);
  const ReducedScene scene(start, reductions_of(a.scene));
  const Course course = course_of(line, a, scene);
  std::vector<Job> jobs = jobs_of(a, course.step_size, scene);
  Study study(line, a.out, {"drift.csv", "summary.csv", "tolerance.csv"},
              {{"scene", content_hash(drawn)}, {"name", drawn.name}},
              {.names = methods_of(jobs), .chosen_by = {"--methods"}});
  if (const auto status = study.completed()) return *status;
  std::erase_if(jobs, [&](const Job& job) { return !study.takes(job.method->name); });
  CsvFile paths(a.out + "/drift.csv", path_columns().header());
  CsvFile summary(a.out + "/summary.csv", summary_columns().header());
  CsvFile tolerance(a.out + "/tolerance.csv", tolerance_columns().header());

  const Momenta momenta(start);
  MotionScales scales{};
  std::vector<DriftRun> runs;
  study.measure([&] {
    progress().stage("measuring the scales of the motion");
    scales = motion_scales(scene, momenta, course.until);
    stop_if_interrupted();
    runs = run_all(study, jobs, a, scene, momenta, scales, course);
    if (runs.size() < jobs.size()) stop_if_interrupted();
  });
  if (study.is_share()) return study.conclude(done);

  for (const DriftRun& run : runs) {
    for (const DriftPoint& point : run.path) path_columns().write_row(paths, {run, point});
    paths.flush_if_large();
    summary_columns().write_row(summary, {run, course.until, a.compensated});
    if (run.method->knob == Knob::rtol) tolerance_columns().write_row(tolerance, {run, scales});
  }
  fmt::print("{} to t = {:g} s, {:.3g} steps of {:.4g} s; energy errors over {:.4g} J\n\n",
             drawn.name, course.until, course.until / course.step_size, course.step_size,
             scales.kinetic);
  print_verdicts(runs, course.until);
  fmt::print("\n");
  print_tolerances(runs, scales);

  nlohmann::json origin = provenance(command_line, drawn, start, scene);
  origin["step_size"] = course.step_size;
  origin["until"] = course.until;
  origin["method_limit"] = a.method_limit;
  origin["energy"] = scales.energy;
  origin["energy_scale"] = scales.kinetic;
  origin["excess_energy"] = scales.excess * scales.kinetic;
  origin["frequency"] = scales.frequency;
  origin["rounding"] = scales.rounding;
  origin["seconds"] = seconds_since(begin);
  return study.finish({&paths, &summary, &tolerance}, origin, done);
}

}  // namespace
}  // namespace qddot::energy_drift

int main(int argc, char** argv) {
  using namespace qddot::energy_drift;
  return qddot::kit::enter<Arguments>(
      {.name = "energy_drift",
       .summary = "Finds out where each integrator's energy goes over a long run of one scene.",
       .has_resume = true,
       .has_shares = true},
      declare, energy_drift, argc, argv);
}
