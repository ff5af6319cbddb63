#include "experiments/stability_map/linear_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/progress.hpp"
#include "experiments/stability_map/modal_step.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/stability/linear_limit.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot::stability_map {
namespace {

constexpr int linear_points = 60;  // a decade
constexpr std::array damping_ratios = {0.01, 0.03, 0.1, 0.3, 1., 3., 10.};
constexpr std::array fast_frequencies = {1., 10., 100., 1000.};

std::string or_none(double limit) {
  if (limit == 0) return "grows at every h";
  return std::isinf(limit) ? "none" : fmt::format("{:.10g}", limit);
}

// The row of adaptive.csv: the steps of an adaptive method on a slow motion beside a fast vibration
// almost at rest. These are q1'' = -q1 from (1, 0) and q2'' = -w^2 q2 from (0, 1e-6), over ten
// periods of q1.
// An explicit method still has to keep h w below its limit. It does so by a bound of w, or by
// rejecting steps once q2 has grown to a visible size. Energies are those at the end: of the fast
// vibration over all at the start, of the slow one as its error.
std::string chosen_steps(const Method& method, double rtol, double omega) {
  constexpr double duration = 10 * 2 * M_PI, fast_speed = 1e-6;
  Network network{.dimension = 1, .node_mass = Vec::Ones(2)};
  network.anchors = {{0, Eigen::Vector3d::Zero(), {.stiffness = 1}},
                     {1, Eigen::Vector3d::Zero(), {.stiffness = omega * omega}}};
  const auto system = make_mass_spring(network);
  State state{0, Vec{{1, 0}}, Vec{{0, fast_speed}}};
  const Summary summary =
      make_integrator(method, *system, {.rtol = rtol})->advance(state, duration);
  const Counts& c = summary.counts;
  const auto accepted = static_cast<double>(std::max<std::int64_t>(1, c.steps));
  const auto energy = [](double w, double q, double v) { return w * w * q * q + v * v; };
  Csv csv;
  csv.row(method.name, rtol, omega, name(summary.outcome), summary.t_reached / accepted * omega,
          static_cast<double>(c.rejected) / static_cast<double>(c.steps + c.rejected),
          energy(omega, state.q[1], state.v[1]), energy(1, state.q[0], state.v[0]) - 1, c.steps,
          c.rejected, c.stability_limited_steps);
  return std::string(csv.text());
}

constexpr int modes_excited = 12;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

// The row of modal.csv of a method in a mode.
std::string modal_row(const Method& method, const Mode& mode, const Model& rest, double h) {
  LinearStep predicted{}, measured{};
  std::string verdict;
  try {
    predicted = linear_step(method, h * mode.omega, {}, mode.zeta);
    measured = modal_step(method, rest, mode, {.step_size = h});
    verdict = modal_verdict(measured);
  } catch (const std::exception& why) {  // may not leave a thread
    verdict = why.what();
  }
  Csv csv;
  csv.field(method.name);
  csv.field(h);
  csv.field(mode.rank);
  csv.field(mode.omega);
  csv.field(h * mode.omega);
  for (const auto number :
       {&LinearStep::damping_ratio, &LinearStep::period_error, &LinearStep::spectral_radius}) {
    for (const LinearStep* step : {&predicted, &measured})
      csv.field(step->roots.empty() ? none : (step->*number)());
  }
  csv.field(verdict);
  csv.field(mode.zeta);
  csv.end_row();
  return std::string(csv.text());
}

}  // namespace

std::vector<double> spaced(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / std::max(1, count - 1)));
  }
  return values;
}

void add_limits(Study& study, const std::vector<const Method*>& methods,
                std::vector<Limit>& limits) {
  std::vector<const Method*> linear = methods;
  std::erase_if(linear, [](const Method* method) { return !has_linear_step(*method); });
  progress().begin(linear.size());
  for (const Method* method : linear) {
    progress().now_at("limit of " + method->name);
    const nlohmann::json limit = study.piece("limit " + method->name, [&] {
      return nlohmann::json{linear_limit(*method), measured_limit(*method)};
    });
    limits.push_back({method, limit.at(0), limit.at(1)});
    progress().finish("limit of " + method->name + " is found");
  }
}

