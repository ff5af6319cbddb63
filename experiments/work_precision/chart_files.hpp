#pragma once

#include <string>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/measure/speed/chart.hpp"
#include "qddot/measure/speed/chart_words.hpp"

namespace qddot::work_precision {

// The columns and rows of front.csv; rows without a fastest method have empty fields.
extern const std::vector<std::string> front_columns;
void tabulate(Csv& csv, const std::string& scene, const Chart& chart);

// Prints the rows of a chart as a table for people, with a warning of small stability margins.
void print_front(const std::string& scene, const Chart& chart);

// Writes the record of a chart of the scene of that name.
void write_chart(WholeFile& file, const Chart& chart, const std::string& scene,
                 const StudyEnd& end);

// Makes chart.json in `folder` anew from points.csv, front.csv and reference.json of an earlier
// run. Without reference.json the bounds in points.csv say what is certified; without front.csv the
// accuracies are the usual ones. Throws InvalidInput, in a sentence that names the file, for a
// folder without points.csv and for files that work_precision does not write.
void judge(const std::string& folder);

}  // namespace qddot::work_precision
