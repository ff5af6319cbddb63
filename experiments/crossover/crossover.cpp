// When does an implicit method win? The study finds the fastest method for each accuracy on scenes
// with some stiff springs. These are `ratio` times as stiff as the springs that set the motion.
//
//   crossover --family frame --out results/frame
//   crossover --family chain --ratios 1,1e3,1e6 --methods verlet,ida --out results/chain
//
// With --damping-ratio Z, each spring has a dashpot in proportion to its stiffness, c = beta k.
// Then beta is 2 Z/w_max of the scene at its start, so that Z is the damping ratio of its highest
// mode.
//
//  1. Each ratio has a scene and a reference (agreed_reference) that is good to a tenth of the
//     finest accuracy. It is kept in ratio_R/reference.json for the next time.
//  2. Methods are measured as in work_precision, those first that were fast at the former ratio.
//     SUNDIALS' stock variants are left out: they are slower than the same methods with the
//     structure. A ladder ends early if the method will be 20 times slower than the fastest at each
//     accuracy that it has not reached yet. An explicit method that is so slow throughout is not
//     tried at larger ratios.
//  3. points.csv has every point. crossover.csv has, for each ratio and accuracy from 1e-1 to 1e-6,
//     the fastest method and the next. kinds.csv has the fastest of each kind: explicit, implicit,
//     split (stiff springs apart from the others), rods (in place of the stiff springs, where those
//     can be rods; errors are against the motion of the springs). Fields are empty if no method
//     reached the accuracy, or if the reference does not certify it. rods.csv has what rods change,
//     as a position error at the end.
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
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/crossover/ratio_race.hpp"
#include "experiments/crossover/stiff_scenes.hpp"
#include "experiments/kit/allowed_options.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::crossover {
namespace {

constexpr double largest_ratio = 1e9;  // beyond it rounding of stiff forces is felt
constexpr double largest_zeta = 1e6;

// Gives each spring a dashpot, so that zeta is the damping ratio of the highest mode at the start.
void damp(Scene& scene, double zeta) {
  const Model model(scene);
  damp_springs(2 * zeta / quick_frequency(model.system(), model.initial().q), scene);
}

void require_ratio(double ratio, const std::string& option) {
  if (ratio >= 1 && ratio <= largest_ratio) return;
  throw InvalidInput(fmt::format("{}: {} is not allowed; it is a number from 1 to {:g}", option,
                                 ratio, largest_ratio));
}

// All methods but the stock ones, or those of the list. If springs are named stiff at any ratio,
// they are at the largest.
std::vector<const Method*> competitors(const std::vector<std::string>& list,
                                       const Subject& stiffest) {
  require_each_once(list, "--methods");
  std::vector<std::string> on_springs;
  std::vector<const Method*> with_rods, selected;
  for (const std::string& name : list) {
    const Method& method = method_named(name, "--methods");
    if (method.asks(Need::constraints)) {
      with_rods.push_back(&method);
    } else {
      on_springs.push_back(name);
    }
  }
  if (list.empty() || !on_springs.empty()) selected = select_methods(on_springs, stiffest);
  if (list.empty()) {
    std::erase_if(selected, [](const Method* method) { return !method->stock_of.empty(); });
    for (const Method& method : methods()) {
      if (method.asks(Need::constraints)) with_rods.push_back(&method);
    }
  }
  selected.insert(selected.end(), with_rods.begin(), with_rods.end());
  return selected;
}

}  // namespace
}  // namespace qddot::crossover

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::crossover;
  Program p("crossover", "Measures from which stiffness on an implicit method is the fastest.",
            {has_threads, has_resume, has_shares});
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
  auto zeta = p.number("--damping-ratio", 0,
                       "the damping ratio of the highest mode, by dashpots along the springs")
                  .last()
                  .check([](double ratio, const std::string& option) {
                    if (ratio >= 0 && ratio <= largest_zeta) return;
                    throw InvalidInput(fmt::format("{}: {} is not allowed; it is from 0 to {:g}",
                                                   option, ratio, largest_zeta));
                  });
  auto list = p.methods("a,b,...: the methods (default: all but the stock ways of SUNDIALS, _klu)");
  auto effort = p.effort({.seconds = 5, .repeats = 3});
  auto& winners = p.table(
      "crossover.csv", {"stiffness_ratio", "accuracy", "method", "time_s", "runner_up", "margin"});
  auto& of_kinds =
      p.table("kinds.csv", {"stiffness_ratio", "accuracy", "kind", "method", "time_s"});
  auto& changes = p.table("rods.csv", {"stiffness_ratio", "change"});
  auto& points = p.table("points.csv", point_columns_with_ratio());
  return p.run(argc, argv, [&] {
    const StiffFamily family =
        named(name, stiff_families(), &StiffFamily::name, "--family", "a family");
    std::vector<double> ascending = ratios;
    std::ranges::sort(ascending);
    std::vector<AtRatio> all;
    Shares shares{.chosen_by = {"--ratios"}};
    for (const double ratio : ascending) {
      const double end = until.is_given() ? *until : family.until;
      Scene drawn = family.draw(nodes.is_given() ? *nodes : family.nodes, end, ratio);
      if (*zeta > 0) damp(drawn, zeta);
      all.push_back({.ratio = ratio, .subject = {*name, drawn, drawn, Model(drawn), end}});
      shares.names.push_back(all.back().name());
    }
    const auto methods = competitors(list, all.back().subject);
    const nlohmann::json about = {{"family", *name},
                                  {"until", all.front().subject.until},
                                  {"damping_ratio", *zeta},
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
          for (const AtRatio& one : all) {
            tabulate(one, methods, winners, of_kinds, points);
            if (one.with_rods) changes->row(one.ratio, one.with_rods->change);
          }
          const nlohmann::json origin = origin_of(p, all);
          // A ratio that is not measured yet has no winner.
          all.erase(all.begin() + complete, all.end());
          print_winners(all);
          return origin;
        });
  });
}
