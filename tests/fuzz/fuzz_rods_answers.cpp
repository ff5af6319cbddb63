// Do answers with rods in place of stiff springs err by no more than they say?
//
//   fuzz_rods_answers --count 300 --seed 1
//   fuzz_rods_answers --kind chain --longer 5 --seconds 3600 --list
//   fuzz_rods_answers --vibrating --count 300 --seed 1
//   fuzz_rods_answers --path --count 300 --seed 1
//
// Each scene is random (tests/random_stiff.hpp). Its motion with all springs comes from two
// adaptive methods of high order that resolve all vibrations. Twice their difference is the truth's
// own error. solve_with_rods() is asked for four accuracies. Its error, and the change by rods
// alone, are compared with the bounds that it gives. Refusals count as needless if rods change less
// than half of the accuracy. Each broken bound is printed with its seed; ERRS means that of the
// error, CHANGES that of the change. The exit status is 1 if more than 1 % of the answers break the
// bound of their error.
#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/ended_vibration.hpp"
#include "qddot/measure/advice/solve_with_rods.hpp"
#include "qddot/measure/motion/samples.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/measure/reference/reference_ways.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/rods.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/fuzz/quantile.hpp"
#include "tests/random_stiff.hpp"

namespace qddot {
namespace {

constexpr double accuracies[] = {1e-2, 1e-3, 1e-4, 1e-5};
constexpr double tolerance = 1e-12;
// The gain of frequencies below which solve_with_rods() does not try.
constexpr double least_gain = 10;
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

struct Choice {
  std::string kind;
  double patience = 30;  // seconds for each run of the truth
  double longer = 1;     // factor of end times
  bool is_printed = false, is_listed = false, vibrate = false, of_path = false;
};

// The motion with all springs, at its end.
struct Truth {
  std::shared_ptr<const Model> model;
  Solution solution;
  double error;  // of the positions, a bound
  std::vector<Node> nodes;

  double error_of(const std::vector<Node>& others) const {
    return position_error(others, nodes, solution.scales);
  }
  // The largest on the way of the answer's run, which is repeated with its looks.
  double error_on_the_way(const LesserAnswer& lesser) const {
    const Answer& answer = lesser.answer;
    Simulation run(lesser.model, *answer.method,
                   options_for(*answer.method, answer.value, *lesser.model));
    std::vector<double> times;
    for (const State& state : solution.path) times.push_back(state.t);
    double largest = 0;
    const auto see = [&](const State& state) {
      const auto at = std::ranges::find(solution.path, state.t, &State::t);
      if (at == solution.path.end()) return;
      largest = std::max(largest, position_error(lesser.model->expand(state), model->expand(*at),
                                                 solution.scales));
    };
    run.advance(solution.end.t, {merged({times, answer.looks}), see});
    return largest;
  }
};

std::optional<Solution> run(const Model& model, const char* method, double until, double seconds) {
  const std::vector<double> times = [&] {
    std::vector<double> all;
    for (int k = 1; k <= 50; ++k) all.push_back(until * k / 50);
    return all;
  }();
  return seen_run(model, *find_method(method), with_tolerance_scales({.rtol = tolerance}, model),
                  model.initial(), times, seconds);
}

std::optional<Truth> truth_of(const Scene& scene, double seconds) {
  auto model = std::make_shared<const Model>(scene);
  auto one = run(*model, "arkode_erk8", *scene.until, seconds);
  if (!one) return {};
  const auto other = fehlberg(*model, *scene.until, tolerance, one->scales, seconds);
  if (!other) return {};
  const double apart = position_error(*model, one->end, other->end, one->scales);
  auto nodes = model->expand(one->end);
  return Truth{std::move(model), std::move(*one), 2 * apart, std::move(nodes)};
}

// The motion with rods in place of all stiff springs, to a tight tolerance.
struct RodsTruth {
  double change = not_known;  // of positions; not a number if there are no such rods
  double gain = 0;            // of frequencies
  std::shared_ptr<const Model> model{};
  Scene scene{};
};

RodsTruth rods_truth(const StiffScene& drawn, const Truth& truth, double seconds, bool vibrates) {
  RodsTruth rods{.scene = drawn.scene};
  make_rods_above(drawn.between, rods.scene);
  if (vibrates) {
    const auto laid = laid_on_rods(rods.scene, {});
    if (!laid) return rods;
    rods.scene = *laid;
  }
  try {
    validate_rods(rods.scene, "");
  } catch (const InvalidInput&) {
    return rods;
  }
  rods.model = std::make_shared<const Model>(rods.scene);
  if (!is_constrained(rods.model->system())) return rods;
  const auto fastest = [](const Model& model) {
    return frequency_bound(model.system(), model.initial().q);
  };
  rods.gain = fastest(*truth.model) / fastest(*rods.model);
  const auto end = run(*rods.model, "arkode_erk8_rods", *drawn.scene.until, seconds);
  if (end) rods.change = truth.error_of(rods.model->expand(end->end));
  return rods;
}

std::string why_refused(const RodsTruth& rods, double accuracy) {
  if (!rods.model) return "redundant";
  if (rods.gain < least_gain) return "little gain";
  const Wanted half{.accuracy = accuracy / 2};
  const Answer answer = solve(*rods.model, *rods.scene.until, half, &rods.scene);
  return answer.is_reached ? "change" : "run";
}

// Counts of answers and of the bounds that hold.
struct Tally {
  std::int64_t answered = 0, accurate = 0, bounded = 0, change_bounded = 0, change_known = 0;
  std::vector<double> ratios{}, change_ratios{};  // bound over what is true

