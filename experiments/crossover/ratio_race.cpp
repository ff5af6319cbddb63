#include "experiments/crossover/ratio_race.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/ranges.h>

#include "experiments/kit/points.hpp"
#include "experiments/kit/reference_file.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/speed/ladder_points.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/rods.hpp"

namespace qddot::crossover {
namespace {

// The reference is asked for a tenth of the finest accuracy.
constexpr double needed = Pruning::accuracies.back() / 10;

// The least tolerance with which the motion with rods is known, for what they change.
constexpr double fine_rtol = 1e-12;

std::shared_ptr<const WithRods> with_rods(const AtRatio& one) {
  Scene scene = one.subject.drawn;
  if (!scene.stiff_above) return nullptr;
  make_rods_above(*scene.stiff_above, scene);
  try {
    validate_rods(scene, scene.name);
  } catch (const InvalidInput&) {
    return nullptr;  // more rods than the nodes can bear
  }
  Model model(scene);
  const Method& method = *find_method("arkode_erk8_rods");
  if (!applies_to(method, model.system())) return nullptr;
  const Reference& of_springs = *one.reference;
  Reference reference = of_springs;
  reference.end = model.collect(one.subject.model.expand(of_springs.end), of_springs.end.t);
  reference.energy = model.energy(model.initial());
  State end = model.initial();
  const Summary summary =
      make_integrator(method, model.system(), options_for(method, fine_rtol, model))
          ->advance(end, one.subject.until);
  if (summary.outcome != Outcome::reached_end) return nullptr;  // rods that lock, as no spring does
  const double change =
      errors_between(model, end, reference.end, reference.energy, reference.scales).position;
  return std::make_shared<const WithRods>(WithRods{std::move(model), std::move(reference), change});
}

std::string name_of(const Point* point) { return point ? point->method->name : ""; }
double time_of(const Point* point) {
  return point ? point->time : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void RatioRace::measure(Study& study, AtRatio& one, const std::string& folder,
                        const nlohmann::json& origin) {
  const Subject& s = one.subject;
  progress().stage(fmt::format("ratio {:g}: making the reference", one.ratio));
  try {
    one.reference = reference_for(s.drawn, s.start(), s.model, s.until, folder, origin, needed);
    one.with_rods = with_rods(one);
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
  std::erase_if(fitting, [&](const Method* m) {
    return m->asks(Need::constraints) ? !one.with_rods : !applies_to(*m, one.subject.system());
  });
  progress().begin(fitting.size());
  for (const Method* method : fitting) {
    Effort effort = effort_;
    effort.seconds = std::min(effort.seconds, pruning.seconds_of_interest());
    effort.recall = points_of(study, one.name() + " ", fmt::format("ratio {:g}: ", one.ratio));
    std::vector<Point>& own = points[method];
    const bool has_rods = method->asks(Need::constraints);
    measure_ladder(
        *method, has_rods ? one.with_rods->model : one.subject.model, one.subject.until,
        has_rods ? one.with_rods->reference : *one.reference, effort,
        [&](const Point& point) { own.push_back(point); },
        [&](const Point& point) { return pruning.is_over(point); });
    std::ranges::sort(own, std::ranges::greater(), &Point::value);
    pruning.take(own);
    progress().finish(fmt::format("ratio {:g}: {} is done", one.ratio, method->name));
  }
}

std::vector<std::string> point_columns_with_ratio() {
  std::vector<std::string> columns = point_columns().header();
  columns.insert(columns.begin(), "stiffness_ratio");
  return columns;
}

void tabulate(const AtRatio& one, const std::vector<const Method*>& competing, Table& winners,
              Table& of_kinds, Table& points) {
  for (const Placing& placing : one.placings) {
    const Point *fastest = placing.fastest, *next = placing.runner_up;
    winners->row(one.ratio, placing.accuracy, name_of(fastest), time_of(fastest), name_of(next),
                 time_of(next) / time_of(fastest));
    for (const Kind kind : kinds) {
      if (std::ranges::none_of(competing, [&](auto m) { return kind_of(*m) == kind; })) continue;
      const Point* own = placing.of_kind[static_cast<std::size_t>(kind)];
      of_kinds->row(one.ratio, placing.accuracy, kind_name(kind), name_of(own), time_of(own));
    }
  }
  for (const Point& point : one.points) {
    points->field(one.ratio);
    point_columns().write_row(*points,
                              {one.subject.drawn.name, point, one.reference->certified.position});
  }
}

nlohmann::json origin_of(const Program& p, const std::vector<AtRatio>& all) {
  nlohmann::json origin = p.origin();
  origin["family"] = all.front().subject.source;
  origin["until"] = all.front().subject.until;
  for (const AtRatio& one : all) {
    const auto whole = p.origin(one.subject);
    nlohmann::json entry = {{"stiffness_ratio", one.ratio},   {"scene", whole.at("scene")},
                            {"reduced", whole.at("reduced")}, {"certified_position", nullptr},
                            {"reference_made_by", nullptr},   {"change_by_rods", nullptr}};
    if (one.with_rods) entry["change_by_rods"] = one.with_rods->change;
    if (one.reference) {
      entry["certified_position"] = one.reference->certified.position;
      entry["reference_made_by"] = one.reference->made_by;
    }
    origin["scenes"].push_back(entry);
  }
  return origin;
}

void print_winners(const std::vector<AtRatio>& all) {
  for (std::size_t row = 0; row < Pruning::accuracies.size(); ++row) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < all.size();) {
      const std::string name = name_of(all[i].placings[row].fastest);
      std::size_t last = i;
      while (last + 1 < all.size() && name_of(all[last + 1].placings[row].fastest) == name) ++last;
      const std::string what = name.empty() ? "nothing" : name;
      words.push_back(i == last
                          ? fmt::format("{} at {:g}", what, all[i].ratio)
                          : fmt::format("{} {:g} to {:g}", what, all[i].ratio, all[last].ratio));
      i = last + 1;
    }
    fmt::print("{:.0e}  {}\n", Pruning::accuracies[row], fmt::join(words, ", "));
  }
  for (const AtRatio& one : all) {
    if (!one.reference || one.reference->certified.position <= Pruning::accuracies.back()) continue;
    fmt::print(
        "at ratio {:g} the reference is certified to {:.1e}: smaller accuracies have no fastest "
        "method\n",
        one.ratio, one.reference->certified.position);
  }
}

}  // namespace qddot::crossover
