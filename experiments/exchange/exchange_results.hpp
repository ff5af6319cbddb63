#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "qddot/measure/exchange/excitation.hpp"

namespace qddot::exchange {

// A run as a journal keeps it, and back.
nlohmann::json record_of(const ExchangeRun& result);
ExchangeRun run_of(const nlohmann::json& record);

// Writes runs into exchange.csv and summary.csv and prints them, each against the reference.
class Reporter {
 public:
  // Prints the head of the table. Borrows all.
  Reporter(const std::string& scene, const Excitation& excitation, const CertifiedCourse& reference,
           CsvFile& courses, CsvFile& table);
  void operator()(const std::string& method, double h, double h_omega, const ExchangeRun& result);

 private:
  double window_;
  const EnergyCourse& exact_;
  const ExchangeComparison own_;
  CsvFile &courses_, &table_;
};

}  // namespace qddot::exchange
