// How often are the verdicts of energy_drift right? Errors of known kinds are drawn at random, seen
// as energy_drift sees a run, and judged.
//
//   verdicts --out results/verdicts
//   verdicts --seeds 4000 --kinds "random walk" --out results/walk
//
//  1. confusion.csv: for each kind the verdicts given, how many, and whether that is right, wrong,
//     or uncertain (`undecided` and `unknown`, which claim nothing).
//  2. coverage.csv: for each interval or bound that is printed, how often it holds what is true,
//     with the 95 % interval of that (Wilson). Its sidecar has walks' sizes over the true ones.
#include <algorithm>
#include <map>
#include <string>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/verdicts/tally.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/trend/sample_steps.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::verdicts {
namespace {

std::vector<SyntheticKind> chosen_kinds(const std::vector<std::string>& names) {
  std::vector<SyntheticKind> all = synthetic_kinds();
  if (names.empty()) return all;
  std::vector<SyntheticKind> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name, &SyntheticKind::name);
    if (found == all.end()) {
      std::string known;
      for (const SyntheticKind& kind : all) known += (known.empty() ? "" : "; ") + kind.name;
      throw InvalidInput(
          fmt::format("--kinds: there is no kind \"{}\"; there are: {}", name, known));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

void print(const SyntheticKind& kind, const Tally& tally, int seeds) {
  std::map<std::string, int> judged;
  std::string words;
  for (const auto& [verdict, count] : tally.verdicts) {
    judged[judgement(kind, verdict)] += count;
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", verdict_name(verdict), count);
  }
  const double percent = 100.0 / seeds;
  fmt::print("{:<34} {:>6.1f} {:>9.1f} {:>6.1f}   {}\n", kind.name, judged["right"] * percent,
             judged["uncertain"] * percent, judged["wrong"] * percent, words);
}

void print_coverage(const std::vector<SyntheticKind>& kinds, const std::vector<Tally>& tallies) {
  fmt::print("\n{:<34} {:<18} {:>6} {:>8}   {}\n", "what is said with 95 %", "", "said", "holds",
             "95 % interval of that");
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    for (const auto& [what, c] : tallies[i].coverage) {
      const Interval part = c.interval();
      fmt::print("{:<34} {:<18} {:>6} {:>6.1f} %   {:.1f} to {:.1f}\n", kinds[i].name, what, c.said,
                 100 * part.value, 100 * part.low, 100 * part.high);
    }
    if (kinds[i].walk) {
      fmt::print("{:<34} size over the true one: {:.3f}\n", kinds[i].name, tallies[i].walk);
    }
  }
}

}  // namespace
}  // namespace qddot::verdicts

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::verdicts;
  Program p("verdicts", "Finds out how often the verdicts of energy_drift are right.",
            {has_resume});
  auto seeds = p.whole("--seeds", 100, "runs of each kind").within(1, 1000000);
  auto cells = p.whole("--cells", many_cells, "samples in an octave of a run").within(8, 1 << 20);
  std::vector<std::string> names;
  p.bind("--kinds", names, "kinds of errors, each in quotes (default: all)");
  p.out("the folder for confusion.csv and coverage.csv");
  auto& confusion = p.table("confusion.csv", {"kind", "verdict", "count", "part", "judgement"});
  auto& coverage =
      p.table("coverage.csv", {"kind", "what", "said", "held", "part", "part_low", "part_high"});
  return p.run(argc, argv, [&] {
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<SyntheticKind> kinds = chosen_kinds(names);
    std::vector<Tally> tallies;
    return p.study(
        {},
        [&](Study& study) {
          fmt::print(
              "{} runs of each kind; percent of them judged\n{:<34} {:>6} {:>9} {:>6}   {}\n",
              *seeds, "kind", "right", "uncertain", "wrong", "verdicts");
          progress().begin(kinds.size());
          for (const SyntheticKind& kind : kinds) {
            progress().now_at(kind.name);
            const Tally own =
                study.piece(kind.name, [&] { return nlohmann::json(tally(kind, seeds, cells)); });
            progress().finish(kind.name);
            progress().wipe();
            print(kind, own, seeds);
            for (const auto& [verdict, count] : own.verdicts) {
              confusion->row(kind.name, verdict_name(verdict), count,
                             static_cast<double>(count) / seeds, judgement(kind, verdict));
            }
            for (const auto& [what, c] : own.coverage) {
              const Interval part = c.interval();
              coverage->row(kind.name, what, c.said, c.held, part.value, part.low, part.high);
            }
            tallies.push_back(own);
          }
        },
        [&] {
          print_coverage(kinds, tallies);
          nlohmann::json origin = p.origin();
          origin["seeds"] = *seeds;
          origin["cells"] = *cells;
          for (std::size_t i = 0; i < tallies.size(); ++i) {
            if (kinds[i].walk) origin["walk_size"][kinds[i].name] = tallies[i].walk;
          }
          origin["seconds"] = seconds_since(begin);
          return origin;
        });
  });
}
