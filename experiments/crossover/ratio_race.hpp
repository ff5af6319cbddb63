#pragma once

#include <map>
#include <optional>
#include <vector>

#include "experiments/crossover/pruning.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"

namespace qddot::crossover {

// One ratio of stiffnesses: its scene, and what was measured on it.
struct AtRatio {
  double ratio;
  Subject subject;
  std::optional<Reference> reference{};  // none could be made
  std::vector<Point> points{};           // in the order of the registry
  std::vector<Placing> placings{};

  // As its share and the points in the journal are named.
  std::string name() const;
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

}  // namespace qddot::crossover
