#include "experiments/motions/kept_motions.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::motions {
namespace {

// Frames times nodes that a motion has unless more frames are asked for.
constexpr double most_positions = 6e5;
constexpr int fewest_frames = 20, usual_frames = 100;

const std::vector<std::string> columns = kit::columns_in(
    "file role method knob value outcome t_reached frames largest_distance why seconds "
    "seconds_force seconds_stiffness seconds_factorization seconds_solve");

const std::string place = "motions/", unfinished = "motions.part/", ending = ".vtkhdf";

// The motions that a table of before names, the reference's first if it has one; none where there
// is no such table. Files elsewhere are no motions of the folder, whoever wrote that they are.
std::vector<std::string> motions_in(const std::string& table) {
  std::vector<std::string> files;
  try {
    const kit::WrittenTable rows(table, {"file"});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string& file = rows.text(i, "file");
      const bool is_here = file.starts_with(place) && file.rfind('/') + 1 == place.size();
      if (is_here && file.ends_with(ending)) files.push_back(file);
    }
  } catch (const InvalidInput&) {
  }
  return files;
}

// Throws CannotWrite.
void move(const std::string& from, const std::string& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) {
    throw kit::CannotWrite(fmt::format("{}: cannot be written: {}", to, error.message()));
  }
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
TimedRun timed_run(const Model& scene, double until, const Method& method, Options options,
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

std::vector<double> frame_times(double until, int frames) {
  std::vector<double> times;
  for (int i = 0; i <= frames; ++i) times.push_back(i == frames ? until : until * i / frames);
  return times;
}

int usual_number_of_frames(std::size_t nodes) {
  const double fit = most_positions / static_cast<double>(std::max<std::size_t>(nodes, 1));
  return static_cast<int>(std::clamp<double>(fit, fewest_frames, usual_frames));
}

namespace {

// Damped scenes have the energy that damping has taken, too, driven ones what driving has given,
// and those whose springs may change phases what broken ones held.
std::vector<std::string> energy_columns(const Model& scene) {
  std::vector<std::string> names = {"file", "t", "kinetic", "potential", "total"};
  if (scene.system().damping()) names.push_back("dissipated");
  if (scene.system().driving()) names.push_back("driven");
  if (scene.system().switching()) names.push_back("released");
  return names;
}

}  // namespace

KeptMotions::KeptMotions(const std::string& folder, const Scene& start, const Model& scene,
                         std::vector<double> times, const nlohmann::json& origin)
    : folder_(folder),
      start_(start),
      scene_(scene),
      times_(std::move(times)),
      earlier_(motions_in(folder + "/motions.csv")),
      earlier_runs_(earlier_.size() - std::ranges::count(earlier_, place + "reference" + ending)),
      table_(folder + "/motions.csv", columns),
      energy_(folder + "/motions_energy.csv", energy_columns(scene)),
      origin_(origin) {
  std::filesystem::remove_all(folder_ + "/" + unfinished);
  kit::require_folder(folder_ + "/" + unfinished);
}

KeptMotions::~KeptMotions() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_ + "/" + unfinished, ignored);
}

void KeptMotions::add_reference(const ReferenceMotion& motion) {
  reference_ = motion.states;
  const auto [file, frames] = write("reference", reference_, 1, true);
  table_.row(file, "reference", motion.method->name, knob_name(motion.method->knob), motion.value,
             name(Outcome::reached_end), times_.back(), frames, "",
             fmt::format("within {:.1e} of the reference at the end", motion.error), "", "", "", "",
             "");
}

