// Observed order of convergence: each fixed-step method at h, h/2, h/4, ... on one scene.
//
//   convergence --scene pendulum --until 1 --out results/pendulum
//   convergence --scene cloth --methods verlet,implicit_euler --out results/cloth
//
//  1. The reference is work_precision's (reference.json, shared with it).
//     Beyond the horizon of a chaotic motion nobody knows the positions, and nothing is run: each
//     method has one row of empty fields.
//  2. h starts where it resolves the fastest frequency at the start (h w = 1; a 16th of the run
//     for implicit methods) and is halved until the error nears what the reference certifies, or
//     a run takes longer than ten seconds.
//  3. order.csv holds the errors and log2 of the ratio of successive position errors, which tends
//     to the order of the method as h -> 0. It is left empty where it would say something else: of
//     errors above a tenth or within twenty times of what the reference certifies or the method
//     rounds, and where the next order observed (or the one before) is more than a half away.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/convergence/observed_orders.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/point_record.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "qddot/measure/motion/resolved_frequency.hpp"
#include "qddot/measure/reference/reference_words.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/measure/speed/sweep_bound.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::convergence {
namespace {

constexpr int most_halvings = 12;
constexpr double longest_run = 10;  // [s]
// Errors count for an order if they are this many times the certified error of the reference. The
// order is then wrong by 1 / (20 ln 2) = 0.07 at most.
constexpr double well_above = 20;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

struct Arguments {
  SceneChoice scene;
  std::string out;
  double until = 0;
  std::vector<std::string> methods;
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option("--until", a.until, "the time to run to in s (default: the scene's own)");
  line.add_option("--methods", a.methods, "a,b,...: the methods, of fixed steps (default: all)")
      .delimiter(',');
  line.add_option("--out", a.out, "the folder for order.csv and reference.json");
}

// The methods among those asked for whose error depends on a step size; others that were named are
// refused.
std::vector<const Method*> select_fixed_step(const std::vector<std::string>& list,
                                             const ReducedScene& scene, const std::string& source) {
  std::vector<const Method*> selected;
  for (const Method* method : select_methods(list, scene, source)) {
    if (method->knob == Knob::step_size && method->order > 0) {
      selected.push_back(method);
    } else if (!list.empty()) {
      throw InvalidInput(fmt::format("--methods: {} {}; allowed are methods of fixed step",
                                     method->name,
                                     method->order > 0 ? "chooses its steps by itself"
                                                       : "has no error that depends on a step"));
    }
  }
  return selected;
}

// What rounding makes of a run: each step adds one, by chance to either side. It is from 2^-54 to
// 2^-53 of a coordinate, a quarter to a half of what the reference's start was displaced by.
double rounding_of_steps(const Reference& reference, double steps) {
  return reference.rounding_effect * std::sqrt(steps) / 4;
}

// Runs of a method at h, h/2, h/4, ... [s] that reached the end or failed; a run over the budget
// ends the series.
std::vector<Point> halvings(const Method& method, const ReducedScene& scene, double until,
                            const Reference& reference, const Effort& effort) {
  const double w = resolved_frequency(method, scene.system(), scene.initial().q);
  const double coarsest = method.is(Trait::implicit) ? 16 : std::max(16.0, std::ceil(until * w));
  std::vector<Point> points;
  for (int halving = 0; halving <= most_halvings; ++halving) {
    const double h = until / (coarsest * std::exp2(halving));
    points.push_back(measure_point(method, h, scene, until, reference, effort));
    if (points.back().outcome == Outcome::over_budget) {
      points.pop_back();
      break;
    }
    if (points.back().outcome == Outcome::reached_end &&
        points.back().errors.position < well_above * reference.certified.position)
      break;
  }
  return points;
}

// An upper bound of the seconds of halvings(). A run that ends within the budget may take all of
// it. A run with half as many steps takes half as long, except that it may need ten times as many
// Newton iterations. The last run is stopped.
double halvings_at_most(const Method& method, const Effort& effort) {
  double seconds = effort.seconds;
  double run = effort.seconds * (method.is(Trait::implicit) ? 10 : 1);
  for (int halving = 0; halving <= most_halvings; ++halving, run /= 2)
    seconds += point_seconds_at_most(std::min(run, effort.seconds), effort);
  return seconds;
}

void tabulate(Csv& csv, const Method& method, double until, const Reference& reference,
              const std::vector<Point>& points) {
  std::vector<double> errors;
  std::vector<double> floors;
  for (const Point& p : points) {
    errors.push_back(p.outcome == Outcome::reached_end ? p.errors.position : nothing);
    floors.push_back(well_above * std::max(reference.certified.position,
                                           rounding_of_steps(reference, until / p.value)));
  }
  const std::vector<double> orders = observed_orders(errors, floors);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    const bool reached = p.outcome == Outcome::reached_end;
    csv.row(method.name, p.value, errors[i], reached ? p.errors.velocity : nothing, orders[i]);
    fmt::print("{:<20} {:>5}  {:>10.3e}  {:>10}  {:>8}\n", method.name, method.order, p.value,
               reached ? fmt::format("{:.3e}", errors[i]) : name(p.outcome),
               std::isnan(orders[i]) ? "-" : fmt::format("{:.3f}", orders[i]));
  }
}

