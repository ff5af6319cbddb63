#include "experiments/advice/hard_result.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "experiments/advice/draws.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/advise.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "tests/independent/plain_motion.hpp"

namespace qddot::judged_advice {
namespace {

constexpr int looks = 300;             // at random times on the way
constexpr double longest_truth = 2;    // [s] of one true motion
constexpr double longest_of_all = 20;  // [s] of any other run
constexpr double rounding = 0x1p-52;

// Positions and velocities of all nodes at the times, the end last.
using Path = std::vector<std::vector<Node>>;

struct Truth {
  std::vector<double> times{};
  Path path{};
  double conditioning = 0;         // of positions, largest on the way or at the end [m]
  double conditioning_at_end = 0;  // [m]
  double energy_conditioning = 0;  // [J]
};

template <class Motion>
bool follow(Motion& motion, const std::vector<double>& times, Path& path) {
  const auto begin = clock_now();
  constexpr int most_steps = 2000;
  const Scene& scene = motion.model().scene();
  for (const double t : times) {
    if (seconds_since(begin) > longest_truth || !motion.advance(t, most_steps)) return false;
    std::vector<Node> nodes = scene.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto axis = static_cast<Index>(c);
        nodes[i].position[axis] = static_cast<double>(motion.state().x[3 * i + c]);
        nodes[i].velocity[axis] = static_cast<double>(motion.state().v[3 * i + c]);
      }
    }
    path.push_back(std::move(nodes));
  }
  return true;
}

// The true motion, and another one from a start one rounding away in all drawn directions, whose
// tolerance is ten times as large.
template <class Model>
bool find_truth(const Model& model, std::uint64_t seed, double until, Truth& truth) {
  Draws draw(seed);
  for (int i = 0; i < looks; ++i) truth.times.push_back(until * draw.between(1e-6, 1));
  truth.times.push_back(until);
  std::ranges::sort(truth.times);
  constexpr long double tolerance = 1e-17L;
  PlainMotion<long double, Model> motion(model, tolerance), twin(model, 10 * tolerance);
  const Scene& scene = model.scene();
  double extent = 0, speed = 0;
  for (const Node& node : scene.nodes) {
    extent = std::max(extent, node.position.cwiseAbs().maxCoeff());
    if (!node.pinned) speed = std::max(speed, node.velocity.norm());
  }
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].pinned || scene.nodes[i].mass == 0) continue;
    for (int c = 0; c < scene.dimension; ++c) {
      const double sign = draw.happens(0.5) ? rounding : -rounding;
      twin.displace(3 * i + static_cast<std::size_t>(c), sign * extent,
                    (draw.happens(0.5) ? rounding : -rounding) * speed);
    }
  }
  const auto& state = motion.state();
  const double energy = static_cast<double>(model.energy(state.x, state.v));
  truth.energy_conditioning =
      std::abs(static_cast<double>(model.energy(twin.state().x, twin.state().v) -
                                   model.energy(state.x, state.v))) +
      rounding * std::abs(energy);
  Path beside;
  if (!follow(motion, truth.times, truth.path) || !follow(twin, truth.times, beside)) return false;
  for (std::size_t t = 0; t < beside.size(); ++t) {
    double gap = 0;
    for (std::size_t i = 0; i < beside[t].size(); ++i)
      gap = std::max(gap, (beside[t][i].position - truth.path[t][i].position).norm());
    truth.conditioning = std::max(truth.conditioning, gap);
    truth.conditioning_at_end = gap;
  }
  return true;
}

// A run of so much work beside a hard motion is lost in rounding.
constexpr std::int64_t most_forces = 1000000;

// A run of the method seen at the times of the true motion.
struct Seen {
  bool reached_end = false;
  std::vector<State> path{};
};
Seen run(const Method& method, double value, const ReducedScene& model, const Truth& truth) {
  Seen seen;
  Options options = options_for(method, value, model);
  options.most_forces = most_forces;
  const auto integrator = make_integrator(method, model.system(), options);
  State state = model.initial();
  const Deadline deadline(longest_of_all);
  const Observer observer{truth.times, [&](const State& s) { seen.path.push_back(s); }};
  seen.reached_end =
      integrator->advance(state, truth.times.back(), observer, deadline.token()).outcome ==
      Outcome::reached_end;
  return seen;
}