  void add(double accuracy, double error, double change, const LesserAnswer& answer,
           double truth_error) {
    ++answered;
    accurate += error <= accuracy + truth_error;
    bounded += error <= answer.answer.error_estimate + truth_error;
    if (error > 0) ratios.push_back(answer.answer.error_estimate / error);
    if (!(change >= 10 * truth_error)) return;
    ++change_known;
    change_bounded += change <= answer.change + truth_error;
    change_ratios.push_back(answer.change / change);
  }
};

struct Refusals {
  std::int64_t all = 0, needless = 0;
};

void print(const std::string& title, const std::map<std::string, Tally>& tallies) {
  fmt::print("\n{:<10} {:>8} {:>9} {:>9} {:>9} {:>26} {:>9} {:>26}\n", title, "answers", "<= A",
             "<= bound", "changes", "bound/error 1 50 90 %", "<= change", "bound/change 1 50 90 %");
  const auto share = [](std::int64_t part, std::int64_t all) {
    return all > 0 ? 100 * static_cast<double>(part) / static_cast<double>(all) : 100;
  };
  const auto three = [](const std::vector<double>& all) {
    return fmt::format("{:.2g} {:.2g} {:.2g}", quantile(all, 0.01), quantile(all, 0.5),
                       quantile(all, 0.9));
  };
  for (const auto& [name, own] : tallies)
    fmt::print("{:<10} {:>8} {:>8.2f}% {:>8.2f}% {:>9} {:>26} {:>8.2f}% {:>26}\n", name,
               own.answered, share(own.accurate, own.answered), share(own.bounded, own.answered),
               own.change_known, three(own.ratios), share(own.change_bounded, own.change_known),
               three(own.change_ratios));
}

struct Results {
  std::map<std::string, Tally> by_accuracy{}, by_kind{}, all{};
  std::map<std::string, Refusals> refusals{};
  std::map<std::string, std::int64_t> kinds{};
  std::int64_t scenes = 0, unknown = 0, cases = 0, broken = 0, answered = 0;
};

void ask(const StiffScene& drawn, std::uint64_t seed, const Truth& truth, const RodsTruth& rods,
         const Choice& choice, Results& results) {
  for (const double accuracy : accuracies) {
    if (truth.error > accuracy / 20) continue;
    ++results.cases;
    const AccuracyOf of = choice.of_path ? AccuracyOf::path : AccuracyOf::positions;
    const auto answer =
        solve_with_rods(drawn.scene, {}, *drawn.scene.until, {.accuracy = accuracy, .of = of});
    const std::string about = fmt::format("seed {} ({}) A {:.0e} ratio {:.1e} until {:.3g} s", seed,
                                          drawn.kind, accuracy, drawn.ratio, *drawn.scene.until);
    if (!answer) {
      const std::string why = why_refused(rods, accuracy);
      Refusals& own = results.refusals[why];
      ++own.all;
      own.needless += rods.change <= accuracy / 2;
      if (choice.is_listed)
        fmt::print("{}: refused ({}), change {:.2e} +- {:.1e}\n", about, why, rods.change,
                   truth.error);
      continue;
    }
    ++results.answered;
    const double error =
        choice.of_path ? truth.error_on_the_way(*answer) : truth.error_of(answer->answer.nodes);
    const std::string name = fmt::format("{:.0e}", accuracy);
    for (Tally* own :
         {&results.by_accuracy[name], &results.by_kind[drawn.kind], &results.all["all"]})
      own->add(accuracy, error, rods.change, *answer, truth.error);
    const double bound = answer->answer.error_estimate;
    const bool errs = error > bound + truth.error;
    const bool changes = rods.change > answer->change + truth.error;
    results.broken += errs;
    if (!errs && !changes && !choice.is_listed) continue;
    fmt::print(
        "{}: error {:.2e} bound {:.2e}, change {:.2e} bound {:.2e}, +- {:.1e}, {} {:.2g}{}{}\n",
        about, error, bound, rods.change, answer->change, truth.error, answer->answer.method->name,
        answer->answer.value, errs ? " ERRS" : "", changes ? " CHANGES" : "");
  }
}

int fuzz(std::uint64_t count, std::uint64_t seed, double seconds, const Choice& choice) {
  const auto start = std::chrono::steady_clock::now();
  Results results;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    if (seconds > 0 && spent.count() > seconds) break;
    StiffScene drawn = StiffScenes(seed + i, choice.vibrate).draw();
    *drawn.scene.until *= choice.longer;
    if (!choice.kind.empty() && drawn.kind != choice.kind) continue;
    if (choice.is_printed) {
      fmt::print("{}", to_toml(drawn.scene));
      continue;
    }
    ++results.scenes;
    validate(drawn.scene, fmt::format("seed {}", seed + i));
    const auto truth = truth_of(drawn.scene, choice.patience);
    if (!truth || !(truth->error < accuracies[0] / 20)) {
      ++results.unknown;
      continue;
    }
    const RodsTruth rods = rods_truth(drawn, *truth, choice.patience, choice.vibrate);
    ask(drawn, seed + i, *truth, rods, choice, results);
    std::fflush(stdout);
  }
  if (choice.is_printed) return 0;
  print("accuracy", results.by_accuracy);
  print("kind", results.by_kind);
  print("", results.all);
  for (const auto& [why, own] : results.refusals)
    fmt::print("refused ({}): {}, of which {} change less than A/2\n", why, own.all, own.needless);
  fmt::print("{} scenes, {} of unknown motion, {} questions, {} answered; {} broken bounds\n",
             results.scenes, results.unknown, results.cases, results.answered, results.broken);
  return 100 * results.broken <= results.answered ? 0 : 1;
}

}  // namespace
}  // namespace qddot

int main(int argc, char** argv) {
  CLI::App app("Holds answers with rods in place of stiff springs against the springs' motion.",
               "fuzz_rods_answers");
  std::uint64_t count = 1'000'000'000, seed = 1;
  double seconds = 0;
  app.add_option("--count", count, "the largest number of scenes");
  app.add_option("--seconds", seconds, "the longest time in s (default: without end)");
  app.add_option("--seed", seed, "the seed of the first scene; each later one has the next number")
      ->capture_default_str();
  qddot::Choice choice;
  app.add_option("--kind", choice.kind, "only scenes of this kind, as cloth or chain");
  app.add_option("--patience", choice.patience, "the longest time in s for each true motion")
      ->capture_default_str();
  app.add_option("--longer", choice.longer, "a factor of the end times")->capture_default_str();
  app.add_flag("--path", choice.of_path, "ask for accuracies at all times");
  app.add_flag("--vibrating", choice.vibrate, "stiff springs start with a stretch, and dashpots");
  app.add_flag("--print", choice.is_printed, "print the scene files and compare nothing");
  app.add_flag("--list", choice.is_listed, "print all answers and refusals");
  CLI11_PARSE(app, argc, argv);
  return qddot::fuzz(count, seed, seconds, choice);
}
