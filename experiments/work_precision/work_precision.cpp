// Speed against accuracy: every method, over the values of its knob, on one scene.
//
//   work_precision --scene cloth --until 0.1 --out results/cloth
//   work_precision --scene my.toml --methods verlet,ida --repeats 9 --out results/my
//
//  1. Two unlike methods of high order make a reference, which is exact if the motion is linear.
//     The differences of both and of their last refinements bound its error (reference.json, kept
//     for the next time). A third run, which starts one rounding away, shows the horizon of a
//     chaotic motion. If the motion stays in a plane, on a line or symmetric, a fourth run shows
//     the effect of a push out of symmetry.
//  2. Each method runs from coarse to fine on one thread: once untimed unless that takes long, then
//     several times timed. One more run measures the largest energy error and the momenta over
//     time.
//  3. points.csv has every point, failed ones with the reason. front.csv has, for each accuracy
//     from 1e-1 to 1e-9, the fastest method known to reach it. Accuracy is that of the positions at
//     the end, or of the energy over time if the end is beyond the horizon of a chaotic motion.
//     --accuracies chooses other accuracies; no method is then measured at finer ones.
//     chart.json says what the points mean, for pictures and pages (see chart_record.hpp). --judge
//     makes it anew from the tables of an earlier run.
#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/accuracy_choice.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/method_options.hpp"
#include "experiments/kit/point_notes.hpp"
#include "experiments/kit/point_record.hpp"
#include "experiments/kit/point_table.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/kit/sweep_progress.hpp"
#include "experiments/work_precision/chart_file.hpp"
#include "experiments/work_precision/front_table.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/measure/speed/ladder_points.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::work_precision {
namespace {

struct Arguments {
  SceneChoice scene;
  std::string out;
  double until = 0;
  std::vector<std::string> methods;
  std::vector<double> accuracies;
  std::string judged;
  Effort effort;
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option("--until", a.until, "the time to run to in s (default: the scene's own)");
  line.add_option("--methods", a.methods, "a,b,...: the methods (default: all)").delimiter(',');
  line.add_option("--accuracies", a.accuracies,
                  "a,b,...: accuracies (relative errors) to find the fastest method for (default: "
                  "1e-1 to 1e-9)")
      .delimiter(',');
  line.add_option("--repeats", a.effort.repeats, "timed runs of each point")
      .take_last()
      .capture_default_str();
  line.add_option("--point-limit", a.effort.seconds,
                  "seconds that one run of a point may take; slower ones become over_budget")
      .take_last()
      .capture_default_str();
  add_method_options(line, a.effort.options);
  line.add_option("--out", a.out,
                  "the folder for points.csv, front.csv, chart.json and reference.json");
  line.add_option("--judge", a.judged,
                  "a folder with points.csv, and front.csv and reference.json if they are there: "
                  "makes its chart.json anew and measures nothing");
}

const std::vector<std::string> front_columns = {"scene",  "accuracy",  "method",
                                                "knob",   "value",     "error_position",
                                                "time_s", "judged_by", "stability_margin"};

void tabulate(Csv& csv, const std::string& scene, const Chart& chart) {
  const char* judge = name(chart.judge);
  for (const FrontRow& row : chart.front) {
    if (const Point* p = row.fastest) {
      csv.row(scene, row.accuracy, p->method->name, knob_name(p->method->knob), p->value,
              p->errors.position, p->time, judge, row.stability_margin);
    } else {
      csv.row(scene, row.accuracy, "", "", "", "", "", judge, "");
    }
  }
}

// The points of each method from coarse to fine, whatever the order in which they were taken.
std::vector<Point> from_coarse_to_fine(const std::vector<std::vector<Point>>& taken) {
  std::vector<Point> points;
  for (std::vector<Point> own : taken) {
    std::ranges::sort(own, std::ranges::greater(), &Point::value);
    points.insert(points.end(), own.begin(), own.end());
  }
  return points;
}

// The accuracies of the front from coarse to fine, or the usual ones where none are asked for.
std::vector<double> accuracies_of(const CommandLine& line, const Arguments& a) {
  if (!line.has("--accuracies")) return usual_accuracies();
  std::vector<double> asked = a.accuracies;
  for (const double accuracy : asked) require_allowed_accuracy(accuracy, "--accuracies");
  std::ranges::sort(asked, std::ranges::greater());
  const auto twice = std::ranges::adjacent_find(asked);
  if (twice != asked.end()) {
    throw InvalidInput(fmt::format("--accuracies: {:g} is named twice; allowed is once", *twice));
  }
  return asked;
}

// The reference and, once it is made, each method.
Shares shares_of(const std::vector<const Method*>& methods) {
  Shares shares{.names = names_of(methods), .chosen_by = {"--methods"}};
  shares.names.insert(shares.names.begin(), reference_share);
  return shares;
}

int work_precision(const CommandLine& line, const Arguments& a,
                   const std::vector<std::string>& command_line) {
  if (line.has("--judge")) {
    for (const auto& [option, values] : line.given()) {
      if (option != "--judge" && option != "--force" && option != "--progress")
        throw InvalidInput(
            fmt::format("{} is not allowed with --judge, which measures nothing", option));
    }
    judge(a.judged);
    return done;
  }
  require_given(a.out, "--out", "the folder for the results");
  require_positive(a.effort.seconds, "--point-limit", "the seconds a run may take");
  require_repeats(a.effort.repeats);
  require_options(line, a.effort.options);
  const std::vector<double> accuracies = accuracies_of(line, a);
  const Scene drawn = load(a.scene);
  const double until = end_time(a.until, line.has("--until"), drawn);
  const Scene start = started(drawn, a.scene);
  const ReducedScene scene(start, reductions_of(a.scene));
  require_reference_exists(scene, a.scene.name);
  auto selected = select_methods(a.methods, scene, a.scene.name);
  Study study(line, a.out, {"points.csv", "front.csv"},
              {{"scene", content_hash(drawn)}, {"name", drawn.name}, {"until", until}},
              shares_of(selected));
  if (const auto status = study.completed()) return *status;
  std::erase_if(selected, [&](const Method* method) { return !study.takes(method->name); });
  CsvFile points_csv(a.out + "/points.csv", point_columns().header());
  CsvFile front_csv(a.out + "/front.csv", front_columns);
  WholeFile chart_json = chart_file(a.out);

  nlohmann::json origin = provenance(command_line, drawn, start, scene);
  origin["until"] = until;
  std::optional<Reference> reference;
  std::vector<std::vector<Point>> taken;  // by method
  study.measure([&] {
    progress().stage("making the reference");
    reference = study.measures(reference_share)
                    ? reference_for(drawn, start, scene, until, a.out, origin)
                    : kept_reference(drawn, scene, until, a.out);
    const Watch watch(start, scene, until, *reference);
    Effort effort = a.effort;
    effort.watch = &watch;
    const auto is_last = [&](const Point& point) {
      return line.has("--accuracies") && judged(point, *reference).is_within(accuracies.back());
    };
    SweepProgress shown(selected, SweepBound(scene, until, effort));
    effort.recall = shown.seen(points_of(study));
    for (const Method* method : selected) {
      taken.emplace_back();
      measure_ladder(
          *method, scene, until, *reference, effort,
          [&](const Point& point) {
            shown.take(point);
            taken.back().push_back(point);
          },
          is_last);
      shown.finish();
    }
  });
  if (study.is_share()) return study.conclude(done);

  const std::vector<Point> points = from_coarse_to_fine(taken);
  const StudyEnd end{.interrupted_by = study.interrupted_by(),
                     .are_times_of_work = study.are_times_of_work()};
  nlohmann::json origin_of_points = origin;
  if (reference) {
    const Chart chart = chart_of(points, *reference, accuracies, StabilityMargins(scene));
    for (const Point& point : points)
      point_columns().write_row(points_csv, {drawn.name, point, reference->certified.position});
    tabulate(front_csv, drawn.name, chart);
    print_front(drawn.name, chart);
    origin_of_points.update(notes_on(points));
    write_chart(chart_json, chart, drawn.name, end);
  } else {
    Reference unknown;
    unknown.end.t = until;
    write_chart(chart_json, chart_of(points, unknown, {}, StabilityMargins(0)), drawn.name, end);
  }
  study.complete(points_csv, origin_of_points, done);
  study.complete(front_csv, origin, done);
  study.complete(chart_json);
  return study.conclude(done);
}

}  // namespace
}  // namespace qddot::work_precision

int main(int argc, char** argv) {
  using namespace qddot::work_precision;
  return qddot::kit::enter<Arguments>(
      {.name = "work_precision",
       .summary = "Measures speed against accuracy of every integrator on one scene.",
       .has_threads = true,
       .has_resume = true,
       .has_shares = true},
      declare, work_precision, argc, argv);
}
