// How good are answers that are asked for by their accuracy alone? Scenes, end times and accuracies
// are drawn at random. The error of each answer is measured against a certified reference. Its time
// is compared with the fastest run of all methods, known in hindsight.
//
//   advice --out results/advice
//   advice --cases 40 --first 4000000 --out results/other
//
//   advice --hard --first 34000000 --out results/hard
//   advice --hard --cases 1 --first 21000007 --scenes --out results/one
//
//  1. Cases are drawn by their number (see drawn_case.hpp). The search was tuned on numbers below
//     22000000; the study takes others.
//  2. cases.csv has, for each case, the answer (method, knob, error estimate), its error, the best
//     run in hindsight, and the seconds of all of these. Cases without a reference are reported and
//     left out.
//  3. worth.csv says how often claims and error bars hold and how wide the bars are. It also says
//     how near the choice is to the best run, and how long everything takes.
//
// The option --hard asks for hard motions instead (see hard_case.hpp), and judges positions, path
// and energy against their true motion (see true_motion.hpp), advised runs as well. hard.csv has
// the answers, hard_worth.csv says for each kind how often they hold and how often one is refused
// that rounding allows. Rules may be chosen on numbers below 34000000.
//
// The options --hard --rules ask each hard motion again with each rule of the search halved and
// doubled (see rules.hpp). rules.csv says what becomes of the bars, the refusals and the forces.
//
// The options --hard --samples run each hard motion with all methods of error control, and measure
// the states that they give between their steps (see sample_errors.hpp). samples.csv has each run,
// samples_by_method.csv sums them up.
#include <vector>

#include <fmt/format.h>

