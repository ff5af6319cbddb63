#include "qddot/measure/advice/solve_with_rods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "qddot/algebra/constraint_forces.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/ended_vibration.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/rods.hpp"

namespace qddot::inline measure {
namespace {

// A step of RATTLE takes as long as about four forces, and runs are made to bound what rods change.
// Only steps that are so many times longer are worth it, and no check by as much work as Verlet's
// method takes with the springs.
constexpr double least_gain = 10, forces_of_step = 4;
// Springs are stiff beside others if they are so many times stiffer.
constexpr double least_ratio = 30;
// The part of the accuracy for the run with rods.
constexpr double part_of_run = 1 - part_of_change;
// The part of the motion after which a vibration has to be ended at the latest: until then the
// springs are run.
constexpr double part_with_springs = 0.125;
// Turns of the fastest vibration after which it is looked at for the first time.
constexpr double first_turns = 8;
// A run of RATTLE tells the effect of compliance if its own error is this part of the motion.
constexpr double resolved = 0.02;

// The scene with rods in place of the springs above a stiffness; with their stiffness kept for the
// check, or without. The same springs are rods in both.
Scene with_rods(const Scene& start, double stiffness, bool is_compliant) {
  Scene scene = start;
  for (Spring& spring : scene.springs) {
    const SpringLaw law = spring.law;
    const auto [a, b] = spring.nodes;
    const bool is_held = scene.nodes[a].pinned && scene.nodes[b].pinned;
    if (law.rigid || is_held || !(law.stiffness > stiffness) || !law.is_plain()) continue;
    spring.law = {.stiffness = is_compliant ? law.stiffness : 0,
                  .rest_length = law.rest_length,
                  .rigid = true};
  }
  return scene;
}

// A start at which springs above a stiffness may be rods, and whether it was moved there from the
// drawn one.
struct StartOnRods {
  Scene start;
  bool is_moved = false;
};

// Nothing if some of these rods are redundant, or if springs hold energy that damping cannot take
// before the end, of which alone the accuracy must be.
std::optional<StartOnRods> started_on_rods(const Scene& start, double stiffness,
                                           const Reductions& reductions, AccuracyOf of) {
  const auto is_valid = [&](const Scene& scene) {
    try {
      validate_rods(with_rods(scene, stiffness, false), scene.name);
    } catch (const InvalidInput&) {
      return false;
    }
    return true;
  };
  if (is_valid(start)) return StartOnRods{start};
  const bool is_damped =
      start.air_damping > 0 || std::ranges::any_of(start.springs, [&](const Spring& spring) {
        return spring.law.damping > 0 && spring.law.stiffness > stiffness;
      });
  if (!is_damped || of != AccuracyOf::positions) return {};
  const auto laid = laid_on_rods(with_rods(start, stiffness, false), reductions);
  if (!laid) return {};
  StartOnRods moved{start, true};
  moved.start.nodes = laid->nodes;
  if (!is_valid(moved.start)) return {};
  return moved;
}

// The largest number of rods in a row: of the shortest ways along rods between two nodes. From the
// farthest node of any node the way to its own farthest is at least half of it, and all of it in a
// row or a ring's half.
std::size_t longest_row(const Scene& scene) {
  std::vector<std::vector<std::size_t>> next(scene.nodes.size());
  for (const Spring& spring : scene.springs) {
    if (!spring.law.rigid) continue;
    next[spring.nodes[0]].push_back(spring.nodes[1]);
    next[spring.nodes[1]].push_back(spring.nodes[0]);
  }
  constexpr int unseen = -1, done = -2;
  std::vector<int> rods(scene.nodes.size(), unseen);  // on the way to each node
  // The nodes that rods join with one, the farthest last.
  const auto joined = [&](std::size_t from, int before) {
    std::vector<std::size_t> all = {from};
    rods[from] = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (const std::size_t node : next[all[i]]) {
        if (rods[node] != before) continue;
        rods[node] = rods[all[i]] + 1;
        all.push_back(node);
      }
    }
    return all;
  };
  int longest = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (rods[i] != unseen || next[i].empty()) continue;
    const std::vector<std::size_t> all = joined(i, unseen);
    for (const std::size_t node : all) rods[node] = done;
    longest = std::max(longest, rods[joined(all.back(), done).back()]);
  }
  return static_cast<std::size_t>(longest);
}

// The largest stretch tau/k [m] of a spring that a rod stands for, on the way of a run.
double largest_stretch(const Model& model, const Scene& compliant, const std::vector<State>& path) {
  ConstraintForces forces(model.system());
  double largest = 0;
  const auto see = [&](const State& state) {
    const Vec tensions = model.tensions_by(forces.at(state));
    for (std::size_t k = 0; k < model.rods().size(); ++k) {
      const double stiffness = compliant.springs[model.rods()[k]].law.stiffness;
      if (stiffness > 0)
        largest = std::max(largest, std::abs(tensions[static_cast<Index>(k)]) / stiffness);
    }
  };
  see(model.initial());
  for (const State& state : path) see(state);
  return largest;
}

