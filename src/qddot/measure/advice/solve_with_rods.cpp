#include "qddot/measure/advice/solve_with_rods.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "qddot/algebra/constraint_forces.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/rods.hpp"

namespace qddot::inline measure {
namespace {

// A step of RATTLE takes as long as about four forces, and runs are made to bound what rods change.
// Only steps that are so many times longer are worth it.
constexpr double least_gain = 10;
// Springs are stiff beside others if they are so many times stiffer.
constexpr double least_ratio = 30;
// The parts of the accuracy for the run with rods, and for what they change.
constexpr double part_of_run = 0.5, part_of_change = 0.5;
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
  std::vector<std::size_t> steps(scene.nodes.size());
  std::vector<bool> is_seen(scene.nodes.size(), false);
  const auto farthest = [&](std::size_t from) {
    std::fill(steps.begin(), steps.end(), scene.nodes.size());
    steps[from] = 0;
    std::queue<std::size_t> open({from});
    std::size_t last = from;
    while (!open.empty()) {
      last = open.front();
      open.pop();
      is_seen[last] = true;
      for (const std::size_t node : next[last]) {
        if (steps[node] < scene.nodes.size()) continue;
        steps[node] = steps[last] + 1;
        open.push(node);
      }
    }
    return last;
  };
  std::size_t longest = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (is_seen[i] || next[i].empty()) continue;
    farthest(farthest(i));
    for (const std::size_t count : steps) {
      if (count < scene.nodes.size()) longest = std::max(longest, count);
    }
  }
  return longest;
}

// The largest stretch tau/k [m] of a spring that a rod stands for, on the way of a run.
double largest_stretch(const Model& model, const Scene& compliant, const std::vector<State>& path) {
  ConstraintForces forces(model.system());
  double largest = 0;
  const auto see = [&](const State& state) {
    const Vec& tensions = forces.at(state);
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

// A bound of the change that rods make, relative to the motion; nothing if it is not known.
std::optional<double> change_by_rods(const Scene& rigid_scene, const Scene& compliant_scene,
                                     const std::shared_ptr<const Model>& rigid,
                                     const Reductions& reductions, double until,
                                     const Wanted& wanted, const Answer& answer) {
  constexpr Rules rules;
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
  const Trial accurate = rods_alone.run(*answer.method, answer.value, {});
  if (!accurate.reached_end()) return {};
  const double stretch_of_answer = largest_stretch(*rigid, compliant_scene, accurate.path);
  std::optional<double> last;  // at twice the step
  for (double h = first; h > until / 1e6; h /= 2) {
    const Trial run = rods_alone.run(method, h, {});
    if (!run.reached_end()) continue;
    rods_alone.measure_by(run);
    Trial end = run;
    end.path = {run.path.back()};
    if (rods_alone.distance(end, truth) > resolved) continue;
    const Trial stretched = with_stretch.run(method, h, {});
    if (!stretched.reached_end()) continue;
    const double stretch =
        std::max(stretch_of_answer, largest_stretch(*rigid, compliant_scene, run.path));
    double least = rods_alone.scales().displacement;
    for (const PartScale& part : rods_alone.scales().parts) {
      least = std::min(least, rods_alone.scales().displacement_of(part));
    }
    const double vibration = static_cast<double>(longest_row(rigid_scene)) * stretch / least;
    const double change = rods_alone.distance(run, stretched) + vibration;
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

std::string RodsAnswer::in_words() const {
  return fmt::format(
      "left out: {} stiff springs are rods here; that changes positions by at most {:.1e} of the "
      "motion, as a run in which they stretch says",
      rods, change);
}

std::optional<RodsAnswer> solve_with_rods(const Scene& start, const Reductions& reductions,
                                          double until, const Wanted& wanted) {
  if (!reductions.has(Reduction::rods) || wanted.of == AccuracyOf::energy ||
      start.starts_at_equilibrium || has_rods(start) || changes_phases(start))
    return {};
  for (const double stiffness : stiffness_gaps(start, least_ratio)) {
    const Scene scene = with_rods(start, stiffness, false);
    try {
      validate_rods(scene, scene.name);
    } catch (const InvalidInput&) {
      continue;  // they hold energy, or are redundant
    }
    const auto model = std::make_shared<const Model>(scene, reductions);
    if (!is_constrained(model->system())) continue;
    const Model springs(start, reductions);
    if (frequency_bound(springs.system(), springs.initial().q) <
        least_gain * frequency_bound(model->system(), model->initial().q))
      continue;
    Wanted of_run = wanted;
    of_run.accuracy = std::max(least_accuracy, part_of_run * wanted.accuracy);
    Answer answer = solve(*model, until, of_run, &scene);
    if (!answer.is_reached) return {};
    const auto change = change_by_rods(scene, with_rods(start, stiffness, true), model, reductions,
                                       until, wanted, answer);
    if (!change || *change > part_of_change * wanted.accuracy) continue;
    answer.error_estimate += *change;
    const auto is_rod = [](const Spring& spring) { return spring.law.rigid; };
    const auto count = static_cast<std::size_t>(std::ranges::count_if(scene.springs, is_rod));
    return RodsAnswer{scene, model, std::move(answer), count, *change};
  }
  return {};
}

}  // namespace qddot::inline measure
