#include "qddot/measure/advice/solve_linear.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/neglected_forces.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/runs.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/model/capabilities.hpp"
#include "qddot/model/linearized_system.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/scene/rods.hpp"

namespace qddot::inline measure {
namespace {

// Modes and what couples them are found if that takes so many times the work of Verlet's method at
// most, and if that is no less than some tenth of a millisecond. A search for a run takes tens of
// times that work.
constexpr double times_verlet = 8, least_work = 5e4;
// Disturbances may grow by e to this power. It is looked at first where the motion starts.
constexpr double largest_growth = 1, clearly_larger = 3;
// Displacements at which the growth is looked at.
constexpr std::size_t places = 8;
// The most nodes: the modes of more take longer than most motions, and so would a look at them.
constexpr std::size_t most_nodes = 1000;

bool may_be_linear(const System& system) {
  return system.size() > 0 && can_be_linearized(system) && !system.stiffness_is_constant() &&
         !system.has_massless() && !system.kinks() && !system.validity();
}

// The work of an eigenproblem, which takes as long as the force on n^3 unknowns, and of the
// products of n^2 pairs of modes with n others, eight operations in that time.
double work_of_modes(const Model& model) {
  double work = 0;
  for (const Index unknowns : model.unknowns_by_part()) {
    const auto n = static_cast<double>(unknowns);
    work += n * n * n * (1 + n / 8);
  }
  return work;
}

// The shortest length of a spring [m], at rest or drawn; infinite without one.
double shortest_length(const Scene& scene) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Spring& spring : scene.springs) {
    const double drawn =
        (scene.nodes[spring.nodes[1]].position - scene.nodes[spring.nodes[0]].position).norm();
    for (const double length : {drawn, spring.law.rest_length}) {
      if (length > 0) shortest = std::min(shortest, length);
    }
  }
  return shortest;
}

// The equilibrium to which Newton's steps lead from q at once, where -K is positive definite;
// nothing if they do not, within a few `length`.
std::optional<Vec> nearby_equilibrium(const System& system, const Vec& q, double length) {
  constexpr int most_steps = 8;
  constexpr double slower = 0.3;
  EffectiveMass solver(system);
  SymmetricMatrix k = system.stiffness_pattern();
  Vec place = q, f(q.size()), step(q.size());
  const double rounding = machine_epsilon * std::max(length, q.lpNorm<Eigen::Infinity>());
  double last = length;
  for (int i = 0; i < most_steps; ++i) {
    system.force(place, f);
    system.stiffness(place, k);
    if (!solver.factorize_positive(0, 1, k)) return {};
    solver.solve(f, step);
    const double size = step.lpNorm<Eigen::Infinity>();
    if (!(size <= last)) return size <= 100 * rounding ? std::optional(place) : std::nullopt;
    place += step;
    if (size <= rounding) return place;
    last = slower * size;
  }
  return {};
}

// How far the start is from `middle`, and how far its velocities lead by themselves, by Rayleigh's
// quotient.
std::vector<Vec> first_displacements(const System& system, const Vec& middle, const State& start) {
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(middle, k);
  const double kinetic = start.v.dot(system.mass().cwiseProduct(start.v)),
               elastic = -start.v.dot(Vec(k.selfadjointView<Eigen::Lower>() * start.v));
  std::vector<Vec> all = {start.q - middle};
  if (kinetic > 0 && elastic > 0) all.emplace_back(std::sqrt(kinetic / elastic) * start.v);
  return all;
}

// The motion of a scene about an equilibrium, in the model's unknowns and in all directions.
class LinearMotionOf {
 public:
  LinearMotionOf(const Scene& start, const Reductions& reductions, const Model& own)
      : own_(own),
        all_(start, reductions.without(Reduction::dimension).without(Reduction::mirror)),
        length_(shortest_length(start)) {}

  // False if there is none nearby, or no length to compare displacements with.
  bool find_middle() {
    if (!std::isfinite(length_)) return false;
    const auto found = nearby_equilibrium(own_.system(), own_.initial().q, length_);
    if (found) middle_ = *found;
    return found.has_value();
  }
  const Vec& middle() const { return middle_; }

  // The rate at which a disturbance grows, at the first displacements or along a run.
  double first_feedback() const {
    return feedback(first_displacements(own_.system(), middle_, own_.initial()));
  }
  double feedback_along(const std::vector<State>& path) const {
    std::vector<Vec> all;
    const std::size_t every = std::max<std::size_t>(1, path.size() / places);
    for (std::size_t i = 0; i < path.size(); i += every) all.emplace_back(path[i].q - middle_);
    return feedback(all);
  }

