#include "experiments/energy_drift/drift_tables.hpp"

#include <cmath>
#include <limits>
#include <optional>

namespace qddot::energy_drift {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

void write_interval(Csv& csv, const Interval& interval) {
  csv.field(interval.value);
  csv.field(interval.low);
  csv.field(interval.high);
}

constexpr Interval no_interval{nothing, nothing, nothing};
Interval drift_of(const Trend& trend) {
  return trend.verdict == Verdict::unknown ? no_interval : trend.drift;
}

// Nothing where there is none.
void write_positive(Csv& csv, double value) { csv.field(value > 0 ? value : nothing); }

void write_momentum(Csv& csv, const std::optional<Trend>& trend) {
  write_interval(csv, trend ? drift_of(*trend) : no_interval);
  csv.field(trend ? trend->last_error : nothing);
}

}  // namespace

const std::vector<std::string> drift_columns = {"method",         "t",    "energy",
                                                "relative_error", "knob", "value"};
const std::vector<std::string> summary_columns = {"method",
                                                  "outcome",
                                                  "drift_rate",
                                                  "drift_rate_low",
                                                  "drift_rate_high",
                                                  "oscillation",
                                                  "verdict",
                                                  "knob",
                                                  "value",
                                                  "fate",
                                                  "t_reached",
                                                  "steps",
                                                  "energy_error_end",
                                                  "random_walk",
                                                  "late_drift",
                                                  "late_drift_low",
                                                  "late_drift_high",
                                                  "has_settled",
                                                  "exponential_rate",
                                                  "damping_ratio",
                                                  "blow_up_time",
                                                  "momentum_drift",
                                                  "momentum_drift_low",
                                                  "momentum_drift_high",
                                                  "momentum_error_end",
                                                  "angular_momentum_drift",
                                                  "angular_momentum_drift_low",
                                                  "angular_momentum_drift_high",
                                                  "angular_momentum_error_end",
                                                  "compensated",
                                                  "time_s",
                                                  "fate_so_far",
                                                  "settled_from",
                                                  "wave_period",
                                                  "memory_low",
                                                  "slow_period_low",
                                                  "widening",
                                                  "widening_low",
                                                  "widening_high",
                                                  "needed"};
const std::vector<std::string> tolerance_columns = {
    "method",     "rtol",           "periods",         "outcome",
    "drift_rate", "drift_rate_low", "drift_rate_high", "energy_error_end",
    "steps",      "time_s"};

void write_path(CsvFile& csv, const DriftRun& run) {
  for (const DriftPoint& point : run.path) {
    csv.row(run.method->name, point.t, point.energy, point.error, knob_name(run.method->knob),
            run.value);
  }
  csv.flush_if_large();
}

void write_summary(Csv& csv, const DriftRun& run, double until, bool compensated) {
  const Trend& e = run.energy;
  const bool is_known = e.verdict != Verdict::unknown;
  csv.field(run.method->name);
  csv.field(name(run.summary.outcome));
  write_interval(csv, drift_of(e));
  csv.field(is_known ? e.oscillation : nothing);
  csv.field(verdict(run, until));
  csv.field(knob_name(run.method->knob));
  csv.field(run.value);
  csv.field(verdict_name(verdict_at(run, until)));
  csv.field(run.summary.t_reached);
  csv.field(run.summary.counts.steps);
  csv.field(run.path.back().error);
  csv.field(is_known ? e.walk : nothing);
  write_interval(csv, e.rate.value != 0 || !is_known ? no_interval : e.late_drift);
  csv.field(e.steady_from > 0 ? "yes" : "no");
  csv.field(e.rate.value != 0 ? e.rate.value : nothing);
  csv.field(e.verdict == Verdict::dissipates ? e.damping_ratio : nothing);
  csv.field(e.verdict == Verdict::blows_up ? e.blow_up_time : nothing);
  write_momentum(csv, run.linear);
  write_momentum(csv, run.angular);
  csv.field(compensated && run.method->listens_to(Option::compensated) ? "yes" : "no");
  csv.field(run.seconds);
  csv.field(verdict_name(e.verdict));
  csv.field(e.steady_from);
  write_positive(csv, e.period);
  write_positive(csv, e.colour == Colour::undecided ? e.memory : 0);
  write_positive(csv, e.slow_period);
  write_interval(csv, e.widening.high > e.widening.low ? e.widening : no_interval);
  write_positive(csv, e.needed);
  csv.end_row();
}

void write_tolerance(Csv& csv, const DriftRun& run, const MotionScales& scales) {
  csv.field(run.method->name);
  csv.field(run.value);
  csv.field(run.summary.t_reached * scales.frequency / (2 * M_PI));
  csv.field(name(run.summary.outcome));
  write_interval(csv, drift_of(run.energy));
  csv.field(run.path.back().error);
  csv.field(run.summary.counts.steps);
  csv.field(run.seconds);
  csv.end_row();
}

}  // namespace qddot::energy_drift
