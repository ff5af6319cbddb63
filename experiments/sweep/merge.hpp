#pragma once

#include <string>

namespace qddot::sweep {

// How results of several processes become one.
struct Merging {
  bool per_machine = false;  // a folder for each kind of machine
  bool by_work = false;      // counts times costs on this machine in place of the times
  bool has_pictures = true;
};

// Makes, from the results of the tasks, for each scene a folder of its name with the outputs of the
// study's program (tables, a chart, a report). If the program is work_precision, also makes
// fastest.csv, crossovers.csv and a picture of them from the points.csv of all scenes. missing.csv
// and stdout name missing results, the reason, and the command that measures them. Returns the exit
// status. Throws InvalidInput if times of unlike machines would be compared.
int merge(const std::string& folder, const Merging& how);

}  // namespace qddot::sweep
