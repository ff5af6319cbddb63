// How do the runs of a work-precision chart move, beside the reference?
//
//   work_precision --scene cloth --out results/cloth
//   motions --scene cloth --out results/cloth
//
//  1. The folder's points.csv says which runs there are; the options that they were measured with
//     come from its sidecar. The most telling come first (see chosen_runs.hpp).
//  2. The reference's motion is that of a fast and very accurate run, compared with the reference
//     at the end. Each run is made once more, seen at the same times; and once unseen, timed by
//     phase: forces, stiffness matrices, factorisations, solves.
//  3. motions/METHOD_VALUE.vtkhdf holds a motion, with each node's distance from the reference;
//     motions.csv lists them, motions_energy.csv has their energies. A run that fails has a motion
//     up to where it did.
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "experiments/kit/interruptible.hpp"
#include "experiments/kit/points.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/motion_files/motion_file.hpp"
#include "experiments/motions/chosen_runs.hpp"
#include "experiments/motions/kept_motions.hpp"
#include "experiments/motions/reference_motion.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/measure/speed/front.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::motions {
namespace {

// Runs, bytes of their motions and seconds that a folder gets unless more runs are asked for.
constexpr std::size_t most_runs = 120;
constexpr double most_bytes = 256e6, most_seconds = 60;
constexpr int largest_count = 10000;        // runs or frames
constexpr double longest_run = 10;          // [s]
constexpr double longest_reference = 15;    // [s]
constexpr double patience_with_a_run = 30;  // [s], after an interruption

// Keeps the runs, the most telling first, until they are enough.
void keep(const std::vector<ChosenRun>& runs, bool all, const Options& options,
          const Reference& reference, KeptMotions& kept) {
  progress().begin(runs.size());
  const auto begin = std::chrono::steady_clock::now();
  for (const ChosenRun& run : runs) {
    const double left = most_seconds - seconds_since(begin);
    if (!all && (kept.bytes() > most_bytes || left < 0)) return;
    const Method& method = *run.point->method;
    const std::string words = method.name + " " + knob_in_words(method, run.point->value);
    progress().now_at(words);
    kept.add(run, options, reference, longest_run);
    progress().finish(words);
  }
}

}  // namespace
}  // namespace qddot::motions

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::motions;
  Program p("motions",
            "Keeps the motions of the runs of a work-precision chart, beside the reference.",
            {has_threads});
  auto scene = p.drawn_scene();
  auto frames =
      p.whole("--frames", "number of frames after the start (default: 100, fewer for large scenes)")
          .last()
          .within(1, largest_count);
  auto most = p.whole("--runs",
                      "number of runs to keep, the most telling first (default: 120, fewer if "
                      "these take more than 256 MB or a minute)")
                  .last()
                  .within(1, largest_count);
  p.out("the folder of work_precision's points.csv, for motions.csv and motions/",
        "the folder that work_precision wrote points.csv into");
  return p.run(argc, argv, [&]() -> int {
    Scene drawn = load(scene);
    const MeasuredPoints study = measured_points(p.folder());
    if (study.scene_hash != content_hash(drawn)) {
      throw InvalidInput(
          fmt::format("--scene {}: {}/points.csv is of another scene, or of this one before it was "
                      "changed; work_precision measures this one",
                      scene->name, p.folder()));
    }
    const Subject subject =
        subject_of(std::move(drawn), {scene->name, study.no_reduce}, study.until);
    nlohmann::json origin = p.origin(subject);
    origin["study"] = study.key;
    const Reference reference = reference_for(subject, p.folder(), origin);
    const auto front = fastest_at_each_accuracy(study.points, reference);
    if (study.points.empty()) {
      throw InvalidInput(
          fmt::format("{}/points.csv: it has no runs; work_precision measures some", p.folder()));
    }
    auto runs = chosen_runs(study.points, front);
    const std::size_t all = runs.size();
    runs.resize(std::min(all, most.is_given() ? static_cast<std::size_t>(*most) : most_runs));

    const auto times = frame_times(
        study.until,
        frames.is_given() ? *frames : usual_number_of_frames(subject.start().nodes.size()));
    KeptMotions kept(p.folder(), subject.start(), subject.model, times, origin);
    wait_for_answer(patience_with_a_run);
    std::optional<Interruption> why;
    try {
      progress().stage("making the reference's motion");
      const auto moves = reference_motion(times, subject.model, reference, study.points,
                                          study.options, longest_reference);
      if (moves) {
        kept.add_reference(*moves);
        origin["reference_error"] = moves->error;
      }
      keep(runs, most.is_given(), study.options, reference, kept);
    } catch (const Interrupted&) {
      why = interrupted();
    }
    progress().wipe();
    if (why && kept.runs() < kept.earlier_runs()) {
      fmt::print(stderr,
                 "motions: interrupted by {}: {} of {} runs were made; the {} former ones stay\n",
                 why->by, kept.runs(), all, kept.earlier_runs());
      return why->status;
    }
    origin["interrupted"] = why ? nlohmann::json(why->by) : nullptr;
    origin["displacement"] = reference.scales.displacement;
    origin["runs_left_out"] = all - kept.runs();
    kept.finish(origin);
    fmt::print("{}: {} of {} runs, {} frames each, {:.3g} MB in {}/motions\n",
               in_one_line(subject.drawn.name), kept.runs(), all, times.size(), 1e-6 * kept.bytes(),
               p.folder());
    if (!why) return done;
    fmt::print(stderr, "motions: interrupted by {}: {} of {} runs are kept\n", why->by, kept.runs(),
               all);
    return why->status;
  });
}
