#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/base/step_times.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/random_times.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/reference/reference_ways.hpp"

namespace qddot::inline measure {
namespace {

constexpr int most_levels = 12;
constexpr std::int64_t looks_for_scales = 1000;

// A method that computes the motion, more accurately with each level.
struct Way {
  bool resolves_vibrations;
  double expected;  // seconds of the next level
  double growth;    // ratio of these seconds from level to level
  std::function<std::optional<Solution>(int level, double seconds)> solve;
  int level = 0;
  std::optional<Solution> finest{};
};

// A run with fixed steps: h w <= coarsest at the start, halved with each level.
std::optional<Solution> resolved(const Model& scene, const char* name, double until,
                                 double coarsest, int level, double seconds) {
  const double w = frequency_bound(scene.system(), scene.initial().q);
  const double least = std::max(16.0, std::ceil(until * w / coarsest * std::exp2(level)));
  if (!(least < most_steps)) return {};
  const double h = until / least;
  auto solution = seen_run(scene, *find_method(name), {.step_size = h}, scene.initial(),
                           random_step_times(h, until, looks_for_scales), seconds);
  if (solution) solution->made_by = fmt::format("{} at h = {:.6g} s", name, h);
  return solution;
}

std::optional<Solution> ida(const Model& scene, double until, double rtol, double seconds) {
  if (rtol < least_rtol) return {};
  auto solution = seen_run(scene, *find_method("ida"), with_tolerance_scales({.rtol = rtol}, scene),
                           scene.initial(), {until}, seconds);
  if (solution) solution->made_by = fmt::format("ida at rtol = {:.0e}", rtol);
  return solution;
}

}  // namespace

Reference agreed_reference(const Model& scene, double until, double needed, double seconds) {
  const auto start = clock_now();
  require_constant_energy(scene.system());
  Scales scales;
  const auto explicitly = [&](const char* name, double coarsest) {
    return [&, name, coarsest](int level, double limit) {
      return resolved(scene, name, until, coarsest, level, limit);
    };
  };
  const auto tolerance = [](int level) { return std::pow(10.0, -8 - level); };
  const auto by_fehlberg = [&](int level, double limit) {
    return fehlberg(scene, until, tolerance(level), scales, limit);
  };
  const auto by_ida = [&](int level, double limit) {
    return ida(scene, until, tolerance(level), limit);
  };
  // Verlet runs first, and the other times are estimated from its time. Kahan and Li's composition
  // evaluates 17 forces a step. Fehlberg's pair evaluates 13, and its steps are no longer than
  // three of Verlet's. The time of the implicit method is a guess.
  const char* const of_order_8 = resolving_method(scene.system()).name.c_str();
  Way verlet{true, 0, 2, explicitly("verlet", 1)};
  const auto begin = clock_now();
  verlet.finest = verlet.solve(verlet.level++, seconds);
  const double unit = seconds_since(begin);
  verlet.expected = verlet.growth * unit;
  if (verlet.finest) scales = verlet.finest->scales;
  std::array<Way, 4> ways = {verlet, Way{true, 17.0 / 2 * unit, 2, explicitly(of_order_8, 2)},
                             Way{false, 13.0 / 3 * unit, 1.4, by_fehlberg},
                             Way{false, 2 * unit, 1.6, by_ida}};

  std::optional<Reference> nearest;
  while (!nearest || nearest->certified.position > needed) {
    Way& next = *std::ranges::min_element(ways, {}, &Way::expected);
    const double left = seconds - seconds_since(start);
    if (next.expected > left) break;
    const auto from = clock_now();
    const auto solution = next.solve(next.level++, left);
    next.expected = next.level < most_levels ? next.growth * seconds_since(from)
                                             : std::numeric_limits<double>::infinity();
    if (!solution) continue;
    next.finest = solution;
    for (const Way& other : ways) {
      if (other.resolves_vibrations == next.resolves_vibrations || !other.finest) continue;
      const Reference reference = next.resolves_vibrations
                                      ? joined(scene, *next.finest, *other.finest)
                                      : joined(scene, *other.finest, *next.finest);
      if (!nearest || reference.certified.position < nearest->certified.position)
        nearest = reference;
    }
  }
  if (!nearest) throw NoReference("no reference: no two unlike methods reached the end in time");
  nearest->seconds = seconds_since(start);
  return *nearest;
}

}  // namespace qddot::inline measure
