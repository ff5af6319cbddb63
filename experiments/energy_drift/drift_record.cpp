#include "experiments/energy_drift/drift_record.hpp"

#include "experiments/kit/points.hpp"
#include "qddot/integrators/registry.hpp"

// nlohmann::json looks for these functions in the namespace of the types.
namespace qddot::inline measure {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Interval, value, low, high)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DriftPoint, t, energy, error)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrendScales, excess, frequency, rounding, step)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Trend, verdict, drift, steady_from, before, late_drift,
                                   oscillation, walk, colour, period, memory, slow_period, widening,
                                   needed, rate, damping_ratio, blow_up_time, last_error)

}  // namespace qddot::inline measure

namespace qddot::energy_drift {
namespace {

nlohmann::json record_of(const std::optional<Trend>& trend) {
  return trend ? nlohmann::json(*trend) : nullptr;
}

std::optional<Trend> trend_in(const nlohmann::json& record) {
  if (record.is_null()) return {};
  return record.get<Trend>();
}

}  // namespace

nlohmann::json record_of(const DriftRun& run) {
  return {{"method", run.method->name},
          {"value", run.value},
          {"summary", run.summary},
          {"dissipated", run.summary.work.dissipated},
          {"driven", run.summary.work.driven},
          {"seconds", run.seconds},
          {"scales", run.scales},
          {"energy", run.energy},
          {"linear", record_of(run.linear)},
          {"angular", record_of(run.angular)},
          {"path", run.path}};
}

DriftRun drift_run_of(const nlohmann::json& record) {
  DriftRun run{.method = find_method(record.at("method").get<std::string>()),
               .value = record.at("value"),
               .summary = record.at("summary"),
               .seconds = record.at("seconds"),
               .scales = record.at("scales"),
               .energy = record.at("energy"),
               .linear = trend_in(record.at("linear")),
               .angular = trend_in(record.at("angular")),
               .path = record.at("path")};
  run.summary.work = {record.at("dissipated"), record.at("driven")};
  return run;
}

}  // namespace qddot::energy_drift
