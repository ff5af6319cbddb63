// How good are answers that are asked for by their accuracy alone? Scenes, end times and accuracies
// are drawn at random. The error of each answer is measured against a certified reference. Its time
// is compared with the fastest run of all methods, known in hindsight.
//
//   advice --out results/advice
//   advice --cases 40 --first 4000000 --out results/other
//
//   advice --step-costs --out results/step_costs
//
//  1. Cases are drawn by their number (see drawn_case.hpp). The search was tuned on numbers below
//     11000000; the study takes others.
//  2. cases.csv has, for each case, the answer (method, knob, error estimate), its error, the best
//     run in hindsight, and the seconds of all of these. Cases without a reference are reported and
//     left out.
//  3. worth.csv says how often claims and error bars hold, how wide the bars are, how near the
//     choice is to the best run, and how long everything takes.
//
// The option --step-costs replaces all this: it writes step_costs.csv, the times of a step of each
// method, which forecasts begin with.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "experiments/advice/case_result.hpp"
#include "experiments/advice/worth.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/stability/linear_step.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::judged_advice {
namespace {

// The sizes that steps are timed at, in unknowns, about.
constexpr std::array<double, 4> sizes_of_costs = {3, 30, 300, 3000};

// The time of a step of a method in steps of Verlet's method, at each of the sizes; NaN where it
// did not make its steps.
struct MeasuredCost {
  const Method* method = nullptr;
  std::array<double, sizes_of_costs.size()> steps{};
};

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Scenes of about so many unknowns; no unknown is reduced away.
std::vector<ReducedScene> scenes_of(double unknowns) {
  const auto all = Reductions::only({Reduction::pins, Reduction::duplicates});
  const auto drawn = [&](const char* generator, const GeneratorValues& values) {
    return ReducedScene(generate(*find_generator(generator), values, generator), all);
  };
  const double nodes = std::max(2.0, std::round(unknowns / 3) + 1);
  const double side = std::max(2.0, std::round(std::sqrt(unknowns / 3)));
  const double across = std::max(2.0, std::round(std::cbrt(unknowns / 3)));
  std::vector<ReducedScene> scenes;
  scenes.push_back(drawn("chain", {{"nodes", nodes}}));
  scenes.push_back(drawn("cloth", {{"nodes", side}}));
  scenes.push_back(
      drawn("lattice", {{"nodes_x", across}, {"nodes_y", across}, {"nodes_z", across}}));
  return scenes;
}

// Seconds of a step: of forty steps after the first twenty.
double seconds_of_step(const Method& method, const ReducedScene& scene, double w) {
  constexpr double implicit_h_omega = 10, before = 20, after = 60, passes = 0.1;
  const double limit = linear_limit(method);
  const double h = (std::isfinite(limit) ? limit / 2 : implicit_h_omega) / w;
  const auto integrator = make_integrator(method, scene.system(), {.step_size = h});
  bool is_good = true;
  const auto seconds = [&](double steps) {
    return least_seconds(passes, [&] {
      State state = scene.initial();
      is_good = is_good && integrator->advance(state, steps * h).outcome == Outcome::reached_end;
    });
  };
  const double step = (seconds(after) - seconds(before)) / (after - before);
  return is_good ? step : unknown;
}

// Times a step of each fixed-step method that has forecasts, as the median over a chain, a cloth
// and a lattice. Explicit methods step at half of their limit, implicit ones at h w_max = 10. The
// table in measure/advice/step_cost.cpp has these numbers.
std::vector<MeasuredCost> measured_costs() {
  std::vector<MeasuredCost> costs;
  for (const Method& method : methods()) {
    if (!has_linear_step(method) || method.order < 2 || !method.stock_of.empty() ||
        method.asks(Need::constant_stiffness))
      continue;
    costs.push_back({&method, {}});
  }
  for (std::size_t size = 0; size < sizes_of_costs.size(); ++size) {
    const auto scenes = scenes_of(sizes_of_costs[size]);
    std::vector<double> w, verlet;
    for (const ReducedScene& scene : scenes) {
      w.push_back(quick_frequency(scene.system(), scene.initial().q));
      verlet.push_back(seconds_of_step(*find_method("verlet"), scene, w.back()));
    }
    for (MeasuredCost& cost : costs) {
      std::vector<double> ratios;
      for (std::size_t i = 0; i < scenes.size(); ++i) {
        const double step = seconds_of_step(*cost.method, scenes[i], w[i]);
        if (std::isfinite(step)) ratios.push_back(step / verlet[i]);
      }
      cost.steps[size] = ratios.empty() ? unknown : median(ratios);
    }
  }
  return costs;
}

}  // namespace
}  // namespace qddot::judged_advice

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::judged_advice;
  Program p({.name = "advice",
             .summary = "Measures how good answers are that were asked for by their accuracy.",
             .has_threads = true,
             .has_resume = true,
             .has_shares = true});
  auto cases = p.whole("--cases", 400, "number of cases").within(1, 100000);
  auto first = p.whole("--first", 11000000,
                       "the number of the first case; the search was tuned on cases below 11000000")
                   .within(0, 2000000000);
  auto repeats =
      p.whole("--repeats", 3, "timed runs of the best and of the chosen run").within(1, 1000);
  auto jobs = p.whole("--jobs", 1, "cases at a time, each on a core of its own").within(1, 256);
  auto reference_seconds =
      p.number("--reference-seconds", 5, "approximate number of seconds that a reference may take")
          .positive("the seconds of a reference");
  auto step_costs = p.flag(
      "--step-costs", "instead, time a step of each method at four sizes, into step_costs.csv");
  p.out("the folder for cases.csv and worth.csv");

  const auto time_steps = [&] {
    auto& table = p.table("step_costs.csv", {"method", "unknowns", "steps_of_verlet"});
    return p.write([&] {
      for (const MeasuredCost& cost : measured_costs()) {
        fmt::print("{:<26}", cost.method->name);
        for (std::size_t i = 0; i < sizes_of_costs.size(); ++i) {
          table->row(cost.method->name, sizes_of_costs[i], cost.steps[i]);
          fmt::print(" {:>8.3g}", cost.steps[i]);
        }
        fmt::print("\n");
      }
      return p.origin();
    });
  };
  const auto judge_cases = [&] {
    auto& table = p.table("cases.csv", case_columns());
    auto& worth = p.table<Figure>("worth.csv", {{"figure", &Figure::name},
                                                {"value", &Figure::value},
                                                {"cases", &Figure::cases},
                                                {"meaning", &Figure::meaning}});
    std::vector<std::uint64_t> numbers;
    Shares shares{.chosen_by = {"--cases", "--first"}};
    for (int i = 0; i < cases; ++i) {
      numbers.push_back(static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(i));
      shares.names.push_back(std::to_string(numbers.back()));
    }
    std::vector<CaseResult> results;
    return p.study(
        {{"code", build_info::source_hash}}, shares,
        [&](Study& study) {
          std::erase_if(numbers, [&](std::uint64_t n) { return !study.takes(std::to_string(n)); });
          results.resize(numbers.size());
          progress().begin(results.size());
          side_by_side(
              results.size(),
              [&](std::size_t i) {
                const std::string name = fmt::format("case {}", numbers[i]);
                results[i] = study.piece(name, [&] {
                  return nlohmann::json(
                      result_of(drawn_case(numbers[i]), reference_seconds, repeats));
                });
                progress().finish(name);
              },
              jobs);
        },
        [&] {
          std::erase_if(results, [](const CaseResult& result) { return result.name.empty(); });
          for (const CaseResult& result : results) table.add(result);
          fmt::print("{:<24} {:>8} {:>6}  {}\n", "figure", "value", "cases", "of what");
          for (const Figure& figure : worth_of(results)) {
            worth.add(figure);
            fmt::print("{:<24} {:>8.3g} {:>6}  {}\n", figure.name, figure.value, figure.cases,
                       figure.meaning);
          }
          return p.origin();
        });
  };
  return p.run(argc, argv, [&] { return step_costs ? time_steps() : judge_cases(); });
}
