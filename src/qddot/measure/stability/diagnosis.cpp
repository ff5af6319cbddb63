#include "qddot/measure/stability/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/analysis/damped_step.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/random_times.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/motion/vibrating_modes.hpp"
#include "qddot/measure/stability/linear_limit.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::inline measure {
namespace {

// The number of looks at a run's energy, and of halved step sizes that are tried, from h/2 to
// h/4096.
constexpr int most_looks_back = 32, most_halvings = 12;
constexpr std::size_t most_named = 3;
// A motion counts as unchanged while its energy has changed by less than this part of the largest
// kinetic energy so far.
constexpr double same = 0.5;
// A growth of the energy by more than the first factor is reported; beyond the second its size
// means nothing.
constexpr double largest_growth = 10, countless = 1e6;
// A speed [m/s] that no intended motion has.
constexpr double largest_speed = 1e15;
// The largest scene for which implicit methods are tried: factors of larger ones take seconds and
// gigabytes.
constexpr Index most_factorized = 100000;

bool has_own_step(const Method& method) { return has_linear_step(method) && method.order > 0; }

// Runs the method and calls see() for each of some times before `until`, for `seconds` at most.
Summary run(const Method& method, const Options& options, const Model& scene, double until,
            double seconds, const std::function<void(const State&)>& see) {
  Observer some{random_step_times(options.step_size, until, most_looks_back), see};
  some.times.pop_back();
  const Deadline deadline(seconds);
  State state = scene.initial();
  return make_integrator(method, scene.system(), with_tolerance_scales(options, scene))
      ->advance(state, until, some, deadline.token());
}

// Watches whether the energy of a motion is still right.
class EnergyWatch {
 public:
  explicit EnergyWatch(const Model& scene) : scene_(scene), start_(scene.energy(scene.initial())) {
    see(scene.initial());
  }
  bool see(const State& state) {
    const double kinetic = scene_.system().kinetic(state.v);  // a common fall would hide the gain
    const double change = std::abs(scene_.energy(state) - start_);
    // Kinetic energy that stems from the error is not counted.
    if (is_same_ && change <= same * std::max(largest_, kinetic - change)) {
      largest_ = std::max(largest_, kinetic - change);
    } else if (change > 0) {
      is_same_ = false;
    }
    return is_same_;
  }
  bool is_same() const { return is_same_; }

