// Observed order of convergence: each fixed-step method at h, h/2, h/4, ... on one scene.
//
//   convergence --scene pendulum --until 1 --out results/pendulum
//   convergence --scene cloth --methods verlet,implicit_euler --out results/cloth
//
//  1. The reference is work_precision's (reference.json, shared with it).
//     Beyond the horizon of a chaotic motion nobody knows the positions, and nothing is run: each
//     method has one row of empty fields.
//  2. h starts where it resolves the fastest frequency at the start: h w = 1, or a 16th of the run
//     for implicit methods. It is halved until the error nears what the reference certifies, or a
//     run takes longer than ten seconds.
//  3. order.csv holds the errors and log2 of the ratio of successive position errors, which tends
//     to the order of the method as h -> 0. It is left empty for errors above a tenth, or within
//     twenty times of what the reference certifies or the method rounds. It is empty too where the
//     next order observed, or the one before, is more than a half away.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "experiments/convergence/observed_orders.hpp"
#include "experiments/kit/points.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/reference_file.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::convergence {
namespace {

constexpr int most_halvings = 12;
constexpr double longest_run = 10;  // [s]
// Errors count for an order if they are this many times the certified error of the reference. The
// order is then wrong by 1 / (20 ln 2) = 0.07 at most.
constexpr double well_above = 20;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// Runs of a method at h, h/2, h/4, ... [s] that reached the end or failed; a run over the budget
// ends the series.
std::vector<Point> halvings(const Method& method, const Subject& subject,
                            const Reference& reference, const Effort& effort) {
  const double until = subject.until;
  const double w = resolved_frequency(method, subject.system(), subject.model.initial().q);
  const double coarsest = method.is(Trait::implicit) ? 16 : std::max(16.0, std::ceil(until * w));
  std::vector<Point> points;
  for (int halving = 0; halving <= most_halvings; ++halving) {
    const double h = until / (coarsest * std::exp2(halving));
    points.push_back(measure_point(method, h, subject.model, until, reference, effort));
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

void tabulate(Csv& csv, const Method& method, double until, const Reference& reference,
              const std::vector<Point>& points) {
  std::vector<double> errors;
  std::vector<double> floors;
  for (const Point& p : points) {
    errors.push_back(p.outcome == Outcome::reached_end ? p.errors.position : nothing);
    floors.push_back(well_above *
                     std::max(reference.certified.position,
                              rounding_of_steps(reference.rounding_effect, until / p.value)));
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

void measure_orders(Study& study, Csv& csv, const Subject& subject,
                    const std::vector<const Method*>& methods, const Reference& reference) {
  fmt::print("{} to t = {:g} s; reference certified to {:.1e}\n{}\n\n", subject.drawn.name,
             subject.until, reference.certified.position, what_divides(reference));
  const std::string symmetry = symmetry_in_words(reference);
  if (!symmetry.empty()) fmt::print("{}\n\n", symmetry);
  if (reference.is_beyond_horizon()) {
    fmt::print(
        "The motion is chaotic: from t = {:.3g} s on nobody knows the positions, so that their "
        "errors at\nt = {:g} s mean nothing and no order can be observed. An earlier --until "
        "shows it.\n",
        reference.horizon, subject.until);
    for (const Method* method : methods) csv.row(method->name, nothing, nothing, nothing, nothing);
    return;
  }
  fmt::print("{:<20} {:>5}  {:>10}  {:>10}  {:>8}\n", "method", "order", "h in s", "error",
             "observed");
  progress().begin(methods.size());
  for (const Method* method : methods) {
    const auto points =
        halvings(*method, subject, reference,
                 {.seconds = longest_run, .repeats = 1, .recall = points_of(study)});
    progress().finish(method->name + " is done");
    progress().wipe();
    tabulate(csv, *method, subject.until, reference, points);
  }
  fmt::print(
      "\n-: no order, since one of the errors is above {:g} or within {:g} times of the "
      "reference's own\n   or of rounding, or the orders observed beside it are more than {:g} "
      "away\n",
      largest_asymptotic, well_above, agreeing);
}

}  // namespace
}  // namespace qddot::convergence

int main(int argc, char** argv) {
  using namespace qddot::convergence;
  using namespace qddot;
  Program p("convergence", "Measures the order of convergence of every fixed-step integrator.",
            {has_threads, has_resume});
  auto choice = p.scene();
  auto until = p.until();
  auto methods = p.methods("a,b,...: the methods, of fixed steps (default: all)");
  p.out("the folder for order.csv and reference.json");
  auto& order =
      p.table("order.csv", {"method", "h", "error_position", "error_velocity", "observed_order"});
  return p.run(argc, argv, [&] {
    const Subject subject = subject_of(choice, until);
    require_reference_exists(subject);
    const auto selected = select_fixed_step(methods, subject);
    const auto origin = p.origin(subject);
    return p.study(
        subject.about(),
        [&](Study& study) {
          progress().stage("making the reference");
          const Reference reference = reference_for(subject, p.folder(), origin);
          progress().wipe();
          measure_orders(study, *order, subject, selected, reference);
        },
        [&] { return origin; });
  });
}
