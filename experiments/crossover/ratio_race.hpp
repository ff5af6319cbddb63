#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/crossover/pruning.hpp"
#include "experiments/kit/program.hpp"

namespace qddot::crossover {

// The scene of a ratio with rods in place of its stiff springs, and the reference of the springs in
// its unknowns. So errors of its runs are those of a method and of what the rods change.
struct WithRods {
  Model model;
  Reference reference;
  double change = 0;  // what the rods change, as a position error
};

// One ratio of stiffnesses: its scene, and what was measured on it.
struct AtRatio {
  double ratio;
  Subject subject;
  std::optional<Reference> reference{};         // none could be made
  std::shared_ptr<const WithRods> with_rods{};  // nullptr if the springs can be no rods
  std::vector<Point> points{};                  // in the order of the registry
  std::vector<Placing> placings{};

  // As its share and the points in the journal are named.
  std::string name() const { return fmt::format("{:.17g}", ratio); }
};

// The methods that compete at one ratio and the next. Those that were fast come first, and those
// that were far too slow and explicit are left out from there on.
class RatioRace {
 public:
  RatioRace(std::vector<const Method*> methods, const Effort& effort)
      : methods_(std::move(methods)), effort_(effort) {}

  // Makes the reference, kept in `folder` with `origin`, and measures the methods at that ratio. If
  // there is no reference, says so, and the study falls short. Throws Interrupted if the program is
  // to end; the points so far are then in `one`.
  void measure(Study& study, AtRatio& one, const std::string& folder, const nlohmann::json& origin);

 private:
  using PointsOfMethods = std::map<const Method*, std::vector<Point>>;

  void measure_methods(Study& study, AtRatio& one);
  void measure_all(Study& study, const AtRatio& one, Pruning& pruning, PointsOfMethods& points);

  std::vector<const Method*> methods_;
  Effort effort_;
};

// The columns of points.csv.
std::vector<std::string> point_columns_with_ratio();

// Writes what was measured at one ratio; kinds without a method among `competing` have no rows.
void tabulate(const AtRatio& one, const std::vector<const Method*>& competing, Table& winners,
              Table& of_kinds, Table& points);

// How the tables were made: the scenes and their references.
nlohmann::json origin_of(const Program& p, const std::vector<AtRatio>& all);

// Prints the fastest methods for each accuracy, with their ranges of ratios.
void print_winners(const std::vector<AtRatio>& all);

}  // namespace qddot::crossover
