// Does a scene move as it is drawn, with any reductions and any method?
//
//   fuzz_motions --count 1000 --seed 1
//   fuzz_motions --seconds 3600
//
// Each scene is random (tests/independent/random_scene.hpp). An independent model computes its
// motion over some vibrations. It shares only the scene with qddot's model: plain forces, spring by
// spring, in long double, by extrapolation. These are compared with it:
//   states    energies, force and what is drawn, for each set of reductions, at and near the start;
//   motions   the end of the motion with each set of reductions;
//   methods   and the end by every method, of every tenth scene.
// Each disagreement is printed with its seed; any makes the exit status 1.
#include <chrono>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "qddot/scene/scene_file.hpp"
#include "tests/independent/comparison.hpp"
#include "tests/independent/random_scene.hpp"

namespace qddot {
namespace {

struct Choice {
  std::string only;
  bool is_damped = false, is_driven = false, is_printed = false;

  RandomScene scene(std::uint64_t seed) const {
    if (is_driven) return driven_scene(seed);
    return is_damped ? damped_scene(seed) : random_scene(seed);
  }
};

struct Tally {
  std::int64_t scenes = 0, unknown = 0, disagreeing = 0;
};

int fuzz(std::uint64_t count, std::uint64_t seed, double seconds, std::uint64_t methods_every,
         const Choice& choice) {
  const auto start = std::chrono::steady_clock::now();
  std::map<std::string, Tally> kinds;
  Comparisons all;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (seconds > 0 && spent.count() > seconds) break;
    const auto [scene, kind] = choice.scene(seed + i);
    if (!choice.only.empty() && kind != choice.only) continue;
    if (choice.is_printed) {
      fmt::print("{}", to_toml(scene));
      continue;
    }
    Comparisons own = compare_states(scene, seed + i);
    const DrawnMotion motion(scene);
    own += compare_reductions(motion);
    if (methods_every > 0 && (seed + i) % methods_every == 0) own += compare_methods(motion);
    Tally& tally = kinds[kind];
    ++tally.scenes;
    tally.unknown += motion.known_until() == 0;
    tally.disagreeing += !own.disagreements.empty();
    for (const std::string& sentence : own.disagreements)
      fmt::print("seed {} ({}): {}\n", seed + i, kind, sentence);
    std::fflush(stdout);
    all += own;
  }
  if (choice.is_printed) return 0;
  fmt::print("\n{:<18} {:>8} {:>18} {:>12}\n", "kind", "scenes", "without a motion", "disagreeing");
  for (const auto& [kind, tally] : kinds)
    fmt::print("{:<18} {:>8} {:>18} {:>12}\n", kind, tally.scenes, tally.unknown,
               tally.disagreeing);
  fmt::print("{} states, {} motions, {} runs; {} disagreements\n", all.states, all.motions,
             all.runs, all.disagreements.size());
  return all.disagreements.empty() ? 0 : 1;
}

}  // namespace
}  // namespace qddot

int main(int argc, char** argv) {
  CLI::App app("Holds random scenes against an independent model of what is drawn.",
               "fuzz_motions");
  std::uint64_t count = 1'000'000'000, seed = 1, methods_every = 10;
  double seconds = 0;
  app.add_option("--count", count, "the largest number of scenes");
  app.add_option("--seconds", seconds, "the longest time in s (default: without end)");
  app.add_option("--seed", seed, "the seed of the first scene; each later one has the next number")
      ->capture_default_str();
  app.add_option("--methods-every", methods_every,
                 "try every method on every so many-th scene: 1 all, 10 every tenth, 0 none")
      ->capture_default_str();
  qddot::Choice choice;
  app.add_option("--kind", choice.only, "only scenes of this kind, as coincident or massless");
  app.add_flag("--damped", choice.is_damped, "the same scenes with dashpots and air");
  app.add_flag("--driven", choice.is_driven,
               "the same scenes with supports that move and loads that change");
  app.add_flag("--print", choice.is_printed, "print the scene files and compare nothing");
  CLI11_PARSE(app, argc, argv);
  return qddot::fuzz(count, seed, seconds, methods_every, choice);
}
