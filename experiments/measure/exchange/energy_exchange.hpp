#pragma once

#include <vector>

#include "qddot/model/system.hpp"

namespace qddot::measure {

// Energies of some springs over time.
struct EnergyCourse {
  std::vector<double> times{};  // [s], ascending
  std::vector<Vec> energies{};  // [J] of all springs, at each time
};

// How the energies of a course I_j(t) go from spring to spring, beside another course R_j(t). Both
// are taken as running means, so that vibrations within a window do not count.
struct ExchangeComparison {
  // The largest |I_j(t) - R_j(t)| over springs and times, in parts of sum R_j(0).
  double distance = 0;
  // With both in parts of their own sum's mean over time: the `tempo` a from 1/64 to 4 for which
  // I_j(t) is nearest to R_j(a t), and the root mean square of what is left of their difference
  // then, small where the one course is the other, played faster or slower. Compared are t up to
  // the end T, or T/a if that is less.
  double tempo = 1, misfit = 0;
  // sum I_j in parts of sum R_j(0): at the start, at the end, and the mean over time.
  double first = 1, last = 1, level = 1;
  // The largest change of an I_j since its start, in parts of `level`.
  double exchanged = 0;
};

// Means are over `window` [s], at the ends of the time over what there is of it. Both courses start
// at t = 0; what one has after the end of the other does not count. At least two times each.
ExchangeComparison compare(const EnergyCourse& course, const EnergyCourse& other, double window);

}  // namespace qddot::measure
