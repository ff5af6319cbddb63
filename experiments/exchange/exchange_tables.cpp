#include "experiments/exchange/exchange_tables.hpp"

#include <limits>

#include <fmt/format.h>

#include "qddot/measure/exchange/energy_exchange.hpp"

namespace qddot::exchange {
namespace {

void write_course(CsvFile& csv, const std::string& method, double h, double h_omega,
                  const EnergyCourse& course) {
  for (std::size_t i = 0; i < course.times.size(); ++i) {
    const Vec& energies = course.energies[i];
    for (Index j = 0; j < energies.size(); ++j)
      csv.row(method, h, h_omega, course.times[i], j, energies[j]);
    csv.row(method, h, h_omega, course.times[i], "sum", energies.sum());
  }
  csv.flush_if_large();
}

}  // namespace

Reporter::Reporter(const std::string& scene, const Excitation& excitation,
                   const CertifiedCourse& reference, CsvFile& courses, CsvFile& table)
    : excitation_(excitation),
      exact_(reference.run.course),
      own_(compare(exact_, exact_, excitation.window)),
      courses_(courses),
      table_(table) {
  fmt::print("{} to t = {:g} s: w = {:.7g} rad/s; reference certified to {:.1e} of the energy\n\n",
             scene, excitation.until, excitation.omega, reference.certified);
  fmt::print("{:<24} {:>6} {:>10} {:>10} {:>10} {:>7}  {}\n", "method", "h w", "sum I off", "H off",
             "I_j off", "tempo", "verdict");
}

void Reporter::operator()(const std::string& method, double h, double h_omega,
                          const ExchangeRun& result) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const bool reached = result.summary.outcome == Outcome::reached_end;
  ExchangeComparison c{.distance = nothing, .tempo = nothing, .misfit = nothing};
  if (reached) c = compare(result.course, exact_, excitation_.window);
  const std::string verdict = reached ? verdict_on(c, own_) : verdict_on(result.summary);
  write_course(courses_, method, h, h_omega, result.course);
  table_.row(method, h, h_omega, name(result.summary.outcome), result.summary.t_reached,
             result.summary.counts.steps, result.summary.counts.force_evaluations,
             result.sum_deviation, result.energy_error, c.distance, c.tempo, c.misfit, verdict);
  fmt::print("{:<24} {:>6g} {:>10.2e} {:>10.2e} {:>10.2e} {:>7.3f}  {}\n", method, h_omega,
             result.sum_deviation, result.energy_error, c.distance, c.tempo, verdict);
}

}  // namespace qddot::exchange