 private:
  const Model& scene_;
  double start_, largest_ = 0;
  bool is_same_ = true;
};

// The last time [s] at which the run had the right energy, and the largest frequency until then
// [rad/s], or a lower bound of it. `buckling` is the rate [1/s] at which compressed springs push
// sideways, or zero if it was not computed.
struct Before {
  double t = 0, omega = 0, t_of_omega = 0, buckling = 0;
};
Before before_failure(const Method& method, const Options& options, const Model& scene,
                      double t_end, double seconds) {
  const auto pushed = [&](const Vec& q) {
    return method.is(Trait::implicit) && is_quickly_searched(scene.system())
               ? buckling_rate(scene.system(), q)
               : 0;
  };
  Before before{.omega = quick_frequency(scene.system(), scene.initial().q),
                .buckling = pushed(scene.initial().q)};
  EnergyWatch watch(scene);
  const auto see = [&](const State& state) {
    // The first state with a wrong energy counts: its step began at a right one.
    const bool counts = watch.is_same();
    if (watch.see(state)) before.t = state.t;
    if (!counts) return;
    before.buckling = std::max(before.buckling, pushed(state.q));
    const double omega = quick_frequency(scene.system(), state.q);
    if (omega > before.omega) {
      before.omega = omega;
      before.t_of_omega = state.t;
    }
  };
  run(method, options, scene, t_end, seconds, see);
  return before;
}

// The largest stable h w, found by running the method if it is explicit and declares none.
double stable_h_omega(const Method& method) {
  const bool is_known =
      method.stability_limit || method.is(Trait::implicit) || !has_linear_step(method);
  return is_known ? linear_limit(method) : measured_limit(method);
}

// The rate [1/s] at which a step lets a vibration of that w grow, in words; empty if it overflows.
std::string growth_in_words(const Method& method, double h, double omega) {
  const double rate = std::log(linear_step(method, h * omega).spectral_radius()) / h;
  return std::isfinite(rate) ? fmt::format(", here by up to {:.3g}/s", rate) : "";
}

// With damping, the limit that an explicit method crossed at the start; empty if it did not.
std::string crossed_with_damping(const Method& method, double h, const Model& scene) {
  const System& system = scene.system();
  if (method.is(Trait::implicit) || !is_quickly_searched(system)) return "";
  const double limit = stable_step(method, system, scene.initial().q);
  if (h <= limit) return "";
  return fmt::format("h is above {:.4g} s, {}'s limit with this damping at the start", limit,
                     method.name);
}

std::string crossed(const Method& method, double h, const Before& before, bool is_known,
                    Outcome outcome) {
  const double limit = stable_h_omega(method);
  const auto when = [](double t) {
    return t == 0 ? std::string("at the start") : fmt::format("at t = {:.3g} s", t);
  };
  if (limit == 0) {
    return fmt::format("{} lets vibrations grow at every h{}", method.name,
                       growth_in_words(method, h, before.omega));
  }
  if (h * before.omega > limit) {
    return fmt::format(
        "h w_max is {}{:.3g} {} (w_max = {:.4g} rad/s), above {}'s limit of {:.5g}/w_max = {:.4g} "
        "s",
        is_known ? "" : "at least ", h * before.omega, when(before.t_of_omega), before.omega,
        method.name, limit, limit / before.omega);
  }
  if (method.is(Trait::implicit) && before.buckling * h > 0.1) {
    return fmt::format(
        "compressed springs push to the side at a rate of up to {:.3g}/s, {:.3g} of "
        "1/h; M - h^2 K is indefinite where that is above 1",
        before.buckling, before.buckling * h);
  }
  if (outcome == Outcome::newton_failed || !is_known) return "";
  return fmt::format(
      "no linear limit was crossed (h w_max was {:.3g} at most): this is a nonlinear "
      "instability",
      h * before.omega);
}

// Whether a run reaches the end without a growth of its energy; empty if time is up.
std::optional<bool> holds(const Method& method, const Options& options, const Model& scene,
                          double until, double seconds) {
  if (seconds <= 0) return {};
  const double energy = scene.energy(scene.initial());
  // The potential without the motion in closed form: that of a fall has no minimum.
  const auto potential = [&](const State& state) {
    return scene.energy(state) - scene.system().kinetic(state.v);
  };
  double lowest = potential(scene.initial()), largest = energy;
  const Summary summary = run(method, options, scene, until, seconds, [&](const State& state) {
    lowest = std::min(lowest, potential(state));
    largest = std::max(largest, scene.energy(state));
  });
  if (summary.outcome == Outcome::over_budget) return {};
  // At most the energy above the lowest potential can become kinetic.
  return summary.outcome == Outcome::reached_end && largest - energy <= same * (energy - lowest);
}

// The warning for a system with Damping: of leapfrog methods, whose limit is known.
std::string damped_step_warning(const Method& method, double h, const Model& scene) {
  const System& system = scene.system();
  const Vec& q = scene.initial().q;
  if (method.friction_lag == 0 || !is_quickly_searched(system)) return "";
  // 4 - 2 lag h C - h^2 K is bounded from below in no time where C is of K and M.
  if (const std::optional<double> beta = system.damping()->damping_time()) {
    const double alpha = system.damping()->air_damping(), w = frequency_bound(system, q);
    if (4 - 2 * method.friction_lag * h * (alpha + *beta * w * w) - h * h * w * w > 0) return "";
  }
  const double limit = damped_step_limit(system, q, method.friction_lag);
  if (h <= limit) return "";
  return fmt::format(
      "h = {:.4g} s is above {:.4g} s, where {} blows up with this damping: without it the limit "
      "would be {:.4g} s",
      h, limit, method.name, linear_limit(method) / quick_frequency(system, q));
}

// Half a sentence if the forces of the start accelerate nodes to absurd speeds; empty if not.
std::string extreme_start(const Model& scene) {
  const Vec& mass = scene.system().mass();
  Vec f(mass.size());
  scene.system().force(scene.initial(), f);
  const double a = (mass.array() > 0).select(f.cwiseQuotient(mass), 0).lpNorm<Eigen::Infinity>();
  const double speed = std::sqrt(a * with_tolerance_scales({}, scene).length);
  if (f.allFinite() && speed < largest_speed) return "";
  return fmt::format(
      "the forces of the start accelerate a node by {:.3g} m/s^2, before any step: look for "
      "extreme "
      "rest lengths, stiffnesses or masses in the scene",
      a);
}

}  // namespace

