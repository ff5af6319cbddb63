#pragma once

#include <string>
#include <vector>

#include "qddot/measure/speed/chart.hpp"

namespace qddot::inline measure {

// A number in few characters: 2e-3, 0.5, 3.3e-14.
std::string number_in_words(double value);
// A knob with its value to four digits, by which values are told apart: "h = 5.917e-4 s", "rtol =
// 1e-6". Halves go up.
std::string knob_in_words(const Method& method, double value);
// A time [s] with its unit: "20 µs", "4.2 ms".
std::string time_in_words(double seconds);

// Why a point is not drawn over an error, in a few words; empty if it is.
std::string failure_in_words(const Point& point, const Judged& judged);

// Why no point is known to have reached the accuracy of a row.
std::string why_empty(const FrontRow& row, const Reference& reference);

// A point whose step is nearer to its limit than this is warned of.
constexpr double small_margin = 0.15;
// "3.2 % below its limit of stability", or "above".
std::string margin_in_words(double stability_margin);
// The warnings on the fastest point of a row, in clauses.
std::vector<std::string> warnings(const FrontRow& row, const Reference& reference);

// A sentence of two lines if the times of many points vary between runs; else empty.
std::string disturbance_in_words(const Chart& chart);

// The words on a view's floor; empty if it has none.
std::string floor_in_words(const ChartView& view);

// How a study ended, as far as its reader must know.
struct StudyEnd {
  std::string interrupted_by{};    // empty if it is complete
  bool are_times_of_work = false;  // counts times costs, which nobody measured
};
// The warnings on a study and its motion, for a reader of its errors: sentences of two lines.
std::vector<std::string> caveats(const Reference& reference, const StudyEnd& end = {});

}  // namespace qddot::inline measure
