#include "qddot/scene/explain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/damped_step.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/natural_modes.hpp"

namespace qddot {
namespace {

void find_fastest(Explanation& explanation, const Model& all) {
  try {
    const State& start = all.initial();
    const NaturalModes lowest = lowest_modes(all.system(), start.q, 1);
    if (lowest.squares.size() == 0 || lowest.squares[0] >= 0) return;
    explanation.growth = std::sqrt(-lowest.squares[0]);
    // A displacement is expanded as a velocity.
    const auto nodes = all.expand({0, start.q, lowest.shapes.col(0)});
    const auto amplitude = [](const Node& node) { return node.velocity.norm(); };
    explanation.fastest =
        static_cast<std::size_t>(std::ranges::max_element(nodes, {}, amplitude) - nodes.begin());
  } catch (const std::exception&) {
    // The equilibrium stays unknown, for loose massless nodes or an iteration that does not
    // converge.
  }
}

// Sets the damping ratios of the lowest and the highest mode. Modes below this part of the highest
// frequency count as motions that nothing resists.
void find_damping(Explanation& e, const System& system, const Vec& q) {
  constexpr double least_part = 1e-6;
  constexpr Index most_flat = 12;
  e.zeta_lowest = e.zeta_highest = std::numeric_limits<double>::quiet_NaN();
  const auto ratio = [&](const NaturalModes& modes, Index mode) {
    return damping_ratio(system, q, modes.shapes.col(mode), std::sqrt(modes.squares[mode]));
  };
  try {
    const NaturalModes highest = highest_modes(system, q, 1);
    if (highest.squares.size() == 0 || !(highest.squares[0] > 0)) return;
    e.zeta_highest = ratio(highest, 0);
    constexpr double lag_of_verlet = 2;
    e.verlet_step = damped_step_limit(system, q, lag_of_verlet);
    const NaturalModes lowest = lowest_modes(system, q, most_flat);
    for (Index mode = 0; mode < lowest.squares.size(); ++mode) {
      if (!(lowest.squares[mode] > least_part * least_part * highest.squares[0])) continue;
      e.zeta_lowest = ratio(lowest, mode);
      return;
    }
  } catch (const std::exception&) {
    // They stay unknown, as for loose massless nodes.
  }
}

std::string damping_sentence(const Explanation& e) {
  if (std::isnan(e.zeta_highest)) return "its damping ratios at the start are not known";
  std::string sentence =
      fmt::format("damping ratio {:.3g} of the highest mode at the start", e.zeta_highest);
  if (!std::isnan(e.zeta_lowest))
    sentence += fmt::format(", {:.3g} of the lowest that springs resist", e.zeta_lowest);
  if (e.verlet_step > 0) {
    sentence += fmt::format("; verlet, whose friction is late, is stable up to h = {:.4g} s",
                            e.verlet_step);
  }
  return sentence;
}

double lanczos(const System& system, const Vec& q) {
  try {
    return largest_frequency(system, q);
  } catch (const std::runtime_error&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

std::string step_sentence(const Explanation& e) {
  if (e.unknowns == 0) return "nothing is left to integrate";
  if (std::isinf(e.omega_bound)) {
    return "w_max is infinite, since a massless node is left: no explicit method";
  }
  const double w = std::isnan(e.omega_max) ? e.omega_bound : e.omega_max;
  if (w == 0) return "w_max = 0: nothing vibrates";
  return fmt::format(
      "w_max = {:.5g} rad/s at the start (at most {:.5g}): explicit methods are stable up to "
      "h = 2/w_max = {:.4g} s",
      w, e.omega_bound, 2 / w);
}

std::string flat_growth(const Explanation& e) {
  return std::isfinite(e.flat_rate)
             ? fmt::format(" (growth slower than exp({:.1g} t))", e.flat_rate)
             : "";
}

std::string stability_sentence(const Explanation& e, const Scene& scene) {
  if (!e.is_examined)
    return "whether K is indefinite at the start is not known: the scene, or its numbers, are too "
           "large";
  if (e.unstable == 0 && e.flat == 0) {
    return "K is negative definite at the start: no direction grows";
  }
  if (e.unstable == 0) {
    return fmt::format(
        "K is negative semidefinite at the start: no direction grows; in {} direction{} nothing "
        "resists at first, or too little to tell{}: a spring at its rest length resists along "
        "itself alone",
        e.flat, e.flat == 1 ? "" : "s", flat_growth(e));
  }
  std::string sentence =
      fmt::format("K is indefinite at the start, in {} direction{} (springs are compressed)",
                  e.unstable, e.unstable == 1 ? "" : "s");
  if (e.growth > 0) {
    const auto& x = scene.nodes[e.fastest].position;
    sentence += fmt::format("; the fastest grows as exp({:.4g} t), most at node {} ({})", e.growth,
                            e.fastest, fmt::join(x.data(), x.data() + scene.dimension, ", "));
  }
  if (e.flat > 0) {
    sentence += fmt::format("; in {} more nothing resists at first, or too little to tell{}",
                            e.flat, flat_growth(e));
  }
  return sentence;
}

// A sentence on instabilities that the reduced motion cannot show: it is exact, but the slightest
// push would leave it.
std::string left_out_sentence(const Explanation& e) {
  return fmt::format(
      "{} of these directions lead{} out of what is left (dimension, mirror): the motion as drawn "
      "never takes them, one that is disturbed does; --no-reduce dimension,mirror keeps them",
      e.unstable_left_out, e.unstable_left_out == 1 ? "s" : "");
}

}  // namespace

Explanation explain(const Scene& scene, const Model& model, const ExplanationLimits& limits) {
  const System& system = model.system();
  const Vec& q = model.initial().q;
  Explanation e;
  e.drawn_unknowns = scene.dimension * std::ssize(scene.nodes);
  e.unknowns = system.size();
  e.findings = model.findings();
  e.stiffness_is_constant = system.stiffness_is_constant();
  e.stiff_springs =
      static_cast<std::size_t>(std::ranges::count_if(scene.springs, [&](const Spring& spring) {
        return is_stiff(spring.law, scene.stiff_above);
      }));
  e.omega_bound = frequency_bound(system, q);
  e.omega_max = e.drawn_unknowns <= limits.frequency ? lanczos(system, q)
                                                     : std::numeric_limits<double>::quiet_NaN();
  e.is_damped = system.damping() != nullptr;
  if (e.is_damped && e.drawn_unknowns <= limits.damping) find_damping(e, system, q);
  e.is_examined = e.drawn_unknowns <= limits.examined;
  if (!e.is_examined || e.unknowns == 0) return e;
  const Model all(scene, Reductions::all_directions());
  try {
    const CurvatureSigns signs = curvature_signs(all.system(), all.initial().q);
    e.unstable = signs.negative;
    e.flat = signs.flat;
    e.flat_rate = signs.flat_rate;
    if (e.unstable == 0) return e;
    e.unstable_left_out = std::max(0, e.unstable - curvature_signs(system, q).negative);
  } catch (const std::runtime_error&) {
    e.is_examined = false;  // stiffnesses that overflow
    return e;
  }
  find_fastest(e, all);
  return e;
}

std::string explanation_in_words(const Explanation& e, const Scene& scene) {
  const auto rods =
      std::ranges::count_if(scene.springs, [](const Spring& spring) { return spring.law.rigid; });
  std::string words =
      fmt::format("{}: {} nodes, {} springs{}; {} unknowns of {} are left\n", scene.name,
                  scene.nodes.size(), std::ssize(scene.springs) - rods,
                  rods > 0 ? fmt::format(", {} rods", rods) : "", e.unknowns, e.drawn_unknowns);
  const auto line = [&](std::string_view about, const std::string& sentence) {
    words += fmt::format("  {:<19} {}\n", about, sentence);
  };
  for (const Finding& finding : e.findings) line(name(finding.reduction), finding.what);
  if (!e.stiffness_is_constant && e.unknowns > 0) line("K", "changes with the positions");
  if (scene.stiff_above) {
    line("stiff", fmt::format("{} of {} springs are stiff (above {:.4g} N/m)", e.stiff_springs,
                              scene.springs.size(), *scene.stiff_above));
  }
  if (rods > 0) {
    line("rods", fmt::format("{} keep their lengths: {}", rods,
                             e.omega_bound > 0 ? "the next line is of the springs alone, and "
                                                 "tensions of rods add to it"
                                               : "no spring vibrates"));
    if (e.omega_bound > 0) line("step", step_sentence(e));
    if (e.is_damped) line("damping", damping_sentence(e));
    return words;
  }
  line("step", step_sentence(e));
  if (e.is_damped) line("damping", damping_sentence(e));
  if (e.unknowns > 0) line("stability", stability_sentence(e, scene));
  if (e.unstable_left_out > 0) line("", left_out_sentence(e));
  return words;
}

}  // namespace qddot
