#include "experiments/motions/kept_motions.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/command/program.hpp"
#include "experiments/command/written_table.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::motions {
namespace {

const std::vector<std::string> columns = {"file",
                                          "role",
                                          "method",
                                          "knob",
                                          "value",
                                          "outcome",
                                          "t_reached",
                                          "frames",
                                          "largest_distance",
                                          "why",
                                          "seconds",
                                          "seconds_force",
                                          "seconds_stiffness",
                                          "seconds_factorization",
                                          "seconds_solve"};

// The motions that a table of before names; none where there is no such table.
std::vector<std::string> motions_in(const std::string& table) {
  std::vector<std::string> files;
  try {
    const command::WrittenTable rows(table, {"file"});
    for (std::size_t i = 0; i < rows.size(); ++i) files.push_back(rows.text(i, "file"));
  } catch (const InvalidInput&) {
  }
  return files;
}

// Every how many-th of the times a run is seen: all of them where that changes no step.
std::size_t spacing(const Point& point, std::size_t times) {
  constexpr std::int64_t steps_a_frame = 4;
  const Method& method = *point.method;
  const auto frames = static_cast<std::int64_t>(times) - 1;
  if (method.knob == Knob::step_size || method.is(Trait::interpolates)) return 1;
  for (std::int64_t every = 1; every < frames; ++every) {
    const bool is_even = frames % every == 0;
    if (is_even && frames / every * steps_a_frame <= point.counts.steps) {
      return static_cast<std::size_t>(every);
    }
  }
  return static_cast<std::size_t>(frames);
}

std::vector<double> thinned(const std::vector<double>& times, std::size_t every) {
  std::vector<double> fewer;
  for (std::size_t i = 0; i < times.size(); i += every) fewer.push_back(times[i]);
  return fewer;
}

struct TimedRun {
  Summary summary;
  double seconds = 0;  // in all
};

// The run without anybody who looks, timed by phase.
TimedRun timed_run(const ReducedScene& scene, double until, const Method& method, Options options,
                   double seconds) {
  options.timed = true;
  const auto integrator = make_integrator(method, scene.system(), options);
  const Deadline deadline(seconds);
  State state = scene.initial();
  TimedRun run;
  run.seconds =
      seconds_of([&] { run.summary = integrator->advance(state, until, {}, deadline.token()); });
  stop_if_interrupted();
  return run;
}

}  // namespace

KeptMotions::KeptMotions(const std::string& folder, const Scene& start, const ReducedScene& scene,
                         std::vector<double> times, const nlohmann::json& origin)
    : folder_(folder),
      start_(start),
      scene_(scene),
      times_(std::move(times)),
      earlier_(motions_in(folder + "/motions.csv")),
      table_(folder + "/motions.csv", columns),
      energy_(folder + "/motions_energy.csv", {"file", "t", "kinetic", "potential", "total"}),
      origin_(origin) {
  command::require_folder(folder + "/motions");
}

void KeptMotions::add_reference(const ReferenceMotion& motion) {
  reference_ = motion.states;
  const std::string file = write("reference", reference_, 1, true);
  table_.row(file, "reference", motion.method->name, knob_name(motion.method->knob), motion.value,
             name(Outcome::reached_end), times_.back(), reference_.size(), "",
             fmt::format("within {:.1e} of the reference at the end", motion.error), "", "", "", "",
             "");
}

void KeptMotions::add(const ChosenRun& run, const Options& options, const Reference& reference,
                      double seconds) {
  const Method& method = *run.point->method;
  const Options own = options_for(method, run.point->value, scene_, options);
  const std::size_t every = spacing(*run.point, times_.size());
  const auto states = states_at(thinned(times_, every), scene_, method, own, seconds);
  const auto [summary, whole] = timed_run(scene_, times_.back(), method, own, seconds);
  const std::string file =
      write(fmt::format("{}_{:.12g}", method.name, run.point->value), states, every, false);
  const Seconds& part = summary.seconds;
  table_.row(file, "run", method.name, knob_name(method.knob), run.point->value,
             name(run.point->outcome), run.point->t_reached, states.size(),
             largest_distance(states, every, reference), run.why, whole, part.force, part.stiffness,
             part.factorization, part.solve);
  ++runs_;
}

void KeptMotions::finish(const nlohmann::json& origin) {
  table_.complete(origin);
  energy_.complete(origin);
  table_.commit();
  energy_.commit();
  for (const std::string& before : earlier_) {
    if (std::ranges::find(files_, before) != files_.end()) continue;
    for (const std::string& file : motion_files::files_of_motion(folder_ + "/" + before, "file")) {
      std::error_code ignored;
      std::filesystem::remove(file, ignored);
    }
  }
}

std::string KeptMotions::write(const std::string& name, const std::vector<State>& states,
                               std::size_t every, bool is_reference) {
  const std::string place = fmt::format("motions/{}.vtkhdf", name), path = folder_ + "/" + place;
  const bool is_compared = !is_reference && !reference_.empty();
  const auto file = motion_files::open_motion(path, start_, scene_, is_compared);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const State& state = states[i];
    if (!file->add(state, is_compared ? &reference_[i * every] : nullptr)) break;
    const double kinetic = scene_.kinetic(state), potential = scene_.potential(state);
    energy_.row(place, state.t, kinetic, potential, kinetic + potential);
  }
  file->complete(origin_);
  file->commit();
  for (const std::string& part : motion_files::files_of_motion(path, "file")) {
    bytes_ += static_cast<double>(std::filesystem::file_size(part));
  }
  files_.push_back(place);
  return place;
}

double KeptMotions::largest_distance(const std::vector<State>& states, std::size_t every,
                                     const Reference& reference) const {
  if (reference_.empty()) return std::numeric_limits<double>::quiet_NaN();
  double largest = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    largest =
        std::max(largest, position_error(scene_.expand(states[i]),
                                         scene_.expand(reference_[i * every]), reference.scales));
  }
  return largest;
}

}  // namespace qddot::motions
