#include "experiments/exchange/exchange_results.hpp"

#include <limits>
#include <vector>

#include <fmt/format.h>

#include "experiments/kit/points.hpp"
#include "qddot/measure/exchange/energy_exchange.hpp"

namespace qddot::exchange {

nlohmann::json record_of(const ExchangeRun& result) {
  nlohmann::json energies = nlohmann::json::array();
  for (const Vec& e : result.course.energies) energies.push_back(std::vector(e.begin(), e.end()));
  return {{"times", result.course.times},
          {"energies", energies},
          {"summary", result.summary},
          {"sum_deviation", result.sum_deviation},
          {"energy_error", result.energy_error}};
}

ExchangeRun run_of(const nlohmann::json& record) {
  ExchangeRun result{.summary = record.at("summary"),
                     .sum_deviation = record.at("sum_deviation"),
                     .energy_error = record.at("energy_error")};
  result.course.times = record.at("times").get<std::vector<double>>();
  for (const auto& energies : record.at("energies")) {
    const auto values = energies.get<std::vector<double>>();
    result.course.energies.push_back(Vec::Map(values.data(), std::ssize(values)));
  }
  return result;
}

Reporter::Reporter(const std::string& scene, const Excitation& excitation,
                   const CertifiedCourse& reference, CsvFile& courses, CsvFile& table)
    : window_(excitation.window),
      exact_(reference.run.course),
      own_(compare(exact_, exact_, window_)),
      courses_(courses),
      table_(table) {
  fmt::print("{} to t = {:g} s: w = {:.7g} rad/s; reference certified to {:.1e} of the energy\n\n",
             scene, excitation.until, excitation.omega, reference.certified);
  fmt::print("{:<24} {:>6} {:>10} {:>10} {:>10} {:>7}  {}\n", "method", "h w", "sum I off", "H off",
             "I_j off", "tempo", "verdict");
}

void Reporter::operator()(const std::string& method, double h, double h_omega,
                          const ExchangeRun& result) {
  const auto& [times, all_energies] = result.course;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Vec& energies = all_energies[i];
    for (Index j = 0; j < energies.size(); ++j)
      courses_.row(method, h, h_omega, times[i], j, energies[j]);
    courses_.row(method, h, h_omega, times[i], "sum", energies.sum());
  }
  courses_.flush_if_large();
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const Summary& summary = result.summary;
  const bool reached = summary.outcome == Outcome::reached_end;
  const ExchangeComparison c = reached ? compare(result.course, exact_, window_)
                                       : ExchangeComparison{nothing, nothing, nothing};
  const std::string verdict = reached ? verdict_on(c, own_) : verdict_on(summary);
  table_.row(method, h, h_omega, name(summary.outcome), summary.t_reached, summary.counts.steps,
             summary.counts.force_evaluations, result.sum_deviation, result.energy_error,
             c.distance, c.tempo, c.misfit, verdict);
  fmt::print("{:<24} {:>6g} {:>10.2e} {:>10.2e} {:>10.2e} {:>7.3f}  {}\n", method, h_omega,
             result.sum_deviation, result.energy_error, c.distance, c.tempo, verdict);
}

}  // namespace qddot::exchange