void KeptMotions::add(const ChosenRun& run, const Options& options, const Reference& reference,
                      double seconds) {
  const Method& method = *run.point->method;
  const Options own = options_for(method, run.point->value, scene_, options);
  const std::size_t every = spacing(*run.point, times_.size());
  auto states = states_at(thinned(times_, every), scene_, method, own, seconds);
  // A step that fails as a whole is seen on its way, as shorter steps may not fail.
  if (run.point->outcome != Outcome::reached_end) {
    std::erase_if(states, [&](const State& state) { return state.t > run.point->t_reached; });
  }
  const auto [summary, whole] = timed_run(scene_, times_.back(), method, own, seconds);
  const auto [file, frames] =
      write(fmt::format("{}_{:.12g}", method.name, run.point->value), states, every, false);
  const std::string other = difference(*run.point, states.back(), reference);
  const std::string why = run.why + (run.why.empty() || other.empty() ? "" : "; ") + other;
  states.resize(frames);
  const Seconds& part = summary.seconds;
  table_.row(file, "run", method.name, knob_name(method.knob), run.point->value,
             name(run.point->outcome), run.point->t_reached, frames,
             largest_distance(states, every, reference), why, whole, part.force, part.stiffness,
             part.factorization, part.solve);
  ++runs_;
}

void KeptMotions::finish(const nlohmann::json& origin) {
  table_.complete(origin);
  energy_.complete(origin);
  kit::require_folder(folder_ + "/" + place);
  for (const std::string& before : earlier_) {
    for (const std::string& file : motion_files::files_of_motion(folder_ + "/" + before, "file")) {
      std::error_code ignored;
      std::filesystem::remove(file, ignored);
    }
  }
  for (const auto& file : std::filesystem::directory_iterator(folder_ + "/" + unfinished)) {
    move(file.path().string(), folder_ + "/" + place + file.path().filename().string());
  }
  table_.commit();
  energy_.commit();
}

KeptMotions::Written KeptMotions::write(const std::string& name, const std::vector<State>& states,
                                        std::size_t every, bool is_reference) {
  const std::string file_name = name + ending, path = folder_ + "/" + unfinished + file_name;
  const std::string own = folder_ + "/" + place + file_name;
  for (const std::string& file : motion_files::files_of_motion(own, "file")) {
    kit::require_replaceable(file, {}, kit::sidecar_of(own));
  }
  const bool is_compared = !is_reference && !reference_.empty();
  const auto file = motion_files::open_motion(path, start_, scene_, is_compared, {},
                                              motion_files::Readers::of_vtkhdf);
  std::size_t frames = 0;
  for (; frames < states.size(); ++frames) {
    const State& state = states[frames];
    if (!file->add(state, is_compared ? &reference_[frames * every] : nullptr)) break;
    const double kinetic = scene_.kinetic(state), potential = scene_.potential(state);
    const std::string motion = place + file_name;
    const double total = kinetic + potential;
    energy_.field(motion);
    for (const double value : {state.t, kinetic, potential, total}) energy_.field(value);
    if (scene_.system().damping()) energy_.field(state.work.dissipated);
    if (scene_.system().driving()) energy_.field(scene_.driven(state));
    if (scene_.system().switching()) energy_.field(scene_.released(state));
    energy_.end_row();
  }
  file->complete(origin_);
  file->commit();
  for (const std::string& part : motion_files::files_of_motion(path, "file")) {
    std::error_code is_missing;
    const auto bytes = std::filesystem::file_size(part, is_missing);
    if (!is_missing) bytes_ += static_cast<double>(bytes);
  }
  return {place + file_name, frames};
}

std::string KeptMotions::difference(const Point& point, const State& end,
                                    const Reference& reference) const {
  constexpr double seen = 0.2;
  if (point.outcome != Outcome::reached_end || end.t < times_.back()) return "";
  const double error =
      errors_between(scene_, end, reference.end, reference.energy, reference.scales).position;
  const double on_chart = point.errors.position;
  if (std::abs(error - on_chart) <= seen * on_chart + 2 * reference.certified.position) return "";
  return fmt::format(
      "its steps end at the frames here, so that its error is {:.1e} instead of {:.1e}", error,
      on_chart);
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