  // A bound of what is left out, in each unknown [m].
  Vec neglected(const std::vector<State>& path, double until, double feedback,
                double tolerance) const {
    constexpr std::size_t most = 64;
    const auto blocks = own_.system().blocks();
    const State& start = own_.initial();
    const std::size_t every = std::max<std::size_t>(1, path.size() / most);
    Vec bound(middle_.size());
    Index first = 0;
    const auto add = [&](const System& block) {
      const Index n = block.size();
      const Vec middle = middle_.segment(first, n);
      const State own{0, start.q.segment(first, n), start.v.segment(first, n)};
      std::vector<Vec> seen;
      for (std::size_t i = 0; i < path.size(); i += every)
        seen.emplace_back(path[i].q.segment(first, n) - middle);
      bound.segment(first, n) =
          neglected_displacement({block, middle, own, seen, until, length_}, feedback, tolerance);
      first += n;
    };
    for (const auto& block : blocks) add(*block);
    if (blocks.empty()) add(own_.system());
    return bound;
  }

 private:
  double feedback(const std::vector<Vec>& displacements) const {
    // Places are an affine function of the unknowns, and velocities its linear part.
    const auto in_all = [&](const Vec& u) { return all_.collect(own_.expand({0, middle_, u}), 0); };
    const Vec middle = in_all(Vec::Zero(middle_.size())).q;
    std::vector<Vec> all;
    for (const Vec& u : displacements) all.push_back(in_all(u).v);
    return feedback_rate(all_.system(), middle, all, length_);
  }

  const Model& own_;
  Model all_;
  double length_;
  Vec middle_{};
};

}  // namespace

std::optional<LesserAnswer> solve_linear(const Scene& start, const Reductions& reductions,
                                         double until, const Wanted& wanted) {
  if (!reductions.has(Reduction::linear) || wanted.of == AccuracyOf::energy ||
      start.starts_at_equilibrium || start.nodes.size() > most_nodes || has_rods(start) ||
      changes_phases(start))
    return {};
  constexpr Rules rules;
  const auto begin = clock_now();
  const Model own(start, reductions);
  if (!may_be_linear(own.system())) return {};
  const Runs runs(own, until, wanted.of, wanted.seconds, &start, rules);
  const double work = runs.steps_of_verlet() * runs.work_of_force();
  if (work < least_work || work_of_modes(own) > times_verlet * work) return {};
  const auto seconds_left = [&] { return wanted.seconds - seconds_since(begin); };
  if (seconds_left() <= 0) return {};

  LinearMotionOf motion(start, reductions, own);
  if (!motion.find_middle()) return {};
  const auto growth = [&](double feedback) { return until * feedback / 2; };
  if (!(growth(motion.first_feedback()) < clearly_larger * largest_growth)) return {};

  const auto linear = std::make_shared<const Model>(
      Model(start, reductions).with_system(linearized(own.system(), motion.middle())));
  const auto exact = std::ranges::find_if(methods(), [&](const Method& method) {
    return method.order == 0 && applies_to(method, linear->system());
  });
  if (exact == methods().end()) return {};
  Stage stage(*linear, until, wanted.of, &start, rules);
  try {
    const Trial trial = stage.run(*exact, until, {.seconds = seconds_left()});
    if (!trial.reached_end()) return {};
    stage.measure_by(trial);
    const double feedback = motion.feedback_along(trial.path);
    if (!(growth(feedback) <= largest_growth)) return {};
    const double least = stage.least_scale();
    if (!(least > 0) || stage.rests()) return {};
    const double tolerance = part_of_change * wanted.accuracy;
    const Vec neglected = motion.neglected(trial.path, until, feedback, tolerance * least);
    const double change = stage.relative(neglected);
    const double rounding = stage.rounding_of_modes(runs.bound_of_w());
    if (!(change <= tolerance) || change + rounding > wanted.accuracy) return {};
    Answer answer{.is_reached = true,
                  .method = trial.method,
                  .value = trial.value,
                  .error_estimate = change + rounding,
                  .error_estimate_kind = EstimateKind::neglected,
                  .summary = trial.summary,
                  .end = trial.path.back(),
                  .nodes = linear->expand(trial.path.back()),
                  .runs = 1};
    answer.seconds.run = trial.seconds;
    answer.seconds.pilots = seconds_since(begin) - trial.seconds;
    return LesserAnswer{Reduction::linear, start, linear, std::move(answer), change};
  } catch (const Interrupted&) {
    return {};
  }
}

}  // namespace qddot::inline measure
