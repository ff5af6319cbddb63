#pragma once

#include <string>

#include "qddot/measure/speed/chart_words.hpp"

namespace qddot::record {

// The chart as JSON, one line for each list, row and view: the contents of chart.json. `scene`:
// the scene's name as JSON text. Numbers have 17 digits; null stands for what is not known.
std::string chart_record(const Chart& chart, const std::string& scene, const StudyEnd& end = {});

// All records of charts, and nothing else, begin with this.
extern const char* const chart_beginning;

}  // namespace qddot::record