// The scales of the motion: as the model measures them on a fine run, or of all nodes together.
Scales scales_of(const ReducedScene& model, const Seen& fine, const Truth& truth,
                 const Scene& scene) {
  Scales scales;
  if (fine.reached_end) {
    extend(scales, model, model.initial());
    for (const State& state : fine.path) extend(scales, model, state);
    return scales;
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
  return scales;
}

double error_of(const Seen& seen, const ReducedScene& model, const Truth& truth,
                const Scales& scales, AccuracyOf of) {
  if (!seen.reached_end) return std::numeric_limits<double>::infinity();
  double error = 0;
  const double energy = model.energy(model.initial());
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
  const Answer answer = solve(
      model, hard.until, {.accuracy = hard.accuracy, .of = hard.of, .seconds = longest_of_all});
  result.is_claimed = answer.is_reached;
  result.method = answer.method ? answer.method->name : "";
  result.kind_of_estimate = name(answer.error_estimate_kind);
  result.why = answer.why;
  result.value = answer.value;
  result.error_estimate = answer.error_estimate;
  result.seconds = answer.seconds.total();
  result.runs = answer.runs;

  const auto begin = clock_now();
  Truth truth;
  const bool is_known =
      hard.pairs.empty()
          ? find_truth(PlainModel<long double>(hard.scene), hard.number, hard.until, truth)
          : find_truth(PlainPairs<long double>(hard.scene, hard.pairs), hard.number, hard.until,
                       truth);
  result.truth_seconds = seconds_since(begin);
  if (!is_known) {
    result.left_out = "no true motion was found";
    return result;
  }
  const Method& finest = *find_method("dprkn12");
  Seen fine;
  if (!model.system().has_massless()) fine = run(finest, 1e-13, model, truth);
  const Scales scales = scales_of(model, fine, truth, hard.scene);
  result.fine_error = error_of(fine, model, truth, scales, hard.of);
  const double kinetic = scales.kinetic > 0 ? scales.kinetic : 1;
  result.conditioning = hard.of == AccuracyOf::energy ? truth.energy_conditioning / kinetic
                        : hard.of == AccuracyOf::path
                            ? truth.conditioning / least_scale(scales)
                            : truth.conditioning_at_end / least_scale(scales);
  if (answer.method && hard.of == AccuracyOf::positions && answer.is_reached) {
    result.error = position_error(answer.nodes, truth.path.back(), scales);
  } else if (answer.method && answer.is_reached) {
    const Seen again = model.system().size() == 0
                           ? Seen{true, std::vector<State>(truth.times.size(), answer.end)}
                           : run(*answer.method, answer.value, model, truth);
    result.error = error_of(again, model, truth, scales, hard.of);
  }
  const Advices advices = advise(model, hard.until, {hard.accuracy}, hard.of);
  result.advice_seconds = advices.seconds;
  if (const auto& take = advices.for_each.front().take) {
    result.advised = take->method->name;
    result.advised_value = take->value;
    if (model.system().size() > 0)
      result.advised_error =
          error_of(run(*take->method, take->value, model, truth), model, truth, scales, hard.of);
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

namespace {

// The figures of the results that `which` names.
void add_figures(std::vector<Figure>& figures, const std::string& which,
                 const std::vector<const HardResult*>& results) {
  using Holds = std::function<bool(const HardResult&)>;
  const auto share = [&](const char* name, const char* meaning, const Holds& counts,
                         const Holds& holds) {
    int all = 0, held = 0;
    for (const HardResult* result : results) {
      if (!counts(*result)) continue;
      ++all;
      held += holds(*result) ? 1 : 0;
    }
    figures.push_back(
        {name, meaning,
         all > 0 ? static_cast<double>(held) / all : std::numeric_limits<double>::quiet_NaN(), all,
         which});
  };
  using R = HardResult;
  share("within_accuracy", "answers with an error of at most the accuracy", &R::is_judged,
        [](const R& r) { return r.is_within(r.accuracy); });
  share("within_bar", "answers with an error of at most the error bar", &R::is_judged,
        [](const R& r) { return r.is_within(r.error_estimate); });
  share("refused", "well-posed cases without an answer", &R::is_well_posed,
        [](const R& r) { return !r.is_claimed; });
  share("claimed_beyond_rounding",
        "cases that rounding makes impossible three times over, and an answer",
        &R::is_beyond_rounding, [](const R& r) { return r.is_claimed; });
  share(
      "advised_within_accuracy", "advised runs with an error of at most the accuracy",
      [](const R& r) { return r.is_well_posed() && !r.advised.empty(); },
      [](const R& r) { return r.advised_error - r.conditioning <= r.accuracy; });
  std::vector<double> widths, seconds;
  for (const HardResult* result : results) {
    seconds.push_back(result->seconds);
    if (result->is_judged() && result->error > 10 * result->conditioning)
      widths.push_back(result->error_estimate / result->error);
  }
  const auto spread = [&](const char* name, const char* meaning,
                          const std::vector<double>& values) {
    for (const double part : {0.5, 0.9}) {
      figures.push_back({fmt::format("{}_{:g}", name, 100 * part), meaning, quantile(values, part),
                         static_cast<int>(values.size()), which});
    }
  };
  spread("bar_over_error", "error bar over error, of that percentage at most", widths);
  spread("seconds", "time of an answer [s], of that percentage at most", seconds);
}

}  // namespace

std::vector<Figure> worth_of(const std::vector<HardResult>& results) {
  std::vector<Figure> figures;
  std::vector<std::string> kinds;
  const auto add = [&](const std::string& which, const std::function<bool(const HardResult&)>& is) {
    std::vector<const HardResult*> few;
    for (const HardResult& result : results) {
      if (is(result)) few.push_back(&result);
    }
    if (!few.empty()) add_figures(figures, which, few);
  };
  add("all", [](const HardResult&) { return true; });
  for (const char* of : {"positions", "path", "energy"})
    add(of, [&](const HardResult& r) { return r.of == of; });
  for (const HardResult& result : results) {
    if (std::ranges::find(kinds, result.kind) == kinds.end()) kinds.push_back(result.kind);
  }
  for (const std::string& kind : kinds)
    add(kind, [&](const HardResult& r) { return r.kind == kind; });
  return figures;
}

std::string in_columns(const std::vector<Figure>& figures) {
  std::string heads = fmt::format("{:<16}", ""), lines, of;
  for (const Figure& figure : figures) {
    if (figure.of == figures.front().of) heads += fmt::format(" {:>12.12}", figure.name);
    if (figure.of != of) lines += fmt::format("\n{:<16}", figure.of);
    of = figure.of;
    lines += fmt::format(" {:>7.3g}{:<5}", figure.value, fmt::format("/{}", figure.cases));
  }
  return heads + lines + "\n";
}

std::vector<std::string> lines_of(const std::vector<HardResult>& results, bool of_all) {
  std::vector<std::string> lines;
  for (const HardResult& r : results) {
    const char* what = !r.has_truth()                                    ? ""
                       : r.is_judged() && !r.is_within(r.accuracy)       ? "FALSE"
                       : r.is_judged() && !r.is_within(r.error_estimate) ? "bar"
                       : r.is_well_posed() && !r.is_claimed              ? "refused"
                       : r.is_beyond_rounding() && r.is_claimed          ? "beyond"
                                                                         : "";
    if (!*what && !of_all) continue;
    lines.push_back(
        fmt::format("{:<8.0f} {:<15} {:<9} {:<8} A {:.1e}  bar {:.1e}  error {:.1e}  rounding "
                    "{:.1e}  {} {:.4g}{}{}",
                    r.number, r.kind, r.of, what, r.accuracy, r.error_estimate, r.error,
                    r.conditioning, r.method, r.value, r.why.empty() ? "" : "  ", r.why));
  }
  return lines;
}

}  // namespace qddot::judged_advice
