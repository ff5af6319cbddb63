// Do scenes with cables and springs that break move as an independent model says, by any method?
//
//   fuzz_switching --count 1000 --seed 1
//   fuzz_switching --breaking --seconds 3600
//
// Each scene is random (tests/random_switching.hpp). The independent model is in
// tests/independent_switching.hpp: plain forces in long double, and a bracket for each moment at
// which a spring goes slack, taut or breaks. A scene is skipped if a disturbance of 1e-10 at its
// start changes these moments' order or the end by 1e-6, or if a spring hardly breaks. These are
// compared: the ends of motions and states on the way, energies, breakings, numbers of moments, and
// runs with and without an observer. Each disagreement is printed with its seed; any makes the exit
// status 1.
#include <chrono>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "qddot/scene/scene_file.hpp"
#include "tests/fuzz/printed_comparisons.hpp"
#include "tests/switching_comparison.hpp"

namespace qddot {
namespace {

struct Choice {
  std::string kind, method;
  bool is_breaking = false, is_printed = false, is_listed = false;

  SwitchingScene scene(std::uint64_t seed) const {
    SwitchingScenes scenes(seed);
    return is_breaking ? scenes.draw_breaking() : scenes.draw();
  }
  std::vector<std::string> methods() const {
    if (!method.empty()) return {method};
    return {"verlet",    "rk4",     "symmetric4",        "blanes_moan4",   "kahan_li8",
            "dprkn8",    "dprkn12", "arkode_erk4",       "arkode_erk8",    "cvode_adams",
            "cvode_bdf", "bdf2",    "implicit_midpoint", "trapezoidal",    "rodas4",
            "ida",       "trbdf2",  "discrete_gradient", "implicit_euler", "linear_midpoint"};
  }
};

struct Tally {
  std::int64_t scenes = 0, skipped = 0, changes = 0, breaks = 0, disagreeing = 0;
};

void list_changes(const KnownSwitching& known) {
  fmt::print("growth {:.3g}, clear {}, released {:.12g} J, dissipated {:.12g} J {}\n",
             known.growth(), known.is_clear(), known.released(), known.dissipated(),
             known.why_unknown());
  for (const HoldChange& one : known.changes()) {
    const char* to = one.to == Hold::gone ? "broken" : one.to == Hold::taut ? "taut" : "slack";
    fmt::print("{:.17g} s: spring {} {}, l' = {:.6g} m/s\n", static_cast<double>(one.t), one.spring,
               to, static_cast<double>(one.rate));
  }
}

MethodComparisons compare_all(const KnownSwitching& known, const Choice& choice) {
  SwitchingComparison comparison(known);
  const Model reduced(known.scene()), whole(known.scene(), Reductions::only({}));
  for (const std::string& name : choice.methods()) {
    const Method* method = find_method(name);
    if (!method) throw std::invalid_argument("no method is named " + name);
    comparison.compare(*method, reduced, "");
    if (name == "arkode_erk8" || name == "verlet")
      comparison.compare(*method, whole, ", no reduction");
  }
  return comparison.results();
}

int fuzz(std::uint64_t count, std::uint64_t seed, double seconds, const Choice& choice) {
  const auto start = std::chrono::steady_clock::now();
  std::map<std::string, Tally> kinds;
  std::map<std::string, std::int64_t> reasons;
  MethodComparisons all;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (seconds > 0 && spent.count() > seconds) break;
    const auto [scene, kind] = choice.scene(seed + i);
    if (!choice.kind.empty() && kind != choice.kind) continue;
    if (choice.is_printed) {
      fmt::print("{}", to_toml(scene));
      continue;
    }
    const KnownSwitching known(scene);
    if (choice.is_listed) list_changes(known);
    Tally& tally = kinds[kind];
    ++tally.scenes;
    if (!known.why_unknown().empty()) {
      ++tally.skipped;
      ++reasons[known.why_unknown()];
      continue;
    }
    tally.changes += std::ssize(known.changes());
    tally.breaks += std::ssize(known.breaks());
    const MethodComparisons own = compare_all(known, choice);
    tally.disagreeing += !own.disagreements.empty();
    for (const std::string& sentence : own.disagreements)
      fmt::print("seed {} ({}): {}\n", seed + i, kind, sentence);
    std::fflush(stdout);
    all += own;
  }
  if (choice.is_printed) return 0;
  fmt::print("\n{:<24} {:>8} {:>8} {:>8} {:>8} {:>12}\n", "kind", "scenes", "skipped", "changes",
             "breaks", "disagreeing");
  Tally sum;
  for (const auto& [kind, tally] : kinds) {
    fmt::print("{:<24} {:>8} {:>8} {:>8} {:>8} {:>12}\n", kind, tally.scenes, tally.skipped,
               tally.changes, tally.breaks, tally.disagreeing);
    sum.scenes += tally.scenes;
    sum.skipped += tally.skipped;
  }
  for (const auto& [reason, number] : reasons) fmt::print("skipped as {}: {}\n", reason, number);
  const std::int64_t wrong = print_orders(all);
  print_sizes(all.tolerances, "errs in tolerances by");
  fmt::print("{} scenes, {} runs, {} skipped, {} refused; {} disagreements\n", sum.scenes, all.runs,
             sum.skipped, all.refused, std::ssize(all.disagreements) + wrong);
  return all.disagreements.empty() && wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace qddot

int main(int argc, char** argv) {
  CLI::App app("Holds scenes with cables and springs that break against an independent model.",
               "fuzz_switching");
  std::uint64_t count = 1'000'000'000, seed = 1;
  double seconds = 0;
  app.add_option("--count", count, "the largest number of scenes");
  app.add_option("--seconds", seconds, "the longest time in s (default: without end)");
  app.add_option("--seed", seed, "the seed of the first scene; each later one has the next number")
      ->capture_default_str();
  qddot::Choice choice;
  app.add_option("--kind", choice.kind, "only scenes of this kind, as hanging or symmetric");
  app.add_option("--method", choice.method, "only this method");
  app.add_flag("--breaking", choice.is_breaking, "the same scenes with springs that break");
  app.add_flag("--print", choice.is_printed, "print the scene files and compare nothing");
  app.add_flag("--list", choice.is_listed, "print all moments at which springs change");
  CLI11_PARSE(app, argc, argv);
  return qddot::fuzz(count, seed, seconds, choice);
}