int convergence(const CommandLine& line, const Arguments& a,
                const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  const Scene drawn = load(a.scene);
  const double until = end_time(a.until, line.has("--until"), drawn);
  const Scene start = started(drawn, a.scene);
  const ReducedScene scene(start, reductions_of(a.scene));
  require_reference_exists(scene, a.scene.name);
  const auto selected = select_fixed_step(a.methods, scene, a.scene.name);
  require_folder(a.out);

  Study study(line, a.out, {"order.csv"},
              {{"scene", content_hash(drawn)}, {"name", drawn.name}, {"until", until}});
  if (const auto status = study.completed()) return *status;
  const nlohmann::json origin = provenance(command_line, drawn, start, scene);
  CsvFile csv(a.out + "/order.csv",
              {"method", "h", "error_position", "error_velocity", "observed_order"});
  study.measure([&] {
    progress().stage("making the reference");
    const Reference reference = reference_for(drawn, start, scene, until, a.out, origin);
    progress().wipe();
    fmt::print("{} to t = {:g} s; reference certified to {:.1e}\n{}\n\n", drawn.name, until,
               reference.certified.position, what_divides(reference));
    const std::string symmetry = symmetry_in_words(reference);
    if (!symmetry.empty()) fmt::print("{}\n\n", symmetry);
    if (reference.is_beyond_horizon()) {
      fmt::print(
          "The motion is chaotic: from t = {:.3g} s on nobody knows the positions, so that their "
          "errors at\nt = {:g} s mean nothing and no order can be observed. An earlier --until "
          "shows it.\n",
          reference.horizon, until);
      for (const Method* method : selected)
        csv.row(method->name, nothing, nothing, nothing, nothing);
      return;
    }
    fmt::print("{:<20} {:>5}  {:>10}  {:>10}  {:>8}\n", "method", "order", "h in s", "error",
               "observed");
    Effort effort{.seconds = longest_run, .repeats = 1};
    const auto recall = points_of(study);
    effort.recall = [&](const Method& method, double h, const Effort::Take& take) {
      progress().now_at(fmt::format("{} h = {:.3g}", method.name, h));
      return recall(method, h, take);
    };
    progress().begin(selected.size());
    double left = 0;  // [s]
    for (const Method* method : selected) left += halvings_at_most(*method, effort);
    for (const Method* method : selected) {
      progress().left_at_most(left);
      const auto points = halvings(*method, scene, until, reference, effort);
      left -= halvings_at_most(*method, effort);
      progress().left_at_most(left);
      progress().finish(method->name + " is done");
      progress().wipe();
      tabulate(csv, *method, until, reference, points);
    }
    fmt::print(
        "\n-: no order, since one of the errors is above {:g} or within {:g} times of the "
        "reference's own\n   or of rounding, or the orders observed beside it are more than {:g} "
        "away\n",
        largest_asymptotic, well_above, agreeing);
  });
  return study.finish({&csv}, origin, done);
}

}  // namespace
}  // namespace qddot::convergence

int main(int argc, char** argv) {
  using namespace qddot::convergence;
  return qddot::kit::enter<Arguments>(
      {.name = "convergence",
       .summary = "Measures the order of convergence of every fixed-step integrator.",
       .has_threads = true,
       .has_resume = true},
      declare, convergence, argc, argv);
}