#include "experiments/advice/case_result.hpp"
#include "experiments/advice/hard_worth.hpp"
#include "experiments/advice/rule_effects.hpp"
#include "experiments/advice/sample_errors.hpp"
#include "experiments/advice/worth.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/scene_file.hpp"

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::judged_advice;
  Program p("advice", "Measures how good answers are that were asked for by their accuracy.",
            {has_threads, has_resume, has_shares});
  auto cases = p.whole("--cases", 400, "number of cases").within(1, 100000);
  auto first = p.whole("--first", 22000000,
                       "the number of the first case; the search was tuned on cases below 22000000")
                   .within(0, 2000000000);
  auto repeats =
      p.whole("--repeats", 3, "timed runs of the best and of the chosen run").within(1, 1000);
  auto jobs = p.whole("--jobs", 1, "cases at a time, each on a core of its own").within(1, 256);
  auto reference_seconds =
      p.number("--reference-seconds", 5, "approximate number of seconds that a reference may take")
          .positive("the seconds of a reference");
  auto hard = p.flag("--hard", "draw hard motions: small ones, judged against their true motion");
  auto scenes =
      p.flag("--scenes", "with --hard, write the scene of each case, and print a line for each");
  auto rules = p.flag("--rules", "with --hard, change each rule of the search by a factor of two");
  auto samples = p.flag("--samples", "with --hard, measure states between the steps of runs");
  p.out("the folder for cases.csv and worth.csv");

  // Judges the cases of these numbers, piece by piece, and tells the results.
  const auto judge = [&]<class Result>(RowTable<Result>& table, const auto& result_of_number,
                                       const auto& tell) {
    std::vector<std::uint64_t> numbers;
    Shares shares{.chosen_by = {"--cases", "--first", "--hard", "--rules", "--samples"}};
    for (int i = 0; i < cases; ++i) {
      numbers.push_back(static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(i));
      shares.names.push_back(std::to_string(numbers.back()));
    }
    std::vector<Result> results;
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
                results[i] =
                    study.piece(name, [&] { return nlohmann::json(result_of_number(numbers[i])); });
                progress().finish(name);
              },
              jobs);
        },
        [&] {
          std::erase_if(results, [](const Result& result) { return result.name.empty(); });
          for (const Result& result : results) table.add(result);
          tell(results);
          return p.origin();
        });
  };
  const Columns<Figure> figure_columns = {{"of", &Figure::of},
                                          {"figure", &Figure::name},
                                          {"value", &Figure::value},
                                          {"cases", &Figure::cases},
                                          {"meaning", &Figure::meaning}};
  const auto judge_cases = [&] {
    auto& worth = p.table<Figure>("worth.csv", figure_columns);
    return judge(
        p.table("cases.csv", case_columns()),
        [&](std::uint64_t number) {
          return result_of(drawn_case(number), reference_seconds, repeats);
        },
        [&](const std::vector<CaseResult>& results) {
          fmt::print("{:<24} {:>8} {:>6}  {}\n", "figure", "value", "cases", "of what");
          for (const Figure& figure : worth_of(results)) {
            worth.add(figure);
            fmt::print("{:<24} {:>8.3g} {:>6}  {}\n", figure.name, figure.value, figure.cases,
                       figure.meaning);
          }
        });
  };
  const auto judge_hard_cases = [&] {
    auto& worth = p.table<Figure>("hard_worth.csv", figure_columns);
    return judge(
        p.table("hard.csv", hard_columns()),
        [&](std::uint64_t number) {
          const HardCase hard_one = hard_case(number);
          if (scenes && hard_one.pairs.empty()) {
            WholeFile file(fmt::format("{}/case_{}.toml", p.folder(), number));
            file.write(signed_text(to_toml(hard_one.scene)));
            file.commit();
          }
          return result_of(hard_one);
        },
        [&](const std::vector<HardResult>& results) {
          const auto figures = worth_of(results);
          for (const Figure& figure : figures) worth.add(figure);
          fmt::print("{}\n{}", fmt::join(lines_of(results, scenes), "\n"), in_columns(figures));
        });
  };
  const auto judge_rules = [&] {
    const Columns<RuledCase> case_columns = {{"case", &RuledCase::name},
                                             {"conditioning", &RuledCase::conditioning}};
    auto& effects = p.table<RuleEffect>("rules.csv", {{"rule", &RuleEffect::rule},
                                                      {"value", &RuleEffect::value},
                                                      {"factor", &RuleEffect::factor},
                                                      {"within_bar", &RuleEffect::within_bar},
                                                      {"refused", &RuleEffect::refused},
                                                      {"forces", &RuleEffect::forces}});
    return judge(
        p.table("ruled_cases.csv", case_columns),
        [&](std::uint64_t number) { return ruled_case(hard_case(number)); },
        [&](const std::vector<RuledCase>& results) {
          fmt::print("{:<18} {:>8} {:>7} {:>11} {:>8} {:>8}\n", "rule", "value", "factor",
                     "within bar", "refused", "forces");
          for (const RuleEffect& effect : effects_of(results)) {
            effects.add(effect);
            fmt::print("{:<18} {:>8.3g} {:>7.2g} {:>10.2f}% {:>7.2f}% {:>8.2f}\n", effect.rule,
                       effect.value, effect.factor, effect.within_bar, effect.refused,
                       effect.forces);
          }
        });
  };
  const auto judge_samples = [&] {
    const Columns<SampledCase> case_columns = {{"case", &SampledCase::name},
                                               {"left_out", &SampledCase::left_out},
                                               {"conditioning", &SampledCase::conditioning}};
    using M = SampledMethod;
    auto& runs = p.table<SampledRun>("samples.csv", sample_columns());
    auto& sums = p.table<M>("samples_by_method.csv", {{"method", &M::method},
                                                      {"runs", &M::runs},
                                                      {"ended_early", &M::ended_early},
                                                      {"largest", &M::largest},
                                                      {"median", &M::median},
                                                      {"share", &M::share},
                                                      {"plain_largest", &M::plain_largest},
                                                      {"plain_median", &M::plain_median},
                                                      {"plain_share", &M::plain_share}});
    return judge(
        p.table("sampled_cases.csv", case_columns),
        [&](std::uint64_t number) { return sampled_case(hard_case(number)); },
        [&](const std::vector<SampledCase>& results) {
          for (const SampledCase& one : results) {
            for (const SampledRun& run : one.runs) {
              if (run.reached_end) runs.add(run);
            }
          }
          fmt::print("{:<18} {:>6} {:>6} {:>9} {:>8} {:>9}   {}\n", "method", "runs", "ended",
                     "largest", "median", "above 20", "plain: largest, median, above 20");
          for (const M& sum : by_method(results)) {
            sums.add(sum);
            fmt::print(
                "{:<18} {:>6} {:>6} {:>9.3g} {:>8.2g} {:>8.2f}%   {:>9.3g} {:>8.2g} {:>8.2f}%\n",
                sum.method, sum.runs, sum.ended_early, sum.largest, sum.median, sum.share,
                sum.plain_largest, sum.plain_median, sum.plain_share);
          }
        });
  };
  return p.run(argc, argv, [&] {
    for (const auto& [is_given, option] :
         {std::pair(bool(rules), "--rules"), {bool(samples), "--samples"}}) {
      if (is_given && !hard)
        throw InvalidInput(fmt::format("{} is given without --hard, which it belongs to", option));
    }
    if (rules && samples)
      throw InvalidInput("--rules and --samples are given together: take one of them");
    return samples ? judge_samples()
           : rules ? judge_rules()
           : hard  ? judge_hard_cases()
                   : judge_cases();
  });
}
