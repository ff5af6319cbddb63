// When does an implicit method win? The study finds the fastest method for each accuracy on scenes
// with some stiff springs. These are `ratio` times as stiff as the springs that set the motion.
//
//   crossover --family frame --out results/frame
//   crossover --family chain --ratios 1,1e3,1e6 --methods verlet,ida --out results/chain
//
//  1. Each ratio has a scene and a reference (agreed_reference) that is good to
//     a tenth of the finest accuracy. It is kept in ratio_R/reference.json for the next time.
//  2. Methods are measured as in work_precision, those first that were fast at the former ratio.
//     SUNDIALS' stock variants are left out: they are slower than the same methods with the
//     structure. A ladder ends early if the method will be 20 times slower than the fastest at each
//     accuracy that it has not reached yet. An explicit method that is so slow throughout is not
//     tried at larger ratios.
//  3. points.csv has every point. crossover.csv has, for each ratio and accuracy from 1e-1 to 1e-6,
//     the fastest method and the next. kinds.csv has the fastest of each kind: explicit, implicit,
//     split (stiff springs apart from the others). Fields are empty if no method reached the
//     accuracy, or if the reference does not certify it.
//
// Expected results: the largest step of an explicit method is c / w_max, and w_max grows as
// sqrt(ratio). If that limit and not the accuracy decides, the method takes
//   t_explicit = sqrt(ratio) T w_1 / c x (time of a force),
// where w_1 is w_max at ratio 1. The steps of an implicit method follow the motion and not the
// stiffest spring: t_implicit = (steps) x (time of a step) at any ratio. Both times are equal at
//   ratio = (implicit steps x time of an implicit step / (explicit steps at ratio 1 x time of a
//   force))^2.
// If an accuracy needs n times as many implicit steps, that ratio grows by n^2, as long as explicit
// steps stay at their limit. The formula fails if vibrations of stiff springs are part of the
// motion: an implicit method then has to resolve them too.
#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/crossover/pruning.hpp"
#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/points.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/reference_file.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/ladder_points.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::crossover {
namespace {

// Scenes that are the same but for how much stiffer some springs are than what sets the motion.
struct StiffFamily {
  std::string name;
  std::string summary;
  int nodes;     // along a side or in a row, where none are asked for
  double until;  // [s], likewise: the fall is then about a third of the scene's size
  Scene (*draw)(int nodes, double until, double ratio);
};

// As the generators have them [m/s^2].
constexpr double gravity = 9.81;

Scene drawn(const char* generator, const GeneratorValues& values, const std::string& name) {
  Scene scene = generate(*find_generator(generator), values, name);
  scene.name = name;
  return scene;
}

Scene frame(int nodes, double until, double ratio) {
  constexpr double cloth = 1000;  // [N/m]
  Scene scene = drawn("framed_cloth",
                      {{"nodes", nodes},
                       {"until", until},
                       {"structural_stiffness", cloth},
                       {"frame_stiffness", cloth * ratio}},
                      "frame");
  if (ratio == 1) scene.stiff_above.reset();
  return scene;
}

Scene whole(int nodes, double until, double ratio) {
  constexpr double mass = 0.5, side = 1;  // [kg], [m]
  const double k = ratio * mass * gravity / side;
  return drawn("cloth",
               {{"nodes", nodes},
                {"until", until},
                {"mass", mass},
                {"side", side},
                {"structural_stiffness", k},
                {"shear_stiffness", k / 2},
                {"bending_stiffness", k / 10}},
               "whole");
}

Scene chain(int nodes, double until, double ratio) {
  constexpr double mass = 1, length = 1;  // [kg], [m]
  const double soft = 1000 * (nodes - 1) * mass * gravity / length;
  Scene scene = drawn(
      "chain",
      {{"nodes", nodes}, {"until", until}, {"mass", mass}, {"length", length}, {"stiffness", soft}},
      "chain");
  const std::size_t count = scene.springs.size();
  for (std::size_t i = count / 3; i < count - count / 3; ++i) {
    scene.springs[i].law.stiffness = soft * ratio;
  }
  if (ratio > 1) scene.stiff_above = soft + 0.5 * (soft * ratio - soft);
  return scene;
}

//   frame  framed_cloth, its frame `ratio` times as stiff as its cloth;
//   whole  cloth, all of it stiff against its weight: k = ratio m g / L between neighbours, so that
//          its weight stretches it by about 1 / ratio of its size;
//   chain  chain on one pinned end, the springs of its middle third `ratio` times as stiff as the
//          others, of which k_soft = 1000 N m g / L for N springs.
// frame and chain name their stiff springs where ratio > 1. All else is as the generators have it.
const std::vector<StiffFamily>& stiff_families() {
  static const std::vector<StiffFamily> all = {
      {"frame", "a soft cloth in a stiff frame", 12, 0.25, frame},
      {"whole", "a cloth that is stiff against its weight", 12, 0.25, whole},
      {"chain", "a chain with a stiff middle third", 30, 0.25, chain}};
  return all;
}

// The reference is asked for a tenth of the finest accuracy.
constexpr double needed = Pruning::accuracies.back() / 10;

// One ratio of stiffnesses: its scene, and what was measured on it.
struct AtRatio {
  double ratio;
  Subject subject;
  std::optional<Reference> reference{};  // none could be made
  std::vector<Point> points{};           // in the order of the registry
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

std::string name_of(const Point* point) { return point ? point->method->name : ""; }
double time_of(const Point* point) {
  return point ? point->time : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> point_columns_with_ratio() {
  std::vector<std::string> columns = point_columns().header();
  columns.insert(columns.begin(), "stiffness_ratio");
  return columns;
}

// Writes what was measured at one ratio; kinds without a method among `competing` have no rows.
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

// How the tables were made: the scenes and their references.
nlohmann::json origin_of(const Program& p, const std::vector<AtRatio>& all) {
  nlohmann::json origin = p.origin();
  origin["family"] = all.front().subject.source;
  origin["until"] = all.front().subject.until;
  for (const AtRatio& one : all) {
    const auto whole = p.origin(one.subject);
    nlohmann::json entry = {{"stiffness_ratio", one.ratio},
                            {"scene", whole.at("scene")},
                            {"reduced", whole.at("reduced")},
                            {"certified_position", nullptr},
                            {"reference_made_by", nullptr}};
    if (one.reference) {
      entry["certified_position"] = one.reference->certified.position;
      entry["reference_made_by"] = one.reference->made_by;
    }
    origin["scenes"].push_back(entry);
  }
  return origin;
}

// Prints the fastest methods for each accuracy, with their ranges of ratios.
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

constexpr double largest_ratio = 1e9;  // beyond it rounding of stiff forces is felt

void require_ratio(double ratio, const std::string& option) {
  if (ratio >= 1 && ratio <= largest_ratio) return;
  throw InvalidInput(fmt::format("{}: {} is not allowed; it is a number from 1 to {:g}", option,
                                 ratio, largest_ratio));
}

// All methods but the stock ones, or those of the list. If springs are named stiff at any ratio,
// they are at the largest.
std::vector<const Method*> competitors(const std::vector<std::string>& list,
                                       const Subject& stiffest) {
  auto selected = select_methods(list, stiffest);
  if (list.empty())
    std::erase_if(selected, [](const Method* method) { return !method->stock_of.empty(); });
  return selected;
}

}  // namespace
}  // namespace qddot::crossover

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::crossover;
  Program p({.name = "crossover",
             .summary = "Measures from which stiffness on an implicit method is the fastest.",
             .has_threads = true,
             .has_resume = true,
             .has_shares = true});
  std::vector<std::string> families;
  for (const StiffFamily& f : stiff_families())
    families.push_back(fmt::format("{} ({})", f.name, f.summary));
  auto name = p.word("--family", "frame", fmt::format("{}", fmt::join(families, ", "))).last();
  auto nodes =
      p.whole("--nodes",
              "number of nodes along a side of the cloth, or in the chain (default: 12 or 30)")
          .last()
          .within(4, 1000);
  auto until =
      p.until("the time to run to in s (default: 0.25)").last().positive("the time to run to in s");
  auto ratios = p.numbers("--ratios", {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8},
                          "a,b,...: stiffness ratios, how many times stiffer the stiff springs are")
                    .check_each(require_ratio)
                    .check(require_each_once<double>);
  auto list = p.methods("a,b,...: the methods (default: all but the stock ways of SUNDIALS, _klu)");
  auto effort = p.effort({.seconds = 5, .repeats = 3});
  auto& winners = p.table(
      "crossover.csv", {"stiffness_ratio", "accuracy", "method", "time_s", "runner_up", "margin"});
  auto& of_kinds =
      p.table("kinds.csv", {"stiffness_ratio", "accuracy", "kind", "method", "time_s"});
  auto& points = p.table("points.csv", point_columns_with_ratio());
  return p.run(argc, argv, [&] {
    const StiffFamily& family =
        named(name, stiff_families(), &StiffFamily::name, "--family", "a family");
    std::vector<double> ascending = ratios;
    std::ranges::sort(ascending);
    std::vector<AtRatio> all;
    Shares shares{.chosen_by = {"--ratios"}};
    for (const double ratio : ascending) {
      const double end = until.is_given() ? *until : family.until;
      Scene drawn = family.draw(nodes.is_given() ? *nodes : family.nodes, end, ratio);
      all.push_back({.ratio = ratio, .subject = {*name, drawn, drawn, ReducedScene(drawn), end}});
      shares.names.push_back(all.back().name());
    }
    const auto methods = competitors(list, all.back().subject);
    const nlohmann::json about = {{"family", *name},
                                  {"until", all.front().subject.until},
                                  {"nodes", all.front().subject.drawn.nodes.size()}};
    std::ptrdiff_t complete = 0;
    return p.study(
        about, shares,
        [&](Study& study) {
          std::erase_if(all, [&](const AtRatio& one) { return !study.takes(one.name()); });
          RatioRace race(methods, effort);
          for (AtRatio& one : all) {
            if (study.is_divided()) race = RatioRace(methods, effort);
            const std::string folder = fmt::format("{}/ratio_{:.9g}", p.folder(), one.ratio);
            require_folder(folder);
            race.measure(study, one, folder, p.origin(one.subject));
            ++complete;
          }
        },
        [&] {
          for (const AtRatio& one : all) tabulate(one, methods, winners, of_kinds, points);
          const nlohmann::json origin = origin_of(p, all);
          // A ratio that is not measured yet has no winner.
          all.erase(all.begin() + complete, all.end());
          print_winners(all);
          return origin;
        });
  });
}
