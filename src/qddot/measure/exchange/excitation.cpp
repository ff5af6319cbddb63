#include "qddot/measure/exchange/excitation.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/analysis/natural_modes.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/random_times.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/stiff_energies.hpp"

namespace qddot::inline measure {
namespace {

constexpr double reference_rtol = 1e-12;
constexpr double periods_of_mean = 40;

// The highest frequency [rad/s] of the stiff springs alone; 0 if there are none.
double stiff_frequency(const System& system, const Vec& q) {
  double highest = 0;
  Index first = 0;
  for (const auto& block : system.blocks()) {
    highest = std::max(highest, stiff_frequency(*block, q.segment(first, block->size())));
    first += block->size();
  }
  const Split* split = system.split();
  if (!split || split->stiff_unknowns.empty()) return highest;
  const Vec own = q(split->stiff_unknowns);
  return std::max(highest, std::sqrt(highest_modes(*split->stiff_block, own, 1).squares[0]));
}

}  // namespace

Excitation excitation_of(Scene start, Model scene, double until, const std::string& source) {
  Excitation excitation{.start = std::move(start), .scene = std::move(scene), .until = until};
  const State& initial = excitation.scene.initial();
  excitation.every = until / 1000;
  excitation.omega = stiff_frequency(excitation.scene.system(), initial.q);
  excitation.energy = excitation.scene.energy(initial);
  excitation.sum = stiff_energies(excitation.start, excitation.start.nodes).sum();
  const auto stiff_above = excitation.start.stiff_above;
  if (!(excitation.omega > 0)) {
    throw InvalidInput(fmt::format(
        "{}: stiff_above: {}; allowed are finite numbers above 0 in N/m, less than the stiffness "
        "of some spring between free nodes: the energy of such springs is followed",
        source,
        stiff_above ? fmt::format("{} leaves no stiff spring that moves", *stiff_above)
                    : "it is missing"));
  }
  if (!(excitation.sum > 0)) {
    throw InvalidInput(
        fmt::format("{}: the stiff springs start without energy, {} J, so that there is none to be "
                    "exchanged; allowed are scenes that start with a stiff spring drawn or moving "
                    "out of its rest length",
                    source, excitation.sum));
  }
  excitation.window = std::min(periods_of_mean * 2 * M_PI / excitation.omega, until / 4);
  return excitation;
}

ExchangeRun exchange_run(const Excitation& excitation, const Method& method, double value,
                         const std::vector<double>& times, double seconds) {
  ExchangeRun run;
  const auto see = [&](const State& state) {
    const Vec energies = stiff_energies(excitation.start, excitation.scene.expand(state));
    const auto raise = [](double& largest, double x) {
      if (!(x <= largest)) largest = x;
    };
    raise(run.sum_deviation, std::abs(energies.sum() / excitation.sum - 1));
    raise(run.energy_error, std::abs(excitation.scene.energy(state) / excitation.energy - 1));
    run.course.times.push_back(state.t);
    run.course.energies.push_back(energies);
  };
  State state = excitation.scene.initial();
  see(state);
  const Deadline deadline(seconds);
  run.summary = make_integrator(method, excitation.scene.system(),
                                options_for(method, value, excitation.scene))
                    ->advance(state, excitation.until, {times, see}, deadline.token());
  return run;
}

std::vector<double> looks(const Excitation& excitation, double h) {
  const auto count = static_cast<std::int64_t>(std::ceil(excitation.until / excitation.every));
  // No look at a shorter last step.
  constexpr double rounded = 1 + 1e-12;
  const double whole = std::floor(excitation.until / h * rounded) * h;
  return random_step_times(h, whole > 0 ? std::min(whole, excitation.until) : excitation.until,
                           count);
}

CertifiedCourse certified_course(const Excitation& excitation, const Recall& recall) {
  CertifiedCourse reference{.h = CertifiedCourse::h_omega / excitation.omega};
  const auto times = looks(excitation, reference.h);
  const auto reached = [&](const char* name, double value) {
    const auto make = [&] { return exchange_run(excitation, *find_method(name), value, times); };
    ExchangeRun run = recall ? recall(fmt::format("reference {}", name), make) : make();
    if (run.summary.outcome == Outcome::reached_end) return run;
    throw NoReference(fmt::format("{} reaches {} of {} s only, so that there is no reference: {}",
                                  name, run.summary.t_reached, excitation.until,
                                  run.summary.message));
  };
  reference.run = reached("kahan_li8", reference.h);
  const ExchangeRun other = reached("dprkn12", reference_rtol);
  for (std::size_t i = 0; i <= times.size(); ++i) {
    const Vec difference = reference.run.course.energies[i] - other.course.energies[i];
    reference.certified =
        std::max(reference.certified, difference.lpNorm<Eigen::Infinity>() / excitation.sum);
  }
  return reference;
}

}  // namespace qddot::inline measure
