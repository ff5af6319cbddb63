#include "qddot/measure/stability/energy_loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/kinetic_frequency.hpp"
#include "qddot/measure/motion/random_times.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

// Smaller losses are not told; a loss of `kept_part` counts as none.
constexpr double told_loss = 0.05, kept_part = 0.01, nearly_nothing = 5e-4;
// A rate follows from no larger loss: nothing of the energy may be left.
constexpr double largest_loss = 0.999;
constexpr int loss_looks = 64, most_finer = 20;
constexpr std::size_t most_keeping = 3;

// Runs the method for `seconds` at most, and shows some of its states.
Summary run_again(const Method& method, const Options& options, const Model& scene, double until,
                  double seconds, const Observer& some = {}) {
  State state = scene.initial();
  const Deadline deadline(seconds);
  return make_integrator(method, scene.system(), with_tolerance_scales(options, scene))
      ->advance(state, until, some, deadline.token());
}

// The motion's own frequency [rad/s], at random steps of a repeated run.
double seen_frequency(const Method& method, const Options& options, const Model& scene,
                      double until, double seconds) {
  KineticFrequency frequency(scene.system());
  frequency.see(scene.initial());
  run_again(method, options, scene, until, seconds,
            {random_step_times(options.step_size, until, loss_looks),
             [&](const State& seen) { frequency.see(seen); }});
  return frequency.value();
}

// The method's step on a vibration of w [rad/s]; empty if it fails.
std::optional<LinearStep> step_on(double omega, const Method& method, const Options& options) {
  try {
    return linear_step(method, options.step_size * omega, options);
  } catch (const std::runtime_error&) {
    return {};
  }
}

// The rate [1/s] at which the method's steps take energy from a vibration of w [rad/s]: the energy
// is multiplied by the squared spectral radius in each step. NaN if a step fails.
double loss_rate(const Method& method, const Options& options, double omega) {
  const auto step = step_on(omega, method, options);
  return step ? -2 * std::log(step->spectral_radius()) / options.step_size
              : std::numeric_limits<double>::quiet_NaN();
}

// Whether the method's linear steps neither damp nor feed these vibrations until then.
bool keeps(const Method& method, const Options& options, const std::vector<double>& omegas,
           double until) {
  return std::ranges::all_of(omegas, [&](double omega) {
    return std::abs(loss_rate(method, options, omega)) * until < kept_part;
  });
}

// The largest of h/2, h/4, ... at which a vibration of w loses about a hundredth where it lost
// `loss` at h [s]; zero if there is none.
double keeping_step(const Method& method, Options options, double omega, double loss) {
  const double most = std::log1p(-kept_part) / std::log1p(-std::min(loss, largest_loss)) *
                      loss_rate(method, options, omega);
  for (int i = 0; i < most_finer; ++i) {
    options.step_size /= 2;
    if (loss_rate(method, options, omega) <= most) return options.step_size;
  }
  return 0;
}

bool is_candidate(const Method& method, const System& system) {
  return has_linear_step(method) && method.order > 0 && applies_to(method, system) &&
         (method.is(Trait::accepts_massless) || !system.has_massless());
}

}  // namespace

std::string loss_warning(const Method& method, const Options& options, const Model& scene,
                         const Summary& summary, double until, double seconds) {
  if (!(summary.energy_loss > told_loss) || summary.outcome != Outcome::reached_end) return "";
  std::string words = fmt::format(
      "the method took {:.3g} J, {:.2g} % of the energy that this motion can turn into speed",
      summary.energy_lost, 100 * summary.energy_loss);
  if (scene.system().damping())
    words += fmt::format(", beside {:.3g} J that damping took", summary.work.dissipated);
  if (!has_linear_step(method)) {
    return words + (method.knob == Knob::rtol ? ": lower --rtol" : ": lower --step-size");
  }
  const auto begin = clock_now();
  const auto left = [&] { return seconds - seconds_since(begin); };
  const System& system = scene.system();
  double own = seen_frequency(method, options, scene, until, seconds);
  std::vector<double> omegas;
  if (system.has_stiffness()) {
    const double highest = quick_frequency(system, scene.initial().q);
    if (std::isfinite(highest) && highest > 0) omegas.push_back(highest);
    // Few looks may see more acceleration than speed.
    if (!omegas.empty()) own = std::min(own, highest);
  }
  // A repeated run that time ends at once has seen no speed.
  const bool has_own = options.step_size * own > 0;
  if (has_own) omegas.insert(omegas.begin(), own);
  if (omegas.empty() || std::isnan(loss_rate(method, options, omegas.back())))
    return words + ": lower --step-size";
  if (keeps(method, options, omegas, until)) {
    return words + fmt::format(
                       "; {} damps no vibration, so its energy swings at this step (h w is {:.2g} "
                       "at the motion's own {:.3g} rad/s): lower --step-size",
                       method.name, options.step_size * own, own);
  }
  std::vector<std::string> ratios;
  for (const double omega : omegas) {
    if (const auto step = step_on(omega, method, options)) {
      ratios.push_back(fmt::format("{:.2g} at {} = {:.4g} rad/s", step->damping_ratio(),
                                   omega == own ? "the motion's own w" : "w_max", omega));
    }
  }
  words +=
      fmt::format(": {} damps like a damping ratio of {}", method.name, fmt::join(ratios, " and "));
  const double finer = has_own ? keeping_step(method, options, own, summary.energy_loss) : 0;
  if (finer > 0) words += fmt::format("; a step of {:.2g} s takes about a hundredth", finer);
  std::vector<std::string> others;
  for (const Method& other : methods()) {
    if (others.size() == most_keeping || left() <= 0) break;
    if (!is_candidate(other, system) || !keeps(other, options, omegas, until)) continue;
    const Summary tried = run_again(other, options, scene, until, left());
    if (tried.outcome == Outcome::reached_end && tried.energy_loss < told_loss &&
        tried.energy_growth < 1 + told_loss) {
      others.push_back(fmt::format("{} takes {}", other.name,
                                   tried.energy_loss < nearly_nothing
                                       ? "nothing"
                                       : fmt::format("{:.1g} %", 100 * tried.energy_loss)));
    }
  }
  if (!others.empty()) words += fmt::format("; tried at this step: {}", fmt::join(others, ", "));
  return words;
}

}  // namespace qddot::inline measure
