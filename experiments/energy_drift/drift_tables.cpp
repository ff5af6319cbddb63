#include "experiments/energy_drift/drift_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "qddot/algebra/straight_line.hpp"

namespace qddot::energy_drift {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr Interval no_interval{nothing, nothing, nothing};

bool is_known(const DriftRun& run) { return run.energy.verdict != Verdict::unknown; }

Interval drift_of(const Trend& trend) {
  return trend.verdict == Verdict::unknown ? no_interval : trend.drift;
}

double if_positive(double value) { return value > 0 ? value : nothing; }

std::string_view yes_or_no(bool is) { return is ? "yes" : "no"; }

// NAME, NAME_low and NAME_high of interval_of(run).
template <class Row, class IntervalOf>
Columns<Row> interval(const std::string& name, const IntervalOf& interval_of) {
  return {{name, [=](const Row& row) { return interval_of(row.run).value; }},
          {name + "_low", [=](const Row& row) { return interval_of(row.run).low; }},
          {name + "_high", [=](const Row& row) { return interval_of(row.run).high; }}};
}

Interval energy_drift(const DriftRun& run) { return drift_of(run.energy); }
Interval late_drift(const DriftRun& run) {
  return run.energy.rate.value != 0 || !is_known(run) ? no_interval : run.energy.late_drift;
}
Interval widening(const DriftRun& run) {
  const Interval& widening = run.energy.widening;
  return widening.high > widening.low ? widening : no_interval;
}

// NAME_drift with its interval and NAME_error_end, of a trend that may not be there.
Columns<SummaryRow> momentum(const std::string& name, std::optional<Trend> DriftRun::*trend) {
  auto columns = interval<SummaryRow>(name + "_drift", [=](const DriftRun& run) {
    return run.*trend ? drift_of(*(run.*trend)) : no_interval;
  });
  columns += {{name + "_error_end", [=](const SummaryRow& row) {
                 return row.run.*trend ? (row.run.*trend)->last_error : nothing;
               }}};
  return columns;
}

// Values of columns that more than one table has.
const auto method_name = [](const auto& row) { return row.run.method->name; };
const auto knob = [](const auto& row) { return knob_name(row.run.method->knob); };
const auto value = [](const auto& row) { return row.run.value; };
const auto outcome = [](const auto& row) { return name(row.run.summary.outcome); };
const auto error_end = [](const auto& row) { return row.run.path.back().error; };
const auto steps = [](const auto& row) { return row.run.summary.counts.steps; };
const auto seconds = [](const auto& row) { return row.run.seconds; };

// The root mean square of the errors from 0.9 t to t.
double error_near(const DriftRun& run, double t) {
  double sum = 0;
  int count = 0;
  for (const DriftPoint& point : run.path) {
    if (point.t < 0.9 * t || point.t > t) continue;
    sum += point.error * point.error;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

// The slope of ln error over ln rtol, of the errors at the time that all runs reached; none where
// there are fewer than two.
std::optional<double> tolerance_exponent(const std::vector<const DriftRun*>& runs, double& t) {
  t = INFINITY;
  for (const DriftRun* run : runs) t = std::min(t, run->path.back().t);
  std::vector<double> x, y;
  for (const DriftRun* run : runs) {
    const double error = error_near(*run, t);
    if (!(error > 0)) continue;
    x.push_back(std::log(run->value));
    y.push_back(std::log(error));
  }
  const StraightLine line = straight_line(x, y);
  if (!(line.spread > 0)) return {};
  return line.slope;
}

}  // namespace

Columns<PathPoint> path_columns() {
  using Row = PathPoint;
  return {{"method", method_name},
          {"t", [](const Row& row) { return row.point.t; }},
          {"energy", [](const Row& row) { return row.point.energy; }},
          {"relative_error", [](const Row& row) { return row.point.error; }},
          {"knob", knob},
          {"value", value}};
}

Columns<SummaryRow> summary_columns() {
  using Row = SummaryRow;
  Columns<Row> all = {{"method", method_name}, {"outcome", outcome}};
  all += interval<Row>("drift_rate", energy_drift);
  all += {{"oscillation",
           [](const Row& row) { return is_known(row.run) ? row.run.energy.oscillation : nothing; }},
          {"verdict", [](const Row& row) { return verdict(row.run, row.until); }},
          {"knob", knob},
          {"value", value},
          {"fate", [](const Row& row) { return verdict_name(verdict_at(row.run, row.until)); }},
          {"t_reached", [](const Row& row) { return row.run.summary.t_reached; }},
          {"steps", steps},
          {"energy_error_end", error_end},
          {"random_walk",
           [](const Row& row) { return is_known(row.run) ? row.run.energy.walk : nothing; }}};
  all += interval<Row>("late_drift", late_drift);
  all += {{"has_settled", [](const Row& row) { return yes_or_no(row.run.energy.steady_from > 0); }},
          {"exponential_rate",
           [](const Row& row) {
             const double rate = row.run.energy.rate.value;
             return rate != 0 ? rate : nothing;
           }},
          {"damping_ratio",
           [](const Row& row) {
             const Trend& energy = row.run.energy;
             return energy.verdict == Verdict::dissipates ? energy.damping_ratio : nothing;
           }},
          {"blow_up_time", [](const Row& row) {
             const Trend& energy = row.run.energy;
             return energy.verdict == Verdict::blows_up ? energy.blow_up_time : nothing;
           }}};
  all += momentum("momentum", &DriftRun::linear);
  all += momentum("angular_momentum", &DriftRun::angular);
  all +=
      {{"compensated",
        [](const Row& row) {
          return yes_or_no(row.compensated && row.run.method->listens_to(Option::compensated));
        }},
       {"time_s", seconds},
       {"fate_so_far", [](const Row& row) { return verdict_name(row.run.energy.verdict); }},
       {"settled_from", [](const Row& row) { return row.run.energy.steady_from; }},
       {"wave_period", [](const Row& row) { return if_positive(row.run.energy.period); }},
       {"memory_low",
        [](const Row& row) {
          const Trend& energy = row.run.energy;
          return energy.colour == Colour::undecided ? if_positive(energy.memory) : nothing;
        }},
       {"slow_period_low", [](const Row& row) { return if_positive(row.run.energy.slow_period); }}};
  all += interval<Row>("widening", widening);
  all +=
      {{"needed", [](const Row& row) { return if_positive(row.run.energy.needed); }},
       {"dissipated", [](const Row& row) { return if_positive(row.run.summary.work.dissipated); }},
       {"driven", [](const Row& row) {
          const double given = row.run.summary.work.driven;
          return given != 0 ? given : nothing;
        }}};
  return all;
}

Columns<ToleranceRow> tolerance_columns() {
  using Row = ToleranceRow;
  Columns<Row> all = {{"method", method_name},
                      {"rtol", value},
                      {"periods",
                       [](const Row& row) {
                         return row.run.summary.t_reached * row.scales.frequency / (2 * M_PI);
                       }},
                      {"outcome", outcome}};
  all += interval<Row>("drift_rate", energy_drift);
  all += {{"energy_error_end", error_end}, {"steps", steps}, {"time_s", seconds}};
  return all;
}

void print_verdicts(const std::vector<DriftRun>& runs, double until) {
  for (const DriftRun& run : runs) {
    const bool fixed = run.method->knob == Knob::step_size;
    const std::string who =
        fixed ? run.method->name : fmt::format("{} {:g}", run.method->name, run.value);
    const double taken = run.summary.work.dissipated, given = run.summary.work.driven;
    fmt::print("{:<30} {}{}{}\n", who, verdict(run, until),
               taken > 0 ? fmt::format("; damping took {:.4g} J beside that", taken) : "",
               given != 0 ? fmt::format("; driving gave {:.4g} J beside that", given) : "");
  }
}

void print_tolerances(const std::vector<DriftRun>& runs, const MotionScales& scales) {
  std::map<std::string, std::vector<const DriftRun*>> adaptive;
  std::vector<std::string> order;
  for (const DriftRun& run : runs) {
    if (run.method->knob != Knob::rtol) continue;
    auto& own = adaptive[run.method->name];
    if (own.empty()) order.push_back(run.method->name);
    own.push_back(&run);
  }
  for (const std::string& method : order) {
    double t = 0;
    if (const auto exponent = tolerance_exponent(adaptive[method], t)) {
      fmt::print("{:<30} the energy error goes as rtol^{:.2f}, over {:.3g} periods\n", method,
                 *exponent, t * scales.frequency / (2 * M_PI));
    }
  }
}

}  // namespace qddot::energy_drift
