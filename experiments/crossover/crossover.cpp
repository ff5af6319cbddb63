// When does an implicit method win? The study finds the fastest method for each accuracy on scenes
// with some stiff springs. These are `ratio` times as stiff as the springs that set the motion.
//
//   crossover --family frame --out results/frame
//   crossover --family chain --ratios 1,1e3,1e6 --methods verlet,ida --out results/chain
//
//  1. Each ratio has a scene (stiff_scenes.hpp) and a reference (agreed_reference) that is good to
//     a tenth of the finest accuracy. It is kept in ratio_R/reference.json for the next time.
//  2. Methods are swept as in work_precision, those first that were fast at the former ratio.
//     SUNDIALS' stock variants are left out: they are slower than the same methods with the
//     structure. A sweep ends early if the method will be 20 times slower than the fastest at each
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
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/crossover/pruning.hpp"
#include "experiments/crossover/stiff_scenes.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/point_record.hpp"
#include "experiments/kit/point_table.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/kit/sweep_progress.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/speed/ladder_points.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::crossover {
namespace {

constexpr double largest_ratio = 1e9;  // beyond it rounding of stiff forces is felt
constexpr int least_nodes = 4, most_nodes = 1000;
// What the reference is asked for: a tenth of the finest accuracy.
constexpr double needed = Pruning::accuracies.back() / 10;

struct Arguments {
  std::string family = "frame";
  int nodes = 0;
  double until = 0;
  std::vector<double> ratios = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8};
  std::vector<std::string> methods;
  Effort effort{.seconds = 5, .repeats = 3};
  std::string out;
};

void declare(CommandLine& line, Arguments& a) {
  std::vector<std::string> families;
  for (const StiffFamily& f : stiff_families()) {
    families.push_back(fmt::format("{} ({})", f.name, f.summary));
  }
  line.add_option("--family", a.family, fmt::format("{}", fmt::join(families, ", ")))
      .take_last()
      .capture_default_str();
  line.add_option("--nodes", a.nodes,
                  "number of nodes along a side of the cloth, or in the chain (default: 12 or 30)")
      .take_last();
  line.add_option("--until", a.until, "the time to run to in s (default: 0.25)").take_last();
  line.add_option("--ratios", a.ratios,
                  "a,b,...: stiffness ratios, how many times stiffer the stiff springs are")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--methods", a.methods,
                  "a,b,...: the methods (default: all but the stock ways of SUNDIALS, _klu)")
      .delimiter(',');
  line.add_option("--repeats", a.effort.repeats, "timed runs of each point")
      .take_last()
      .capture_default_str();
  line.add_option("--point-limit", a.effort.seconds,
                  "seconds that one run of a point may take; slower ones become over_budget")
      .take_last()
      .capture_default_str();
  line.add_option("--out", a.out, "the folder for crossover.csv, kinds.csv and points.csv")
      .take_last();
}

void require_ratios(std::vector<double>& ratios) {
  for (const double ratio : ratios) {
    if (ratio >= 1 && ratio <= largest_ratio) continue;
    throw InvalidInput(fmt::format("--ratios: {} is not allowed; it is a number from 1 to {:g}",
                                   ratio, largest_ratio));
  }
  std::ranges::sort(ratios);
  const auto twice = std::ranges::adjacent_find(ratios);
  if (twice != ratios.end()) {
    throw InvalidInput(fmt::format("--ratios: {} is named twice; allowed is once", *twice));
  }
}

// One ratio: its scene, and what was measured on it.
struct RatioStudy {
  double ratio;
  Scene drawn;
  std::unique_ptr<ReducedScene> scene;
  std::optional<Reference> reference{};  // none could be made
  std::vector<Point> points{};
  std::vector<Placing> placings{};
  bool is_last = false;
};

std::vector<RatioStudy> ratio_studies(const Arguments& a, const StiffFamily& family, double until) {
  const int nodes = a.nodes > 0 ? a.nodes : family.nodes;
  std::vector<RatioStudy> all;
  for (const double ratio : a.ratios) {
    RatioStudy one{.ratio = ratio, .drawn = family.draw(nodes, until, ratio), .scene = nullptr};
    one.scene = std::make_unique<ReducedScene>(one.drawn);
    all.push_back(std::move(one));
  }
  all.back().is_last = true;
  return all;
}

