// Speed against accuracy: every method, down the ladder of its knob, on one scene.
//
//   work_precision --scene cloth --until 0.1 --out results/cloth
//   work_precision --scene my.toml --methods verlet,ida --repeats 9 --out results/my
//
//  1. A reference is made by two unlike methods of high order, or exactly where the motion is
//     linear; what they agree to is the certified floor (reference.json, kept for the next time).
//  2. Each method runs from coarse to fine: once untimed unless that takes long, then timed several
//     times, one thread.
//  3. points.csv holds every point, the failed ones with the reason; front.csv, for each accuracy
//     from 1e-1 to 1e-9, the fastest method that reached it.
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/csv.hpp"
#include "experiments/front.hpp"
#include "experiments/ladder.hpp"
#include "experiments/order_options.hpp"
#include "experiments/program.hpp"
#include "experiments/provenance.hpp"
#include "experiments/scene_choice.hpp"
#include "src/scene/invalid_input.hpp"

namespace qddot {
namespace {

struct Arguments {
  SceneChoice scene;
  std::string out;
  double until = 0;
  std::vector<std::string> methods;
  Effort effort;
};

void declare(CLI::App& app, Arguments& a) {
  add_scene_options(app, a.scene);
  app.add_option("--until", a.until, "the time to run to in s (default: the scene's own)");
  app.add_option("--methods", a.methods, "a,b,... (default: all)")->delimiter(',');
  app.add_option("--repeats", a.effort.repeats, "timed runs of each point")
      ->take_last()
      ->capture_default_str();
  app.add_option("--point-limit", a.effort.seconds,
                 "seconds that one run of a point may take; slower ones become over_budget")
      ->take_last()
      ->capture_default_str();
  add_order_options(app, a.effort.orders);
  app.add_option("--out", a.out, "the folder for points.csv, front.csv and reference.json");
}

const std::vector<std::string> point_columns = {"scene",
                                                "method",
                                                "knob",
                                                "value",
                                                "outcome",
                                                "t_reached",
                                                "error_position",
                                                "error_velocity",
                                                "error_energy",
                                                "time_s",
                                                "time_min_s",
                                                "setup_s",
                                                "steps",
                                                "rejected",
                                                "force_evaluations",
                                                "stiffness_evaluations",
                                                "factorizations",
                                                "solves",
                                                "newton_iterations",
                                                "indefinite_factorizations",
                                                "order_mean",
                                                "order_reductions",
                                                "stability_limited_steps",
                                                "timed_runs",
                                                "family",
                                                "order"};
const std::vector<std::string> front_columns = {"scene", "accuracy",       "method", "knob",
                                                "value", "error_position", "time_s"};

void tabulate(Csv& csv, const std::string& scene, const std::vector<Point>& points) {
  for (const Point& p : points) {
    // What was not measured is an empty field.
    const auto measured = [&](double x) {
      return p.outcome == Outcome::reached_end ? x : std::numeric_limits<double>::quiet_NaN();
    };
    const Counts& c = p.counts;
    csv.row(scene, p.method->name, knob_name(p.method->knob), p.value, name(p.outcome), p.t_reached,
            measured(p.errors.position), measured(p.errors.velocity), measured(p.errors.energy),
            measured(p.time), measured(p.time_min), measured(p.setup), c.steps, c.rejected,
            c.force_evaluations, c.stiffness_evaluations, c.factorizations, c.solves,
            c.newton_iterations, c.indefinite_factorizations, order_mean(c), c.order_reductions,
            c.stability_limited_steps, p.timed_runs, family_name(p.method->family),
            p.method->order);
  }
}

void tabulate(Csv& csv, const std::string& scene, const std::vector<FrontRow>& front) {
  for (const FrontRow& row : front) {
    if (const Point* p = row.fastest) {
      csv.row(scene, row.accuracy, p->method->name, knob_name(p->method->knob), p->value,
              p->errors.position, p->time);
    } else {
      csv.row(scene, row.accuracy, "", "", "", "", "");
    }
  }
}

// One line on a terminal that is written over; nothing where the output is kept.
void show_progress(const std::string& what) {
  if (::isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K{}", what);
}

std::string describe(const Point& p) {
  return p.outcome == Outcome::reached_end
             ? fmt::format("{} {} {:.3g}: error {:.1e} in {:.3g} s", p.method->name,
                           knob_name(p.method->knob), p.value, p.errors.position, p.time)
             : fmt::format("{} {} {:.3g}: {}", p.method->name, knob_name(p.method->knob), p.value,
                           name(p.outcome));
}

int work_precision(const CLI::App& app, const Arguments& a,
                   const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  require_positive(a.effort.seconds, "--point-limit", "the seconds a run may take");
  if (a.effort.repeats < 1 || a.effort.repeats > 1000) {
    throw InvalidInput(fmt::format(
        "--repeats {} is not allowed; it is a whole number from 1 to 1000", a.effort.repeats));
  }
  require_orders(app, a.effort.orders);
  const Scene drawn = load(a.scene);
  const double until = horizon(a.until, app.count("--until") > 0, drawn);
  const Scene start = started(drawn, a.scene);
  const ReducedScene scene(start, reductions_of(a.scene));
  require_reference_exists(scene, a.scene.name);
  const auto selected = select_methods(a.methods, scene, a.scene.name);
  require_folder(a.out);
  CsvFile points_csv(a.out + "/points.csv", point_columns);
  CsvFile front_csv(a.out + "/front.csv", front_columns);

  nlohmann::json origin = provenance(command_line, drawn, start, scene);
  origin["until"] = until;
  show_progress("making the reference ...");
  const Reference reference = reference_for(drawn, scene, until, a.out, origin);

  std::vector<Point> points;
  for (const Method* method : selected) {
    const auto more = climb(*method, scene, until, reference, a.effort,
                            [](const Point& point) { show_progress(describe(point)); });
    points.insert(points.end(), more.begin(), more.end());
  }
  show_progress("");

  const auto front = fastest_at_each_accuracy(points, reference);
  tabulate(points_csv, drawn.name, points);
  tabulate(front_csv, drawn.name, front);
  points_csv.commit(origin);
  front_csv.commit(origin);
  print_front(drawn.name, until, front, reference);
  return done;
}

}  // namespace
}  // namespace qddot

int main(int argc, char** argv) {
  CLI::App app("Measures speed against accuracy of every integrator on one scene.",
               "work_precision");
  qddot::Arguments arguments;
  qddot::declare(app, arguments);
  return qddot::run_program(app, argc, argv, [&] {
    return qddot::work_precision(app, arguments, {argv, argv + argc});
  });
}
