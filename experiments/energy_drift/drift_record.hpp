#pragma once

#include <nlohmann/json.hpp>

#include "qddot/measure/trend/drift_run.hpp"

namespace qddot::energy_drift {

// A run of energy_drift as a journal keeps it, with all that tables and verdicts are made of, and
// back. drift_run_of throws nlohmann::json::exception for anything else.
nlohmann::json record_of(const DriftRun& run);
DriftRun drift_run_of(const nlohmann::json& record);

}  // namespace qddot::energy_drift