// If springs are named stiff at any ratio, they are at the largest.
std::vector<const Method*> competitors(const Arguments& a, const RatioStudy& stiffest) {
  auto selected = select_methods(a.methods, *stiffest.scene, a.family);
  if (a.methods.empty()) {
    std::erase_if(selected, [](const Method* method) { return !method->stock_of.empty(); });
  }
  return selected;
}

std::vector<Kind> kinds_of(const std::vector<const Method*>& methods) {
  std::vector<Kind> all;
  for (const Kind kind : kinds) {
    const auto is_one = [&](const Method* method) { return kind_of(*method) == kind; };
    if (std::ranges::any_of(methods, is_one)) all.push_back(kind);
  }
  return all;
}

// Measures the methods at one ratio and at the next: what is learnt at one serves at the next.
class Sweeps {
 public:
  Sweeps(std::vector<const Method*> methods, const Effort& effort)
      : methods_(std::move(methods)), effort_(effort) {}

  // Throws Interrupted where the program is to end; the points so far are then in `one`.
  void measure(Study& study, RatioStudy& one, double until) {
    Pruning pruning(*one.reference);
    std::map<const Method*, std::vector<Point>> points;
    try {
      sweep_all(study, one, until, pruning, points);
    } catch (const Interrupted&) {
      gather(points, one);
      throw;
    }
    gather(points, one);
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

 private:
  void sweep_all(Study& study, const RatioStudy& one, double until, Pruning& pruning,
                 std::map<const Method*, std::vector<Point>>& points) {
    std::vector<const Method*> fitting = methods_;
    std::erase_if(fitting, [&](const Method* m) { return !applies_to(*m, one.scene->system()); });
    // Nobody knows how long ratios take whose references are still to be made.
    std::optional<SweepBound> bound;
    if (one.is_last) bound.emplace(*one.scene, until, effort_);
    SweepProgress shown(fitting, std::move(bound), fmt::format("ratio {:g}: ", one.ratio));
    for (const Method* method : fitting) {
      Effort effort = effort_;
      effort.seconds = std::min(effort.seconds, pruning.seconds_of_interest());
      effort.recall = shown.seen(points_of(study, fmt::format("{:.17g} ", one.ratio)));
      std::vector<Point>& own = points[method];
      measure_ladder(
          *method, *one.scene, until, *one.reference, effort,
          [&](const Point& point) {
            pruning.take(point);
            own.push_back(point);
            shown.take(point);
          },
          [&](const Point& point) { return pruning.is_over(point); });
      std::ranges::sort(own, std::ranges::greater(), &Point::value);
      shown.finish();
    }
  }

  // Into the order of the registry, as the map has it.
  static void gather(const std::map<const Method*, std::vector<Point>>& points, RatioStudy& one) {
    for (const auto& [method, own] : points) {
      one.points.insert(one.points.end(), own.begin(), own.end());
    }
  }

  std::vector<const Method*> methods_;
  Effort effort_;
};

const std::vector<std::string> winner_columns = {"stiffness_ratio", "accuracy",  "method",
                                                 "time_s",          "runner_up", "margin"};
const std::vector<std::string> kind_columns = {"stiffness_ratio", "accuracy", "kind", "method",
                                               "time_s"};

std::string name_of(const Point* point) { return point ? point->method->name : ""; }
double time_of(const Point* point) {
  return point ? point->time : std::numeric_limits<double>::quiet_NaN();
}

void tabulate(Csv& winners, Csv& of_kinds, Csv& points, const RatioStudy& one,
              const std::vector<Kind>& competing) {
  for (const Placing& p : one.placings) {
    winners.row(one.ratio, p.accuracy, name_of(p.fastest), time_of(p.fastest), name_of(p.runner_up),
                time_of(p.runner_up) / time_of(p.fastest));
    for (const Kind kind : competing) {
      const Point* fastest = p.of_kind[static_cast<std::size_t>(kind)];
      of_kinds.row(one.ratio, p.accuracy, kind_name(kind), name_of(fastest), time_of(fastest));
    }
  }
  for (const Point& point : one.points) {
    points.field(one.ratio);
    point_columns().write_row(points, {one.drawn.name, point, one.reference->certified.position});
  }
}

// One ratio each, which then learns from no other.
std::string share_of(const RatioStudy& one) { return fmt::format("{:.17g}", one.ratio); }

Shares shares_of(const std::vector<RatioStudy>& all) {
  Shares shares{.chosen_by = {"--ratios"}};
  for (const RatioStudy& one : all) shares.names.push_back(share_of(one));
  return shares;
}

nlohmann::json origin_of(const std::vector<std::string>& command_line, const std::string& family,
                         double until, const std::vector<RatioStudy>& all) {
  nlohmann::json origin = provenance(command_line, all.front().drawn);
  origin.erase("scene");
  origin["family"] = family;
  origin["until"] = until;
  origin["scenes"] = nlohmann::json::array();
  for (const RatioStudy& one : all) {
    const auto whole = provenance(command_line, one.drawn, one.drawn, *one.scene);
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
void print_winners(const std::vector<RatioStudy>& all) {
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
}

// The reference and the methods at one ratio. False, after a sentence, where there is no reference.
bool measure_ratio(Study& study, const std::string& out,
                   const std::vector<std::string>& command_line, double until, Sweeps& sweeps,
                   RatioStudy& one) {
  const std::string folder = fmt::format("{}/ratio_{:.9g}", out, one.ratio);
  require_folder(folder);
  progress().stage(fmt::format("ratio {:g}: making the reference", one.ratio));
  const auto origin = provenance(command_line, one.drawn, one.drawn, *one.scene);
  bool has_reference = true;
  try {
    one.reference = reference_for(one.drawn, one.drawn, *one.scene, until, folder, origin, needed);
    sweeps.measure(study, one, until);
  } catch (const NoReference& error) {
    progress().wipe();
    fmt::print(stderr, "crossover: ratio {:g}: {}; its cells are left empty\n", one.ratio,
               error.what());
    has_reference = false;
  }
  one.placings = placings(one.points, one.reference.value_or(Reference()));
  return has_reference;
}

int crossover(const CommandLine& line, Arguments a, const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  require_positive(a.effort.seconds, "--point-limit", "the seconds a run may take");
  require_repeats(a.effort.repeats);
  require_ratios(a.ratios);
  const StiffFamily& family = stiff_family(a.family);
  if (line.has("--nodes")) require_within(a.nodes, least_nodes, most_nodes, "--nodes");
  if (line.has("--until")) require_positive(a.until, "--until", "the time to run to in s");
  const double until = line.has("--until") ? a.until : family.until;
  std::vector<RatioStudy> all = ratio_studies(a, family, until);
  const auto methods = competitors(a, all.back());
  const auto competing = kinds_of(methods);
  Study study(line, a.out, {"crossover.csv", "kinds.csv", "points.csv"},
              {{"family", a.family}, {"until", until}, {"nodes", all.front().drawn.nodes.size()}},
              shares_of(all));
  if (const auto status = study.completed()) return *status;
  std::erase_if(all, [&](const RatioStudy& one) { return !study.takes(share_of(one)); });
  Sweeps sweeps(methods, a.effort);
  CsvFile winners(a.out + "/crossover.csv", winner_columns);
  CsvFile of_kinds(a.out + "/kinds.csv", kind_columns);
  std::vector<std::string> columns = point_columns().header();
  columns.insert(columns.begin(), "stiffness_ratio");
  CsvFile points(a.out + "/points.csv", columns);

  bool is_whole = true;
  std::size_t complete = 0;
  study.measure([&] {
    for (RatioStudy& one : all) {
      if (study.is_divided()) sweeps = Sweeps(methods, a.effort);
      is_whole = measure_ratio(study, a.out, command_line, until, sweeps, one) && is_whole;
      ++complete;
    }
  });
  if (study.is_share()) return study.conclude(is_whole ? done : end_not_reached);
  const nlohmann::json origin = origin_of(command_line, a.family, until, all);
  for (const RatioStudy& one : all) tabulate(winners, of_kinds, points, one, competing);
  // What no method could win yet is not said to be lost.
  all.resize(complete);
  print_winners(all);
  for (const RatioStudy& one : all) {
    if (!one.reference || one.reference->certified.position <= Pruning::accuracies.back()) continue;
    fmt::print(
        "at ratio {:g} the reference is certified to {:.1e}: smaller accuracies have no fastest "
        "method\n",
        one.ratio, one.reference->certified.position);
  }
  return study.finish({&winners, &of_kinds, &points}, origin, is_whole ? done : end_not_reached);
}

}  // namespace
}  // namespace qddot::crossover

int main(int argc, char** argv) {
  using namespace qddot::crossover;
  return qddot::kit::enter<Arguments>(
      {.name = "crossover",
       .summary = "Measures from which stiffness on an implicit method is the fastest.",
       .has_threads = true,
       .has_resume = true,
       .has_shares = true},
      declare, crossover, argc, argv);
}
