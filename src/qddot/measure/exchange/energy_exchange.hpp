#pragma once

#include <string>
#include <vector>

#include "qddot/integrators/integrator.hpp"
#include "qddot/model/system.hpp"

namespace qddot::inline measure {

// Energies of some springs over time.
struct EnergyCourse {
  std::vector<double> times{};  // [s], ascending
  std::vector<Vec> energies{};  // [J] of all springs, at each time
};

// Compares the exchange of energy between springs in a course I_j(t) and in another course R_j(t),
// j the spring. Both are running means, which remove vibrations shorter than a window.
struct ExchangeComparison {
  // The largest |I_j(t) - R_j(t)| over springs and times, over sum R_j(0).
  double distance = 0;
  // `tempo` is the factor a from 1/64 to 4 for which I_j(t) is nearest to R_j(a t); `misfit` is the
  // root mean square of their difference for that a. Both courses are divided by the time mean of
  // their own sum first. A small misfit says that one course is the other at another speed. The
  // comparison is up to the end T, or to T/a if that is less.
  double tempo = 1, misfit = 0;
  // The ratio of sum I_j to sum R_j(0): at the start, at the end, and the mean over time.
  double first = 1, last = 1, level = 1;
  // The largest change of an I_j since its start, over `level`.
  double exchanged = 0;
};

// Running means are over `window` [s], cut off at both ends of the time. Both courses start at t =
// 0, and times after the end of the shorter one do not count. Each has at least two times.
ExchangeComparison compare(const EnergyCourse& course, const EnergyCourse& other, double window);

// The verdict on a run of `exchange` that did not reach its end: its outcome and when.
std::string verdict_on(const Summary& summary);

// The verdict on a course against the reference's. Its springs exchange energy as they should, too
// fast, too slowly or not at all, or they lose or gain energy. `reference`: the reference compared
// with itself.
std::string verdict_on(const ExchangeComparison& c, const ExchangeComparison& reference);

}  // namespace qddot::inline measure
