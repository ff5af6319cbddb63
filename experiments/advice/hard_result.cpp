#include "experiments/advice/hard_result.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "experiments/advice/true_motion.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/advise.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::judged_advice {
namespace {

constexpr double longest_answer = 20, longest_repetition = 5;  // [s]
// A run that is off by more gives no scales.
constexpr double apart_enough = 0.01;

// A run of so much work beside a hard motion is lost in rounding.
constexpr std::int64_t most_forces = 1000000;

// A run of the method seen at the times of the true motion.
struct Seen {
  bool reached_end = false;
  std::vector<State> path{};
};
Seen run(const Method& method, double value, const ReducedScene& model, const TrueMotion& truth) {
  Seen seen;
  Options options = options_for(method, value, model);
  options.most_forces = most_forces;
  const auto integrator = make_integrator(method, model.system(), options);
  State state = model.initial();
  const Deadline deadline(longest_repetition);
  const Observer observer{truth.times, [&](const State& s) { seen.path.push_back(s); }};
  seen.reached_end =
      integrator->advance(state, truth.times.back(), observer, deadline.token()).outcome ==
      Outcome::reached_end;
  return seen;
}

// The relative error of the run; infinite if it did not reach the end.
double error_of(const Seen& seen, const ReducedScene& model, const TrueMotion& truth,
                const Scales& scales, AccuracyOf of) {
  if (!seen.reached_end) return std::numeric_limits<double>::infinity();
  double error = 0;
  const double energy = of == AccuracyOf::energy ? model.energy(model.initial()) : 0;
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
Scales scales_of(const ReducedScene& model, const Seen& fine, const TrueMotion& truth,
                 const Scene& scene) {
  Scales scales;
  if (fine.reached_end) {
    extend(scales, model, model.initial());
    for (const State& state : fine.path) extend(scales, model, state);
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
  double extent = 0;
  for (const Node& node : scene.nodes) extent = std::max(extent, node.position.norm());
  if (truth.conditioning > scales.displacement) scales.displacement = extent;
  return scales;
}

// The energy [J] that the true motion seems to gain or lose if its states are kept, and their
// energy computed, in double precision.
double energy_of_rounding(const HardCase& hard, const TrueMotion& truth) {
  const ReducedScene drawn = hard.as_drawn();
  const auto energy = [&](const std::vector<Node>& nodes) {
    State state = drawn.initial();
    Index at = 0;
    for (const Node& node : nodes) {
      if (node.pinned) continue;
      state.q.segment(at, drawn.dimension()) = node.position.head(drawn.dimension());
      state.v.segment(at, drawn.dimension()) = node.velocity.head(drawn.dimension());
      at += drawn.dimension();
    }
    return drawn.energy(state);
  };
  const double first = energy(truth.path.front());
  double largest = 0;
  for (const auto& nodes : truth.path) largest = std::max(largest, std::abs(energy(nodes) - first));
  return largest;
}

// The least scale of any part that moves.
double least_scale(const Scales& scales) {
  double least = scales.displacement;
  for (const PartScale& part : scales.parts) least = std::min(least, scales.displacement_of(part));
  return least > 0 ? least : 1;
}

const char* name(AccuracyOf of) {
  constexpr const char* names[] = {"positions", "path", "energy"};
  return names[static_cast<int>(of)];
}

}  // namespace

HardResult result_of(const HardCase& hard) {
  const ReducedScene model = hard.model();
  HardResult result{.number = static_cast<double>(hard.number),
                    .name = hard.scene.name,
                    .kind = hard.kind,
                    .of = name(hard.of),
                    .unknowns = static_cast<double>(model.system().size()),
                    .until = hard.until,
                    .accuracy = hard.accuracy};
  Answer answer;
  try {
    answer =
        solve(model, hard.until,
              {.accuracy = hard.accuracy, .of = hard.of, .seconds = longest_answer}, &hard.scene);
  } catch (const std::exception& error) {
    answer.why = error.what();
  }
  result.is_claimed = answer.is_reached;
  result.method = answer.method ? answer.method->name : "";
  result.kind_of_estimate = name(answer.error_estimate_kind);
  result.why = answer.why;
  result.value = answer.value;
  result.error_estimate = answer.error_estimate;
  result.seconds = answer.seconds.total();
  result.runs = answer.runs;

  const auto begin = clock_now();
  const TrueMotion truth = true_motion(hard);
  result.truth_seconds = seconds_since(begin);
  result.left_out = truth.unknown_because;
  if (!truth.is_known()) return result;
  const Method& finest = *find_method("dprkn12");
  Seen fine;
  if (!model.system().has_massless()) fine = run(finest, 1e-13, model, truth);
  const Scales scales = scales_of(model, fine, truth, hard.scene);
  result.fine_error = error_of(fine, model, truth, scales, hard.of);
  const double kinetic = scales.kinetic > 0 ? scales.kinetic : 1;
  result.conditioning =
      hard.of == AccuracyOf::energy
          ? (truth.energy_conditioning + energy_of_rounding(hard, truth)) / kinetic
      : hard.of == AccuracyOf::path ? truth.conditioning / least_scale(scales)
                                    : truth.conditioning_at_end / least_scale(scales);
  if (answer.method && answer.summary.outcome == Outcome::reached_end) {
    if (hard.of == AccuracyOf::positions) {
      result.error = position_error(answer.nodes, truth.path.back(), scales);
    } else if (model.system().size() > 0) {
      result.error =
          error_of(run(*answer.method, answer.value, model, truth), model, truth, scales, hard.of);
    }
  }
  try {
    const Advices advices = advise(model, hard.until, {hard.accuracy}, hard.of, &hard.scene);
    result.advice_seconds = advices.seconds;
    const auto& take = advices.for_each.front().take;
    if (!take) return result;
    result.advised = take->method->name;
    result.advised_value = take->value;
    if (model.system().size() > 0)
      result.advised_error =
          error_of(run(*take->method, take->value, model, truth), model, truth, scales, hard.of);
  } catch (const std::exception&) {  // no advice; an answer's exception is told
  }
  return result;
}

const Columns<HardResult>& hard_columns() {
  using R = HardResult;
  static const Columns<HardResult> columns = {
      {"case", &R::name},
      {"kind", &R::kind},
      {"of", &R::of},
      {"left_out", &R::left_out},
      {"is_claimed", [](const R& r) { return r.is_claimed ? 1 : 0; }},
      {"is_well_posed", [](const R& r) { return r.is_well_posed() ? 1 : 0; }},
      {"method", &R::method},
      {"error_estimate_kind", &R::kind_of_estimate},
      {"why", &R::why},
      {"advised", &R::advised},
      {"unknowns", &R::unknowns},
      {"until", &R::until},
      {"accuracy", &R::accuracy},
      {"value", &R::value},
      {"error_estimate", &R::error_estimate},
      {"error", &R::error},
      {"conditioning", &R::conditioning},
      {"fine_error", &R::fine_error},
      {"runs", &R::runs},
      {"seconds", &R::seconds},
      {"truth_seconds", &R::truth_seconds},
      {"advised_value", &R::advised_value},
      {"advised_error", &R::advised_error},
      {"advice_seconds", &R::advice_seconds}};
  return columns;
}

}  // namespace qddot::judged_advice