void tabulate(Csv& csv, const std::vector<Limit>& limits, double omega_max) {
  for (const Limit& limit : limits) {
    csv.row(limit.method->name, limit.predicted / omega_max, limit.measured / omega_max,
            limit.predicted, limit.measured, limit.difference());
  }
}

void print(const std::vector<Limit>& limits) {
  fmt::print("{:<26} {:>18} {:>18} {:>12}\n", "limit of h w on an oscillator", "predicted",
             "measured", "difference");
  for (const Limit& limit : limits) {
    const double difference = limit.difference();
    fmt::print("{:<29} {:>18} {:>18} {:>12}\n", limit.method->name, or_none(limit.predicted),
               or_none(limit.measured),
               std::isfinite(difference) ? fmt::format("{:.1e}", difference) : "");
  }
}

void tabulate_damped_limits(Study& study, Csv& csv, const std::vector<const Method*>& methods) {
  std::vector<const Method*> damped = methods;
  std::erase_if(damped, [](const Method* method) {
    return !has_linear_step(*method) || method->takes_damping() != Damped::by_any ||
           method->is(Trait::implicit) || method->asks(Need::constant_stiffness);
  });
  progress().begin(damped.size());
  for (const Method* method : damped) {
    const auto rows = study.piece("damped limits of " + method->name, [&] {
      Csv own;
      for (const double zeta : damping_ratios) {
        const double predicted = damped_limit(*method, zeta);
        const double measured = measured_limit(*method, zeta);
        own.row(method->name, zeta, predicted, measured, (measured - predicted) / predicted);
      }
      return nlohmann::json(std::string(own.text()));
    });
    csv.rows(rows.get<std::string>());
    progress().finish("damped limits of " + method->name + " are found");
  }
}

void tabulate_linear(Csv& csv, const std::vector<const Method*>& methods) {
  const int points =
      static_cast<int>(std::log10(largest_searched_h_omega / least_searched_h_omega)) *
      linear_points;
  for (const Method* method : methods) {
    stop_if_interrupted();
    if (!has_linear_step(*method)) continue;
    for (const double h_omega :
         spaced(least_searched_h_omega, largest_searched_h_omega, points + 1)) {
      const LinearStep step = linear_step(*method, h_omega);
      csv.row(method->name, h_omega, step.spectral_radius(), step.damping_ratio(),
              step.period_error());
    }
  }
}

void tabulate_adaptive(Study& study, Csv& csv, const std::vector<const Method*>& methods) {
  std::vector<const Method*> adaptive = methods;
  std::erase_if(adaptive, [](const Method* method) {
    return method->knob != Knob::rtol || method->asks(Need::split_forces) ||
           !method->stock_of.empty();
  });
  progress().begin(adaptive.size());
  for (const Method* method : adaptive) {
    for (const double rtol : tolerances) {
      for (const double omega : fast_frequencies) {
        progress().now_at(fmt::format("steps of {} at rtol {:g}", method->name, rtol));
        const auto row =
            study.piece(fmt::format("steps {} {:g} {:g}", method->name, rtol, omega),
                        [&] { return nlohmann::json(chosen_steps(*method, rtol, omega)); });
        csv.rows(row.get<std::string>());
      }
    }
    progress().finish("steps of " + method->name + " are measured");
  }
}

void tabulate_modes(Study& study, Csv& csv, const std::vector<const Method*>& methods,
                    const Model& rest, double step_size) {
  std::vector<const Method*> stepping = methods;
  std::erase_if(stepping, [&](const Method* method) {
    return !has_linear_step(*method) || !applies_to(*method, rest.system());
  });
  const auto modes = sampled_modes(rest.system(), rest.initial().q, modes_excited);
  if (modes.empty()) return;
  const double h = step_size > 0 ? step_size : 1 / modes.back().omega;
  progress().begin(stepping.size());
  for (const Method* method : stepping) {
    const auto rows = study.piece("modes " + method->name, [&] {
      std::vector<std::string> texts(modes.size());
#pragma omp parallel for schedule(dynamic)
      for (std::size_t i = 0; i < modes.size(); ++i)
        texts[i] = modal_row(*method, modes[i], rest, h);
      return nlohmann::json(fmt::format("{}", fmt::join(texts, "")));
    });
    csv.rows(rows.get<std::string>());
    progress().finish(fmt::format("{} in {} modes", method->name, modes.size()));
  }
}

}  // namespace qddot::stability_map
