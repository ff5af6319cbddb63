#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "experiments/advice/drawn_case.hpp"
#include "experiments/kit/csv.hpp"
#include "qddot/measure/advice/solve.hpp"

namespace qddot::judged_advice {

// The worth of an answer on one case.
struct CaseResult {
  std::string name{}, kind{};
  double unknowns = 0, springs = 0, until = 0, accuracy = 0;
  // Why nothing can be said of the case: it has no reference that is good enough. Empty otherwise.
  std::string left_out{};
  bool is_claimed = false;  // solve() says that the accuracy was reached
  std::string method{}, kind_of_estimate{}, why{};
  double value = 0, error_estimate = 0, error = 0, certified = 0;
  std::string best_method{};  // in hindsight; empty where no run reached the accuracy
  double best_value = 0, best_seconds = 0;
  double run_seconds = 0;    // of the run that was chosen, timed as the best is
  double total_seconds = 0;  // of solve(), everything included
  double runs = 0;
  std::string advised{};  // by advise()
  double advised_value = 0;
  double advised_error = 0, advised_seconds = 0, advice_seconds = 0;  // as advise() expects them
  double advised_true_error = 0;                                      // measured

  // Whether an error was measured, and told from zero.
  bool is_judged() const { return left_out.empty() && is_claimed; }
  bool is_advised() const { return left_out.empty() && !advised.empty(); }
  bool has_error() const { return is_judged() && certified <= 0.1 * error; }
  bool has_best() const { return left_out.empty() && !best_method.empty(); }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CaseResult, name, kind, unknowns, springs, until, accuracy,
                                   left_out, is_claimed, method, kind_of_estimate, why, value,
                                   error_estimate, error, certified, best_method, best_value,
                                   best_seconds, run_seconds, total_seconds, runs, advised,
                                   advised_value, advised_error, advised_seconds, advice_seconds,
                                   advised_true_error)

// Asks for the motion of the case and for advice, and then measures both. The error is that against
// a reference of about `reference_seconds`. The time is compared with the fastest run of all
// methods; each time is the median of `repeats`.
CaseResult result_of(const Case& drawn, double reference_seconds, int repeats);

// The columns of cases.csv.
const Columns<CaseResult>& case_columns();

}  // namespace qddot::judged_advice
