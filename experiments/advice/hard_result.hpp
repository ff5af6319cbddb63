#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/advice/judged_motion.hpp"
#include "experiments/kit/csv.hpp"

namespace qddot::judged_advice {

// The worth of an answer on one hard case.
struct HardResult {
  double number = 0;
  std::string name{}, kind{}, of{};
  double unknowns = 0, until = 0, accuracy = 0;
  // Why nothing can be said of the case: no true motion was found. Empty otherwise.
  std::string left_out{};
  bool is_claimed = false;  // solve() says that the accuracy was reached
  std::string method{}, kind_of_estimate{}, why{};
  double value = 0, error_estimate = 0, error = 0;
  // The effect of one rounding of the start and of the tolerance of the true motion: the distance
  // of two true motions.
  double conditioning = 0;
  double fine_error = 0;  // of dprkn12 at its finest tolerance
  double runs = 0, seconds = 0, truth_seconds = 0;
  std::string advised{};  // by advise()
  double advised_value = 0, advised_error = 0, advice_seconds = 0;

  bool has_truth() const { return left_out.empty(); }
  // Whether rounding leaves the accuracy possible.
  bool is_well_posed() const { return has_truth() && conditioning <= well_posed * accuracy; }
  // Whether rounding makes the accuracy impossible, three times over.
  bool is_beyond_rounding() const {
    return has_truth() && of != "energy" && conditioning > 3 * accuracy;
  }
  bool is_judged() const { return is_well_posed() && is_claimed; }
  // The uncertainty of the true motion is counted in favour of the answer.
  bool is_within(double bound) const { return error - conditioning <= bound; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HardResult, number, name, kind, of, unknowns, until, accuracy,
                                   left_out, is_claimed, method, kind_of_estimate, why, value,
                                   error_estimate, error, conditioning, fine_error, runs, seconds,
                                   truth_seconds, advised, advised_value, advised_error,
                                   advice_seconds)

// Asks for the motion of the case and for advice, and measures both against the true motion: that
// of all nodes as drawn, by extrapolation in extended precision (PlainMotion).
HardResult result_of(const HardCase& hard);

// The columns of hard.csv.
const Columns<HardResult>& hard_columns();

}  // namespace qddot::judged_advice
