#pragma once

#include <limits>
#include <optional>
#include <vector>

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

  // The error at which the run counts: the upper bound of its own or of a finer run's error (see
  // judged_together).
  double counts_at = error;
  // Whether it counts at an error above one of the usual accuracies that its own error is within.
  bool is_lucky = false;

  // Whether the run counts as within the accuracy, and whether its error may be.
  bool is_within(double accuracy) const { return counts && counts_at <= accuracy; }
  bool may_be_within(double accuracy) const { return may_count && bounds.at_least <= accuracy; }
};

// The quantity that decides accuracy: the positions at the end. If the end is beyond the horizon,
// positions are unknown; then it is the largest error of the energy during the run.
Quantity judge_of(const Reference& reference);

// The certified error of the reference in a quantity; smaller errors cannot be told from zero.
double certified(const Reference& reference, Quantity quantity);
// The same in the quantity that decides.
double certified(const Reference& reference);

// The largest difference of a right run's modal shares to the reference's. A run that hardly moves
// keeps its energy well, so that the energy of a motion beyond the horizon counts only up to here.
//
// The floor f is one difference by chance. A right run differs by another one, which is independent
// and distributed alike. If the shares vary in k independent directions, normally and alike, it
// exceeds c f with a probability of 2/pi atan(1/c) for k = 1 and of 1/(1 + c^2) for k = 2, and with
// a smaller one for more. That is 6 % for k = 1 and c = 10, and for k = 2 and c = 4. No difference
// exceeds 1. So this is 10 f where that is below 1. Else it is 4 f where that is below 1 and at
// least three modes have shares. Else it is nothing: the shares cannot tell another motion from the
// reference's, and no run is known to be right.
std::optional<double> largest_difference_by_chance(const Reference& reference);

// 1e-1, 1e-2, ... 1e-9.
const std::vector<double>& usual_accuracies();

// The error of a point in a quantity, and in the quantity that decides. This is the definition of
// the error that charts, fronts and answers use. It counts at its own error.
Judged judged(const Point& point, const Reference& reference, Quantity quantity);
Judged judged(const Point& point, const Reference& reference);

// Likewise for the points of a study, where luck does not count. The error of a coarse run may be
// small by chance, as where it changes its sign between two steps. So a run counts at the largest
// error of itself and of all finer runs of its method, up to where its order shows. These errors
// are upper bounds. One is infinite if the run diverged or is another motion; a run that stopped
// for another reason tells nothing.
//
// The order p of a method shows at a run if errors fall as it says over the next two rungs. A rung
// leads to the next finer run that is expected to have at most half of the error. The expected fall
// F is the ratio of the steps to the power of p, or the ratio of the tolerances. Errors fall as
// they should if it is by a factor between F^(3/4) and F^(5/4). Then all runs down to the second
// rung count. If the order shows neither at a run nor at a finer one, all finer runs count.
std::vector<Judged> judged_together(const std::vector<Point>& points, const Reference& reference,
                                    Quantity quantity);

// Whether the finest of a method's points follows the order in the quantity that decides: it is the
// second rung of a run at which the order shows.
bool last_follows_order(const std::vector<Point>& points, const Reference& reference);

}  // namespace qddot::inline measure
