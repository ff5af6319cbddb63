#include "experiments/advice/judged_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/rules.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/rest.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::judged_advice {
namespace {

constexpr double longest_repetition = 5;  // [s]
// A run that is off by more gives no scales.
constexpr double apart_enough = 0.01;

// A run of so much work beside a hard motion is lost in rounding.
constexpr std::int64_t most_forces = 1000000;

// A run of the method seen at some times.
struct Seen {
  bool reached_end = false;
  std::vector<State> path{};
};
Seen run(const Method& method, double value, const Model& model, const std::vector<double>& times) {
  Seen seen;
  Options options = options_for(method, value, model);
  options.most_forces = most_forces;
  const auto integrator = make_integrator(method, model.system(), options);
  State state = model.initial();
  const Deadline deadline(longest_repetition);
  const Observer observer{times, [&](const State& s) { seen.path.push_back(s); }};
  seen.reached_end = integrator->advance(state, times.back(), observer, deadline.token()).outcome ==
                     Outcome::reached_end;
  return seen;
}

Seen fine_run(const Model& model, const std::vector<double>& times) {
  return run(*find_method("dprkn12"), 1e-13, model, times);
}

// The relative error of the run, whose energy [J] should be this one; infinite if it did not reach
// the end.
double error_of(const Seen& seen, const Model& model, const TrueMotion& truth, const Scales& scales,
                AccuracyOf of, double energy = 0) {
  if (!seen.reached_end) return std::numeric_limits<double>::infinity();
  double error = 0;
  for (std::size_t i = of == AccuracyOf::positions ? seen.path.size() - 1 : 0; i < seen.path.size();
       ++i) {
    const double here = of == AccuracyOf::energy
                            ? std::abs(model.energy(seen.path[i]) - energy) /
                                  (scales.kinetic > 0 ? scales.kinetic : 1)
                            : position_error(model.expand(seen.path[i]), truth.path[i], scales);
    if (!(here <= error)) error = here;
  }
  return error;
}

// The scales of the motion: as the model measures them on a fine run, unless this one is wrong, or
// of all nodes together.
Scales scales_of(const Model& model, const Seen& fine, const TrueMotion& truth,
                 const Scene& scene) {
  Scales scales;
  if (fine.reached_end) {
    extend(scales, model, model.initial());
    for (const State& state : fine.path) extend(scales, model, state);
    // As an answer has it, errors of what rests are relative to its size.
    if (!scene.springs.empty()) reach_to_pins(scales, scene);
    take_extents_at_rest(scales, Rules{}.rest);
    if (error_of(fine, model, truth, scales, AccuracyOf::path) < apart_enough) return scales;
    scales = {};
  }
  for (const auto& nodes : truth.path) {
    double kinetic = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].pinned) continue;
      scales.displacement =
          std::max(scales.displacement, (nodes[i].position - scene.nodes[i].position).norm());
      scales.speed = std::max(scales.speed, nodes[i].velocity.norm());
      kinetic += 0.5 * nodes[i].mass * nodes[i].velocity.squaredNorm();
    }
    scales.kinetic = std::max(scales.kinetic, kinetic);
  }
  // Rounding may be all that moves. Errors are then relative to the size, as in an answer.
  constexpr double part = 0.1;
  double extent = 0;
  for (const Node& node : scene.nodes) extent = std::max(extent, node.position.norm());
  if (truth.conditioning > part * scales.displacement) scales.displacement = extent;
  return scales;
}

// The energy [J] of these states of all nodes, computed in double precision.
double energy_of(const Model& drawn, const std::vector<Node>& nodes) {
  State state = drawn.initial();
  Index at = 0;
  for (const Node& node : nodes) {
    if (node.pinned) continue;
    state.q.segment(at, drawn.dimension()) = node.position.head(drawn.dimension());
    state.v.segment(at, drawn.dimension()) = node.velocity.head(drawn.dimension());
    at += drawn.dimension();
  }
  return drawn.energy(state);
}

// The energy that the true motion seems to gain or lose if its states are kept in double precision.
double energy_of_rounding(const Model& drawn, const TrueMotion& truth) {
  const double first = energy_of(drawn, truth.path.front());
  double largest = 0;
  for (const auto& nodes : truth.path)
    largest = std::max(largest, std::abs(energy_of(drawn, nodes) - first));
  return largest;
}

// The least scale of any part that moves.
double least_scale(const Scales& scales) {
  double least = scales.displacement;
  for (const PartScale& part : scales.parts) least = std::min(least, scales.displacement_of(part));
  return least > 0 ? least : 1;
}

}  // namespace

JudgedMotion::JudgedMotion(const HardCase& hard)
    : hard_(hard), model_(hard.model()), truth_(true_motion(hard)) {
  if (!truth_.is_known()) return;
  Seen fine;
  if (!model_.system().has_massless()) fine = fine_run(model_, truth_.times);
  scales_ = scales_of(model_, fine, truth_, hard.scene);
  const Model drawn = hard.as_drawn();
  // Massless nodes may start out of balance and lose energy at once.
  energy_ = model_.system().has_massless() ? energy_of(drawn, truth_.path.front())
                                           : model_.energy(model_.initial());
  fine_error_ = judged_advice::error_of(fine, model_, truth_, scales_, hard.of, energy_);
  switch (hard.of) {
    case AccuracyOf::positions:
      conditioning_ = truth_.conditioning_at_end / least_scale(scales_);
      break;
    case AccuracyOf::path:
      conditioning_ = truth_.conditioning / least_scale(scales_);
      break;
    case AccuracyOf::energy:
      conditioning_ = (truth_.energy_conditioning + energy_of_rounding(drawn, truth_)) /
                      (scales_.kinetic > 0 ? scales_.kinetic : 1);
  }
}

std::vector<State> JudgedMotion::fine_path(const std::vector<double>& times) const {
  return fine_run(model_, times).path;
}

double JudgedMotion::error_of(const Method& method, double value) const {
  if (model_.system().size() == 0) return 0;
  return judged_advice::error_of(run(method, value, model_, truth_.times), model_, truth_, scales_,
                                 hard_.of, energy_);
}

}  // namespace qddot::judged_advice
