#pragma once

#include <string>
#include <vector>

#include "experiments/crossover/ratio_race.hpp"
#include "experiments/kit/program.hpp"

namespace qddot::crossover {

// Rows of crossover.csv and kinds.csv, and the columns of all tables.
struct WinnerRow {
  double ratio;
  Placing placing;
};
struct KindRow {
  double ratio, accuracy;
  Kind kind;
  const Point* fastest;
};
Columns<WinnerRow> winner_columns();
Columns<KindRow> kind_columns();
std::vector<std::string> point_columns_with_ratio();

// Writes what was measured at one ratio; kinds without a method among `competing` have no rows.
void tabulate(const AtRatio& one, const std::vector<const Method*>& competing,
              RowTable<WinnerRow>& winners, RowTable<KindRow>& of_kinds, Table& points);

// How the tables were made: the scenes and their references.
nlohmann::json origin_of(const Program& p, const std::vector<AtRatio>& all);

// Prints the fastest methods for each accuracy, with their ranges of ratios.
void print_winners(const std::vector<AtRatio>& all);

}  // namespace qddot::crossover
