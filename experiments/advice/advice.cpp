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
#include <exception>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/advice/case_result.hpp"
#include "experiments/advice/step_costs.hpp"
#include "experiments/advice/worth.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/study.hpp"

namespace qddot::advice_study {
namespace {

constexpr int most_cases = 100000, most_jobs = 256, first_unseen = 11000000, last = 2000000000;

struct Arguments {
  std::string out;
  int cases = 400, first = first_unseen, repeats = 3, jobs = 1;
  double reference_seconds = 5;
  bool step_costs = false;
};

void declare(CommandLine& line, Arguments& a) {
  line.add_option("--cases", a.cases, "number of cases").capture_default_str();
  line.add_option("--first", a.first,
                  "the number of the first case; the search was tuned on cases below 11000000")
      .capture_default_str();
  line.add_option("--repeats", a.repeats, "timed runs of the best and of the chosen run")
      .capture_default_str();
  line.add_option("--jobs", a.jobs, "cases at a time, each on a core of its own")
      .capture_default_str();
  line.add_option("--reference-seconds", a.reference_seconds,
                  "approximate number of seconds that a reference may take")
      .capture_default_str();
  line.add_flag("--step-costs", a.step_costs,
                "instead, time a step of each method at four sizes, into step_costs.csv");
  line.add_option("--out", a.out, "the folder for cases.csv and worth.csv");
}

std::vector<std::uint64_t> numbers_of(const Arguments& a) {
  std::vector<std::uint64_t> numbers(static_cast<std::size_t>(a.cases));
  std::iota(numbers.begin(), numbers.end(), static_cast<std::uint64_t>(a.first));
  return numbers;
}

std::string share_of(std::uint64_t number) { return fmt::format("{}", number); }

Shares shares_of(const std::vector<std::uint64_t>& numbers) {
  Shares shares{.chosen_by = {"--cases", "--first"}};
  for (const std::uint64_t number : numbers) shares.names.push_back(share_of(number));
  return shares;
}

int step_costs(const Arguments& a, const std::vector<std::string>& command_line) {
  require_folder(a.out);
  CsvFile csv(a.out + "/step_costs.csv", {"method", "unknowns", "steps_of_verlet"});
  for (const MeasuredCost& cost : measured_costs()) {
    fmt::print("{:<26}", cost.method->name);
    for (std::size_t i = 0; i < sizes_of_costs.size(); ++i) {
      csv.row(cost.method->name, sizes_of_costs[i], cost.steps[i]);
      fmt::print(" {:>8.3g}", cost.steps[i]);
    }
    fmt::print("\n");
  }
  csv.commit(provenance(command_line));
  return done;
}

int advice(const CommandLine& line, const Arguments& a,
           const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  require_within(a.cases, 1, most_cases, "--cases");
  require_within(a.first, 0, last, "--first");
  require_repeats(a.repeats);
  require_within(a.jobs, 1, most_jobs, "--jobs");
  require_positive(a.reference_seconds, "--reference-seconds", "the seconds of a reference");
  if (a.step_costs) return step_costs(a, command_line);
  std::vector<std::uint64_t> numbers = numbers_of(a);
  Study study(line, a.out, {"cases.csv", "worth.csv"}, {{"code", code_hash()}}, shares_of(numbers));
  if (const auto status = study.completed()) return *status;
  std::erase_if(numbers, [&](std::uint64_t number) { return !study.takes(share_of(number)); });
  CsvFile cases_csv(a.out + "/cases.csv", case_columns().header());
  CsvFile worth_csv(a.out + "/worth.csv", {"figure", "value", "cases", "meaning"});

  std::vector<CaseResult> results(numbers.size());
  study.measure([&] {
    std::exception_ptr error;
    progress().begin(results.size());
#pragma omp parallel for schedule(dynamic) num_threads(a.jobs)
    for (std::size_t i = 0; i < results.size(); ++i) {
      const std::uint64_t number = numbers[i];
      try {
        const auto record = study.piece(fmt::format("case {}", number), [&] {
          return record_of(result_of(drawn_case(number), a.reference_seconds, a.repeats));
        });
#pragma omp critical
        {
          results[i] = result_from(record);
          progress().finish(fmt::format("case {}", number));
        }
      } catch (...) {
#pragma omp critical
        error = std::current_exception();
      }
    }
    if (error) std::rethrow_exception(error);
  });
  if (study.is_share()) return study.conclude(done);
  std::erase_if(results, [](const CaseResult& result) { return result.name.empty(); });
  for (const CaseResult& result : results) case_columns().write_row(cases_csv, result);
  fmt::print("{:<24} {:>8} {:>6}  {}\n", "figure", "value", "cases", "of what");
  for (const Figure& figure : worth_of(results)) {
    worth_csv.row(figure.name, figure.value, figure.cases, figure.meaning);
    fmt::print("{:<24} {:>8.3g} {:>6}  {}\n", figure.name, figure.value, figure.cases,
               figure.meaning);
  }
  return study.finish({&cases_csv, &worth_csv}, provenance(command_line), done);
}

}  // namespace
}  // namespace qddot::advice_study

int main(int argc, char** argv) {
  using namespace qddot::advice_study;
  return qddot::kit::enter<Arguments>(
      {.name = "advice",
       .summary = "Measures how good answers are that were asked for by their accuracy.",
       .has_threads = true,
       .has_resume = true,
       .has_shares = true},
      declare, advice, argc, argv);
}