std::string step_warning(const Method& method, const Options& options, const Model& scene) {
  if (!has_own_step(method)) return "";
  const System& system = scene.system();
  const Vec& q = scene.initial().q;
  const double limit = linear_limit(method), h = options.step_size;
  if (system.damping()) return damped_step_warning(method, h, scene);
  if (h * frequency_bound(system, q) <= limit) return "";
  const double w = quick_frequency(system, q);
  if (h * w <= limit) return "";
  if (limit == 0) {
    return fmt::format(
        "{} lets every vibration grow at every h, here the fastest by {:.3g}/s (w_max = {:.5g} "
        "rad/s at the start)",
        method.name, h * w * w / 2, w);
  }
  return fmt::format(
      "h = {:.4g} s is above {:.5g}/w_max = {:.4g} s, where {} blows up (w_max = {:.5g} rad/s at "
      "the start)",
      h, limit, limit / w, method.name, w);
}

std::string growth_warning(const Method& method, const Summary& summary) {
  const double growth = summary.energy_growth;
  if (growth <= largest_growth) return "";
  return fmt::format(
      "the energy grew to {} times what this motion can have, so this is not the scene's motion: "
      "lower {}",
      growth > countless ? fmt::format("more than {:g}", countless) : fmt::format("{:.3g}", growth),
      method.knob == Knob::step_size ? "--step-size" : "--rtol");
}

std::string diagnosis(const Method& method, const Options& options, const Model& scene,
                      double until, const Summary& summary, double seconds) {
  constexpr std::array diagnosed = {Outcome::diverged, Outcome::not_finite,
                                    Outcome::indefinite_matrix, Outcome::newton_failed};
  const bool is_diagnosed = std::ranges::find(diagnosed, summary.outcome) != diagnosed.end();
  if (is_diagnosed || summary.outcome == Outcome::step_too_small) {
    if (std::string extreme = extreme_start(scene); !extreme.empty()) return extreme;
  }
  if (!has_own_step(method) || !is_diagnosed) return "";
  const auto begin = clock_now();
  const auto left = [&] { return seconds - seconds_since(begin); };
  const double h = options.step_size;
  const Before before = before_failure(method, options, scene, summary.t_reached, seconds / 4);
  std::string words = fmt::format("it failed in step {}", summary.failed_step);
  if (summary.outcome == Outcome::diverged && before.t < summary.t_reached) {
    words += fmt::format(", its energy no longer right after t = {:.3g} s", before.t);
  }
  const bool is_damped = scene.system().damping() && !method.is(Trait::implicit);
  const std::string why =
      is_damped ? crossed_with_damping(method, h, scene)
                : crossed(method, h, before, is_quickly_searched(scene.system()), summary.outcome);
  if (!why.empty()) words += "; " + why;

  std::vector<std::string> remedies;
  if (linear_limit(method) > 0 || scene.system().damping()) {
    Options finer = options;
    for (int i = 1; i <= most_halvings; ++i) {
      finer.step_size = h / std::pow(2, i);
      const auto held = holds(method, finer, scene, until, std::min(left(), seconds / 2));
      if (!held) break;
      if (!*held) continue;
      remedies.push_back(fmt::format("h = {:.3g} s", finer.step_size));
      break;
    }
  }
  std::vector<std::string> others;
  for (const Method& other : methods()) {
    if (!has_own_step(other) || other.family != Family::hand_written || &other == &method ||
        !applies_to(other, scene.system()) || others.size() == most_named ||
        (other.is(Trait::implicit) && scene.system().size() > most_factorized)) {
      continue;
    }
    if (holds(other, options, scene, until, std::min(left(), seconds / 8)).value_or(false)) {
      others.push_back(other.name);
    }
  }
  if (!others.empty()) remedies.push_back(fmt::format("at this h {}", fmt::join(others, ", ")));
  if (!remedies.empty()) {
    words += fmt::format("; stable when tried: {}", fmt::join(remedies, ", or "));
  }
  return words;
}

}  // namespace qddot::inline measure
