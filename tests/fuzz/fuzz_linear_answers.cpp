// Do answers by the natural modes of small motions err by no more than they say?
//
//   fuzz_linear_answers --count 300 --seed 1
//   fuzz_linear_answers --kind net --seconds 3600 --list
//
// Each scene is random (tests/random_small.hpp), and its motion is known from plain loops over
// springs in long double at two tolerances (tests/plain_springs.hpp). solve_linear() is asked for
// four accuracies. Its error is compared with the bound that it gives, and with --times its time
// with that of solve(). Each broken bound is printed with its seed; any makes the exit status 1.
#include <algorithm>
#include <chrono>
#include <map>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "qddot/measure/advice/solve_linear.hpp"
#include "qddot/measure/advice/trial.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/fuzz/quantile.hpp"
#include "tests/plain_springs.hpp"
#include "tests/random_small.hpp"

namespace qddot {
namespace {

constexpr double accuracies[] = {1e-2, 1e-3, 1e-4, 1e-5};

struct Choice {
  std::string kind;
  bool is_printed = false, is_listed = false, is_timed = false;
};

// The motion at its end.
struct Truth {
  std::vector<Eigen::Vector3d> displacements;
  double error = 0;  // a bound [m]
};

double largest_difference(const std::vector<Eigen::Vector3d>& a,
                          const std::vector<Eigen::Vector3d>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

Truth truth_of(const SmallScene& drawn) {
  const PlainSprings plain(drawn.scene);
  const long double size = drawn.size, speed = 200 * size;
  Truth truth{plain.displacements_at(*drawn.scene.until, 1e-10L, size, speed)};
  const auto coarse = plain.displacements_at(*drawn.scene.until, 1e-9L, size, speed);
  truth.error = largest_difference(truth.displacements, coarse);
  return truth;
}

struct Tally {
  std::int64_t scenes = 0, asked = 0, answered = 0, accurate = 0, bounded = 0;
  std::vector<double> ratios{}, gains{};  // bound over error; time by solve() over that by modes
};

void print(const std::map<std::string, Tally>& tallies) {
  fmt::print("\n{:<10} {:>7} {:>7} {:>9} {:>6} {:>9} {:>28} {:>24}\n", "kind", "scenes", "asked",
             "answered", "<= A", "<= bound", "bound/error, 1 50 90 %", "gain, 10 50 90 %");
  for (const auto& [kind, own] : tallies)
    fmt::print(
        "{:<10} {:>7} {:>7} {:>9} {:>6} {:>9} {:>10.2g} {:>8.2g} {:>8.2g} {:>8.2g} {:>7.2g} "
        "{:>7.2g}\n",
        kind, own.scenes, own.asked, own.answered, own.accurate, own.bounded,
        quantile(own.ratios, 0.01), quantile(own.ratios, 0.5), quantile(own.ratios, 0.9),
        quantile(own.gains, 0.1), quantile(own.gains, 0.5), quantile(own.gains, 0.9));
}

void ask(const SmallScene& drawn, std::uint64_t seed, const Truth& truth, const Choice& choice,
         Tally& kind, Tally& all) {
  const Scene& scene = drawn.scene;
  for (const double accuracy : accuracies) {
    for (Tally* own : {&kind, &all}) ++own->asked;
    const auto answer = solve_linear(scene, {}, *scene.until, {.accuracy = accuracy});
    const std::string about = fmt::format("seed {} ({}) A {:.0e} size {:.1e} until {:.3g} s", seed,
                                          drawn.kind, accuracy, drawn.size, *scene.until);
    if (!answer) {
      if (choice.is_listed) fmt::print("{}: refused\n", about);
      continue;
    }
    const Answer& own_answer = answer->answer;
    Stage stage(*answer->model, *scene.until, AccuracyOf::positions, &scene, Rules{});
    stage.measure_by(stage.run(*own_answer.method, own_answer.value, {}));
    const double scale = stage.least_scale();
    std::vector<Node> nodes = own_answer.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      nodes[i].position = scene.nodes[i].position + truth.displacements[i];
    const double error = position_error(own_answer.nodes, nodes, stage.scales());
    // Places are rounded on both sides.
    const double unknown = (truth.error + 4 * machine_epsilon) / scale;
    const bool errs = error > own_answer.error_estimate + unknown;
    double gain = 0;
    if (choice.is_timed) {
      const Answer other = solve(Model(scene), *scene.until, {.accuracy = accuracy}, &scene);
      if (other.is_reached) gain = other.seconds.total() / own_answer.seconds.total();
    }
    for (Tally* own : {&kind, &all}) {
      ++own->answered;
      own->accurate += error <= accuracy + unknown;
      own->bounded += !errs;
      if (error > 3 * unknown) own->ratios.push_back(own_answer.error_estimate / error);
      if (gain > 0) own->gains.push_back(gain);
    }
    if (errs || choice.is_listed)
      fmt::print("{}: error {:.2e} bound {:.2e} +- {:.1e}, {:.2g} ms, gain {:.3g}{}\n", about,
                 error, own_answer.error_estimate, unknown, 1e3 * own_answer.seconds.total(), gain,
                 errs ? " ERRS" : "");
  }
}

int fuzz(std::uint64_t count, std::uint64_t seed, double seconds, const Choice& choice) {
  const auto start = std::chrono::steady_clock::now();
  std::map<std::string, Tally> kinds;
  Tally& all = kinds["all"];
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (seconds > 0 && spent.count() > seconds) break;
    const SmallScene drawn = SmallScenes(seed + i).draw();
    if (!choice.kind.empty() && drawn.kind != choice.kind) continue;
    if (choice.is_printed) {
      fmt::print("{}", to_toml(drawn.scene));
      continue;
    }
    validate(drawn.scene, fmt::format("seed {}", seed + i));
    Tally& own = kinds[drawn.kind];
    ++own.scenes;
    ++all.scenes;
    ask(drawn, seed + i, truth_of(drawn), choice, own, all);
    std::fflush(stdout);
  }
  if (choice.is_printed) return 0;
  print(kinds);
  return all.bounded == all.answered ? 0 : 1;
}

}  // namespace
}  // namespace qddot

int main(int argc, char** argv) {
  CLI::App app("Holds answers by natural modes against the motion of plain springs.",
               "fuzz_linear_answers");
  std::uint64_t count = 1'000'000'000, seed = 1;
  double seconds = 0;
  qddot::Choice choice;
  app.add_option("--count", count, "the largest number of scenes");
  app.add_option("--seed", seed, "the seed of the first scene; the next has the next one");
  app.add_option("--seconds", seconds, "the time after which no further scene begins [s]");
  app.add_option("--kind", choice.kind, "scenes of this kind alone");
  app.add_flag("--print", choice.is_printed, "print scenes and do nothing");
  app.add_flag("--list", choice.is_listed, "print every answer and refusal");
  app.add_flag("--times", choice.is_timed, "compare times with those of solve()");
  CLI11_PARSE(app, argc, argv);
  return qddot::fuzz(count, seed, seconds, choice);
}
