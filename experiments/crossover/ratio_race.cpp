#include "experiments/crossover/ratio_race.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "experiments/kit/point_record.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/reference_file.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/ladder_points.hpp"

namespace qddot::crossover {
namespace {

// The reference is asked for a tenth of the finest accuracy.
constexpr double needed = Pruning::accuracies.back() / 10;

}  // namespace

std::string AtRatio::name() const { return fmt::format("{:.17g}", ratio); }

void RatioRace::measure(Study& study, AtRatio& one, const std::string& folder,
                        const nlohmann::json& origin) {
  const Subject& s = one.subject;
  progress().stage(fmt::format("ratio {:g}: making the reference", one.ratio));
  try {
    one.reference = reference_for(s.drawn, s.start, s.reduced, s.until, folder, origin, needed);
    measure_methods(study, one);
  } catch (const NoReference& error) {
    say(fmt::format("crossover: ratio {:g}: {}; its cells are left empty", one.ratio,
                    error.what()));
    study.fall_short();
  }
  one.placings = placings(one.points, one.reference.value_or(Reference()));
}

void RatioRace::measure_methods(Study& study, AtRatio& one) {
  Pruning pruning(*one.reference);
  PointsOfMethods points;
  const auto gather = [&] {
    for (const auto& [method, own] : points)
      one.points.insert(one.points.end(), own.begin(), own.end());
  };
  try {
    measure_all(study, one, pruning, points);
  } catch (const Interrupted&) {
    gather();
    throw;
  }
  gather();
  std::map<const Method*, double> handicaps;
  for (const Method* method : methods_) {
    const auto own = points.find(method);
    handicaps[method] = own == points.end() ? 1 : pruning.handicap(own->second);
  }
  std::erase_if(methods_, [&](const Method* method) {
    return kind_of(*method) == Kind::explicit_steps && handicaps[method] > Pruning::too_slow;
  });
  std::ranges::stable_sort(methods_, {}, [&](const Method* method) { return handicaps[method]; });
}

void RatioRace::measure_all(Study& study, const AtRatio& one, Pruning& pruning,
                            PointsOfMethods& points) {
  std::vector<const Method*> fitting = methods_;
  std::erase_if(fitting, [&](const Method* m) { return !applies_to(*m, one.subject.system()); });
  progress().begin(fitting.size());
  for (const Method* method : fitting) {
    Effort effort = effort_;
    effort.seconds = std::min(effort.seconds, pruning.seconds_of_interest());
    effort.recall = points_of(study, one.name() + " ", fmt::format("ratio {:g}: ", one.ratio));
    std::vector<Point>& own = points[method];
    measure_ladder(
        *method, one.subject.reduced, one.subject.until, *one.reference, effort,
        [&](const Point& point) {
          pruning.take(point);
          own.push_back(point);
        },
        [&](const Point& point) { return pruning.is_over(point); });
    std::ranges::sort(own, std::ranges::greater(), &Point::value);
    progress().finish(fmt::format("ratio {:g}: {} is done", one.ratio, method->name));
  }
}

}  // namespace qddot::crossover
