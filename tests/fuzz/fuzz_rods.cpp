// Do scenes with rods move as an independent model says, by any method?
//
//   fuzz_rods --count 1000 --seed 1
//   fuzz_rods --kind ring --seconds 3600
//
// Each scene is random (tests/random_linkage.hpp), and one of four stands before a mirror. The
// independent model is in tests/independent_linkage.hpp: directions of rods are coordinates, in
// long double, without multipliers. A scene is skipped if its loops come near a singular position,
// or if a disturbance of its start grows 10,000 times. These are compared: the ends of motions and
// states on the way, tensions, energies, lengths of rods, and runs with and without an observer.
// Each disagreement is printed with its seed; any makes the exit status 1.
#include <chrono>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "qddot/scene/scene_file.hpp"
#include "tests/fuzz/printed_comparisons.hpp"
#include "tests/linkage_comparison.hpp"
#include "tests/mirrored_linkage.hpp"

namespace qddot {
namespace {

struct Choice {
  std::string kind, method;
  bool is_printed = false, is_listed = false;

  bool takes(const Method& own) const { return method.empty() || own.name == method; }
};

struct Tally {
  std::int64_t scenes = 0, skipped = 0, disagreeing = 0;
  Eigen::Index freedoms = 0;
};

void list(const KnownLinkage& known, std::uint64_t seed, const std::string& kind) {
  fmt::print(
      "seed {} ({}): {} nodes, {} freedoms, growth {:.3g}, fastest {:.3g} rad/s, {:.3g} s {}\n",
      seed, kind, known.scene().nodes.size(), known.freedoms(), known.growth(), known.fastest(),
      known.until(), known.why_unknown());
}

// Compares all methods on the scene with and without reductions.
MethodComparisons compare_all(const KnownLinkage& known, const Choice& choice) {
  LinkageComparison comparison(known);
  validate(known.scene(), "the scene");
  const Model reduced(known.scene()), whole(known.scene(), Reductions::only({}));
  comparison.compare_start(reduced, true, "reduced");
  comparison.compare_start(whole, false, "no reduction");
  for (const Method& method : methods()) {
    if (!choice.takes(method)) continue;
    comparison.compare(method, reduced, "");
    comparison.compare(method, whole, ", no reduction");
  }
  return comparison.results();
}

// The same; a scene that is refused is a disagreement.
MethodComparisons compare_safely(const KnownLinkage& known, const Choice& choice) {
  try {
    return compare_all(known, choice);
  } catch (const std::exception& error) {
    MethodComparisons none;
    none.disagreements.push_back(fmt::format("throws: {}", error.what()));
    return none;
  }
}

void print_kinds(const std::map<std::string, Tally>& kinds) {
  fmt::print("\n{:<24} {:>8} {:>8} {:>10} {:>12}\n", "kind", "scenes", "skipped", "freedoms",
             "disagreeing");
  for (const auto& [kind, tally] : kinds)
    fmt::print("{:<24} {:>8} {:>8} {:>10} {:>12}\n", kind, tally.scenes, tally.skipped,
               tally.freedoms, tally.disagreeing);
}

int fuzz(std::uint64_t count, std::uint64_t seed, double seconds, const Choice& choice) {
  const auto start = std::chrono::steady_clock::now();
  std::map<std::string, Tally> kinds;
  std::map<std::string, std::int64_t> reasons;
  MethodComparisons all;
  std::int64_t scenes = 0, skipped = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (seconds > 0 && spent.count() > seconds) break;
    const auto [scene, kind] = linkage_or_mirrored(seed + i);
    if (!choice.kind.empty() && kind != choice.kind) continue;
    if (choice.is_printed) {
      fmt::print("{}", to_toml(scene));
      continue;
    }
    const KnownLinkage known(scene);
    if (choice.is_listed) list(known, seed + i, kind);
    Tally& tally = kinds[kind];
    ++tally.scenes;
    ++scenes;
    if (!known.why_unknown().empty()) {
      ++tally.skipped;
      ++skipped;
      ++reasons[known.why_unknown()];
      continue;
    }
    tally.freedoms += known.freedoms();
    const MethodComparisons own = compare_safely(known, choice);
    tally.disagreeing += !own.disagreements.empty();
    for (const std::string& sentence : own.disagreements)
      fmt::print("seed {} ({}): {}\n", seed + i, kind, sentence);
    std::fflush(stdout);
    all += own;
  }
  if (choice.is_printed) return 0;
  print_kinds(kinds);
  for (const auto& [reason, number] : reasons) fmt::print("skipped as {}: {}\n", reason, number);
  const std::int64_t wrong = print_orders(all);
  print_sizes(all.tolerances, "errs in tolerances by");
  print_sizes(all.stretches, "stretches rods by");
  fmt::print("{} scenes, {} runs, {} skipped, {} refused; {} disagreements\n", scenes, all.runs,
             skipped, all.refused, std::ssize(all.disagreements) + wrong);
  return all.disagreements.empty() && wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace qddot

int main(int argc, char** argv) {
  CLI::App app("Holds scenes with rods against an independent model.", "fuzz_rods");
  std::uint64_t count = 1'000'000'000, seed = 1;
  double seconds = 0;
  app.add_option("--count", count, "the largest number of scenes");
  app.add_option("--seconds", seconds, "the longest time in s (default: without end)");
  app.add_option("--seed", seed, "the seed of the first scene; each later one has the next number")
      ->capture_default_str();
  qddot::Choice choice;
  app.add_option("--kind", choice.kind, "only scenes of this kind, as chain or ring");
  app.add_option("--method", choice.method, "only this method");
  app.add_flag("--print", choice.is_printed, "print the scene files and compare nothing");
  app.add_flag("--list", choice.is_listed, "print what is known of each motion");
  CLI11_PARSE(app, argc, argv);
  return qddot::fuzz(count, seed, seconds, choice);
}
