#pragma once

#include <string>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "qddot/measure/exchange/excitation.hpp"

namespace qddot::exchange {

inline const std::vector<std::string> course_columns = {"method", "h",      "h_omega",
                                                        "t",      "spring", "energy"};
inline const std::vector<std::string> summary_columns = {"method",
                                                         "h",
                                                         "h_omega",
                                                         "outcome",
                                                         "t_reached",
                                                         "steps",
                                                         "force_evaluations",
                                                         "sum_deviation",
                                                         "energy_error",
                                                         "exchange_error",
                                                         "tempo",
                                                         "misfit",
                                                         "verdict"};

// Writes runs into exchange.csv and summary.csv and prints them, each against the reference.
class Reporter {
 public:
  // Prints the head of the table. Borrows all.
  Reporter(const std::string& scene, const Excitation& excitation, const CertifiedCourse& reference,
           CsvFile& courses, CsvFile& table);
  void operator()(const std::string& method, double h, double h_omega, const ExchangeRun& result);

 private:
  const Excitation& excitation_;
  const EnergyCourse& exact_;
  const ExchangeComparison own_;
  CsvFile &courses_, &table_;
};

}  // namespace qddot::exchange
