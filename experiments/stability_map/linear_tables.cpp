#include "experiments/stability_map/linear_tables.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/progress.hpp"
#include "experiments/stability_map/chosen_steps.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/stability/linear_limit.hpp"
#include "qddot/measure/stability/linear_step.hpp"

namespace qddot::stability_map {
namespace {

constexpr int linear_points = 60;  // a decade
constexpr std::array fast_frequencies = {1., 10., 100., 1000.};

std::string or_none(double limit) {
  if (limit == 0) return "grows at every h";
  return std::isinf(limit) ? "none" : fmt::format("{:.10g}", limit);
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
            study.piece(fmt::format("steps {} {:g} {:g}", method->name, rtol, omega), [&] {
              const ChosenSteps s = chosen_steps(*method, rtol, omega);
              Csv csv_row;
              csv_row.row(method->name, rtol, omega, name(s.outcome), s.mean_h_omega, s.rejected,
                          s.fast_energy, s.energy_error, s.counts.steps, s.counts.rejected,
                          s.counts.stability_limited_steps);
              return nlohmann::json(csv_row.text());
            });
        csv.rows(row.get<std::string>());
      }
    }
    progress().finish("steps of " + method->name + " are measured");
  }
}

}  // namespace qddot::stability_map
