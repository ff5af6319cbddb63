#pragma once

#include <nlohmann/json.hpp>

#include "qddot/measure/exchange/excitation.hpp"

namespace qddot::exchange {

// A run as a journal keeps it, and back.
nlohmann::json record_of(const ExchangeRun& result);
ExchangeRun run_of(const nlohmann::json& record);

}  // namespace qddot::exchange
