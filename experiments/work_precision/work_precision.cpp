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
//     time. The points that decide are timed again when all methods are done; the smaller median
//     counts. --clock processor leaves out the time of other programs.
//  3. points.csv has every point, failed ones with the reason. front.csv has, for each accuracy
//     from 1e-1 to 1e-9, the fastest method known to reach it. Accuracy is that of the positions at
//     the end. Beyond the horizon of a chaotic motion it is that of the energy over time.
//     --accuracies chooses other accuracies; no method is then measured at finer ones.
//     chart.json says what the points mean, for pictures and pages (see chart_record.hpp). --judge
//     makes it anew from the tables of an earlier run.
#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/points.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/record/chart_record.hpp"
#include "experiments/work_precision/chart_files.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/measure/speed/front_again.hpp"
#include "qddot/measure/speed/ladder_points.hpp"

namespace qddot::work_precision {
namespace {

// The points of each method from coarse to fine, whatever the order in which they were taken.
std::vector<Point> from_coarse_to_fine(const std::vector<std::vector<Point>>& taken) {
  std::vector<Point> points;
  for (std::vector<Point> own : taken) {
    std::ranges::sort(own, std::ranges::greater(), &Point::value);
    points.insert(points.end(), own.begin(), own.end());
  }
  return points;
}

// The accuracies of the front from coarse to fine, or the usual ones if none are asked for.
std::vector<double> sorted_accuracies(const Argument<std::vector<double>>& accuracies) {
  if (!accuracies.is_given()) return usual_accuracies();
  std::vector<double> asked = accuracies;
  std::ranges::sort(asked, std::ranges::greater());
  require_each_once(asked, "--accuracies");
  return asked;
}

// The reference and, once it is made, each method.
Shares shares_of(const std::vector<const Method*>& methods) {
  Shares shares{.names = names_of(methods), .chosen_by = {"--methods"}};
  shares.names.insert(shares.names.begin(), reference_share);
  return shares;
}

}  // namespace
}  // namespace qddot::work_precision

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::work_precision;
  Program p("work_precision", "Measures speed against accuracy of every integrator on one scene.",
            {has_threads, has_resume, has_shares});
  auto scene = p.scene();
  auto until = p.until();
  auto methods = p.methods();
  auto accuracies = p.numbers("--accuracies",
                              "a,b,...: accuracies (relative errors) to find the fastest method "
                              "for (default: 1e-1 to 1e-9)")
                        .check_each(require_allowed_accuracy);
  auto usual = p.effort();
  auto options = p.method_options();
  p.out("the folder for points.csv, front.csv, chart.json and reference.json");
  auto judged_folder =
      p.instead("--judge",
                "a folder with points.csv, and front.csv and reference.json if they are there: "
                "makes its chart.json anew and measures nothing");
  auto& points_csv = p.table("points.csv", point_columns());
  auto& front_csv = p.table("front.csv", front_columns);
  auto& chart_json = p.file("chart.json", record::chart_beginning);
  return p.run(argc, argv, [&] {
    if (judged_folder.is_given()) {
      judge(judged_folder);
      return static_cast<int>(done);
    }
    require_options(p, options);
    const std::vector<double> asked = sorted_accuracies(accuracies);
    const Subject subject = subject_of(scene, until);
    require_reference_exists(subject);
    const auto selected = select_methods(methods, subject);
    const auto origin = p.origin(subject);
    std::optional<Reference> reference;
    std::vector<std::vector<Point>> taken;  // by method
    std::vector<Point> again;
    const auto measure = [&](Study& study) {
      progress().stage("making the reference");
      reference = study.measures(reference_share) ? reference_for(subject, p.folder(), origin)
                                                  : kept_reference(subject, p.folder());
      const Watch watch(subject.start(), subject.model, subject.until, *reference);
      Effort effort = usual;
      effort.options = options;
      effort.watch = &watch;
      effort.recall = points_of(study);
      const auto take = [&](const Point& point) { taken.back().push_back(point); };
      const auto is_last = [&](const Point& point) {
        return accuracies.is_given() && judged(point, *reference).is_within(asked.back());
      };
      const auto mine = study.taken(selected);
      progress().begin(mine.size());
      for (const Method* method : mine) {
        taken.emplace_back();
        measure_ladder(*method, subject.model, subject.until, *reference, effort, take, is_last);
        progress().finish(method->name + " is done");
      }
      if (study.is_divided()) return;
      effort.watch = nullptr;
      effort.recall = points_of(study, "again ");
      again =
          time_front_again(from_coarse_to_fine(taken), *reference, asked, [&](const Point& point) {
            return measure_point(*point.method, point.value, subject.model, subject.until,
                                 *reference, effort);
          });
    };
    const auto report = [&](const Study& study) {
      const std::string& name = subject.drawn.name;
      std::vector<Point> points = from_coarse_to_fine(taken);
      take_smaller_times(points, again);
      const StudyEnd end{.interrupted_by = study.interrupted_by(),
                         .are_times_of_work = study.are_times_of_work()};
      if (reference) {
        const Chart chart = chart_of(points, *reference, asked, StabilityMargins(subject.model));
        for (const Point& point : points)
          points_csv.add({name, point, reference->certified.position});
        tabulate(*front_csv, name, chart);
        print_front(name, chart);
        points_csv.note(notes_on(points));
        write_chart(*chart_json, chart, name, end);
      } else {
        Reference unknown;
        unknown.end.t = subject.until;
        write_chart(*chart_json, chart_of(points, unknown, {}, StabilityMargins(0)), name, end);
      }
      return origin;
    };
    return p.study(subject.about(), shares_of(selected), measure, report);
  });
}
