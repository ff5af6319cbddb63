#pragma once

#include <limits>
#include <string>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline measure {

// The kinds of errors that a chart has, in the order in which it has them.
enum class Quantity { position, energy, momentum, modes };

// "position", "energy", "momentum" or "modes".
const char* name(Quantity quantity);

// The bounds of a true error. If the error e was measured against a reference with an error of up
// to c, they are max(e - c, 0) and e + c.
struct Known {
  double at_least = 0, at_most = 0;
};
Known known(double error, double certified);

// The error of a point in one quantity, and what is known of it. All are NaN if the run failed or
// the error was not measured.
struct Judged {
  double error = std::numeric_limits<double>::quiet_NaN();
  Known bounds{error, error};
  bool is_uncertain = false;  // whether the uncertainty is a tenth of the error or more
  // Whether the run is known to be the reference's motion. If it is not, its error bounds nothing.
  bool counts = true;
  // Whether the run may be the reference's motion, for all that is known.
  bool may_count = true;

  // Whether the error is known to be at most the accuracy, and whether it may be.
  bool is_within(double accuracy) const { return counts && bounds.at_most <= accuracy; }
  bool may_be_within(double accuracy) const { return may_count && bounds.at_least <= accuracy; }
};

// The quantity that decides accuracy: the positions at the end. If the end is beyond the horizon,
// positions are unknown; then it is the largest error of the energy during the run.
Quantity judge_of(const Reference& reference);

// The certified error of the reference in a quantity; smaller errors cannot be told from zero.
double certified(const Reference& reference, Quantity quantity);
// The same in the quantity that decides.
double certified(const Reference& reference);

// A run that hardly moves keeps its energy well. So the energy of a motion beyond the horizon
// counts only if the run's modal shares differ from the reference's by at most this many floors.
// The floor is one difference by chance. If both are normal in one variable, a right run differs by
// more with probability 2/pi atan(1/10) = 6 %.
constexpr double most_of_chance = 10;
// Whether modal shares can tell another motion from the reference's: shares differ by at most 1, so
// that no run differs by more than ten floors of a tenth. No run is known to be right then.
bool can_shares_tell(const Reference& reference);

// The error of a point in a quantity, and in the quantity that decides. This is the definition of
// the error that charts, fronts and answers use.
Judged judged(const Point& point, const Reference& reference, Quantity quantity);
Judged judged(const Point& point, const Reference& reference);

}  // namespace qddot::inline measure
