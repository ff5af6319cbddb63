#pragma once

#include <string>

namespace qddot::sweep {

// How results of several processes become one.
struct Merging {
  bool per_machine = false;  // a folder for each kind of machine
  bool by_work = false;      // counts times costs on this machine in place of the times
  bool has_pictures = true;
};

// Makes of what the tasks measured, in the sweep's folder, for each scene what its program makes
// (tables, a chart, a report) in a folder of its name; and of work_precision's points.csv of all
// scenes, fastest.csv, crossovers.csv and a picture of them. missing.csv and stdout say what is not
// there, why, and which command measures it. Returns the program's status. Throws InvalidInput
// where times of unlike machines would be compared.
int merge(const std::string& folder, const Merging& how);

}  // namespace qddot::sweep
