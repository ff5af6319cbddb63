#pragma once

#include <string>

#include "experiments/kit/whole_file.hpp"
#include "qddot/measure/speed/chart_words.hpp"

namespace qddot::work_precision {

// Writes the record of a chart of the scene of that name.
void write_chart(WholeFile& file, const Chart& chart, const std::string& scene,
                 const StudyEnd& end);

// Makes chart.json in `folder` anew from points.csv, front.csv and reference.json of an earlier
// run. Without reference.json the bounds in points.csv say what is certified; without front.csv the
// accuracies are the usual ones. Throws InvalidInput, in a sentence that names the file, for a
// folder without points.csv and for files that work_precision does not write.
void judge(const std::string& folder);

}  // namespace qddot::work_precision