// A bound of the change that rods make, relative to the motion; nothing if it is not known by steps
// down to `least_step` [s], or if that takes more than `seconds`. Throws Interrupted.
std::optional<double> change_by_rods(const Scene& rigid_scene, const Scene& compliant_scene,
                                     const std::shared_ptr<const Model>& rigid,
                                     const Reductions& reductions, double until,
                                     const Wanted& wanted, const Answer& answer, double least_step,
                                     double seconds) {
  constexpr Rules rules;
  const auto begin = clock_now();
  const auto limits = [&] {
    return Limits{.seconds = std::max(0.0, seconds - seconds_since(begin))};
  };
  const auto row = static_cast<double>(longest_row(rigid_scene));
  const Model compliant(compliant_scene, reductions);
  const Method& method = *find_method("rattle");
  Stage rods_alone(*rigid, until, wanted.of, &rigid_scene, rules),
      with_stretch(compliant, until, wanted.of, &compliant_scene, rules);
  Trial truth{.method = answer.method, .value = answer.value};
  truth.summary.outcome = Outcome::reached_end;
  truth.path = {answer.end};
  const double first = answer.method == &method ? answer.value : until / rules.places;
  // The answer's own run knows tensions to its accuracy. Those of coarse runs may be zero where a
  // wave has hardly come.
  const Trial accurate = rods_alone.run(*answer.method, answer.value, limits());
  if (!accurate.reached_end()) return {};
  const double stretch_of_answer = largest_stretch(*rigid, compliant_scene, accurate.path);
  // The change and the error of the run at twice the step.
  std::optional<double> last;
  double last_error = std::numeric_limits<double>::infinity();
  for (double h = first; h >= least_step; h /= 2) {
    const Trial run = rods_alone.run(method, h, limits());
    if (run.summary.outcome == Outcome::over_budget) return {};
    if (!run.reached_end()) continue;
    rods_alone.measure_by(run);
    Trial end = run;
    end.path = {run.path.back()};
    const double error = rods_alone.distance(end, truth);
    // Errors that do not fall resolve no motion, unless it is the answer's own error that is seen.
    const bool falls = error <= last_error / 2 || error <= rules.doubt * answer.error_estimate;
    last_error = error;
    if (error > resolved || !falls) {
      last.reset();
      continue;
    }
    const Trial stretched = with_stretch.run(method, h, limits());
    if (!stretched.reached_end()) continue;
    const double stretch =
        std::max(stretch_of_answer, largest_stretch(*rigid, compliant_scene, run.path));
    const double change =
        rods_alone.distance(run, stretched) + row * stretch / rods_alone.least_scale();
    if (last) {
      // Two steps that agree resolve it. What is small beside the accuracy need not be known
      // better.
      const double larger = std::max(change, *last);
      const bool agree = larger <= rules.doubt * std::min(change, *last);
      const double bound = rules.doubt * larger;
      if (agree || bound <= rules.small * part_of_change * wanted.accuracy) return bound;
    }
    last = change;
  }
  return {};
}

}  // namespace

std::optional<LesserAnswer> solve_with_rods(const Scene& start, const Reductions& reductions,
                                            double until, const Wanted& wanted) {
  if (!reductions.has(Reduction::rods) || wanted.of == AccuracyOf::energy ||
      start.starts_at_equilibrium || has_rods(start) || changes_phases(start))
    return {};
  const auto begin = clock_now();
  double fastest_of_springs = 0;  // [rad/s], known with the first gap
  for (const double stiffness : stiffness_gaps(start, least_ratio)) {
    const auto at_rest = started_on_rods(start, stiffness, reductions, wanted.of);
    if (!at_rest) continue;  // they hold energy, or are redundant
    const bool has_vibration = at_rest->is_moved;
    const Scene scene = with_rods(at_rest->start, stiffness, false);
    const auto model = std::make_shared<const Model>(scene, reductions);
    if (!is_constrained(model->system())) continue;
    if (fastest_of_springs == 0) {
      const Model springs(start, reductions);
      fastest_of_springs = frequency_bound(springs.system(), springs.initial().q);
    }
    if (fastest_of_springs < least_gain * frequency_bound(model->system(), model->initial().q))
      continue;
    Wanted of_run = wanted;
    of_run.accuracy = std::max(least_accuracy, part_of_run * wanted.accuracy);
    of_run.seconds = wanted.seconds - seconds_since(begin);
    Answer answer = solve(*model, until, of_run, &scene);
    if (!answer.is_reached) return {};
    const auto begin_of_check = clock_now();
    const auto left = [&] { return wanted.seconds - seconds_since(begin); };
    std::optional<double> change;
    try {
      change =
          change_by_rods(scene, with_rods(at_rest->start, stiffness, true), model, reductions,
                         until, wanted, answer, forces_of_step * 2 / fastest_of_springs, left());
      const double most = part_of_change * wanted.accuracy;
      if (!change || *change > most) continue;
      if (has_vibration) {
        Stage stage(*model, until, wanted.of, &scene, Rules{});
        const Trial run = stage.run(*answer.method, answer.value, {.seconds = left()});
        if (!run.reached_end()) return {};
        stage.measure_by(run);
        const Model springs(start, reductions);
        const double first = first_turns * 2 * std::numbers::pi / fastest_of_springs;
        const auto more = change_by_vibration({springs, *model, stage.scales(), until, first,
                                               part_with_springs * until, most - *change},
                                              left());
        if (!more) continue;
        *change += *more;
      }
    } catch (const Interrupted&) {
      return {};
    }
    answer.error_estimate += *change;
    answer.seconds.pilots += seconds_since(begin_of_check);
    const auto is_rod = [](const Spring& spring) { return spring.law.rigid; };
    const auto count = static_cast<std::size_t>(std::ranges::count_if(scene.springs, is_rod));
    return LesserAnswer{Reduction::rods, scene, model,        std::move(answer),
                        *change,         count, has_vibration};
  }
  return {};
}

}  // namespace qddot::inline measure
