#include "experiments/exchange/exchange_record.hpp"

#include "experiments/kit/points.hpp"

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

}  // namespace qddot::exchange
