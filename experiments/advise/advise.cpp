// Which method is the fastest for a scene and an accuracy, and with which step size or tolerance?
//
//   advise --scene cloth --until 0.1 --accuracy 1e-4
//   advise --scene my.toml --accuracy 1e-2,1e-4,1e-6 --out results/my
//
//  1. One run of Verlet's method to the end, near its limit, and short bursts from its states
//     measure the motion's own frequencies. They give the error of any fixed-step method from its
//     error on a vibration.
//  2. The advised runs are made and checked by more accurate ones, as far as time allows: half a
//     second, or about twice the advised run. Their errors correct the forecast.
//  3. advice.csv has, for each accuracy, the advised method and knob, the expected error and time,
//     and the next method with the ratio of their times.
#include "qddot/measure/advice/advise.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "experiments/advise/advice_words.hpp"
#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/program.hpp"
#include "qddot/measure/advice/lesser_answer.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::advise_program {
namespace {

// The columns of advice.csv; fields are empty if no method is advised.
const Columns<Advice>& advice_columns() {
  const auto of_take = [](auto value) {
    return [value](const Advice& advice) {
      return advice.take ? value(*advice.take) : std::numeric_limits<double>::quiet_NaN();
    };
  };
  static const Columns<Advice> columns = {
      {"accuracy", [](const Advice& advice) { return advice.accuracy; }},
      {"method",
       [](const Advice& advice) {
         return advice.take ? advice.take->method->name : std::string();
       }},
      {"knob",
       [](const Advice& advice) {
         return std::string(advice.take ? knob_name(advice.take->method->knob) : "");
       }},
      {"value", of_take([](const Candidate& take) { return take.value; })},
      {"predicted_error", of_take([](const Candidate& take) { return take.error; })},
      {"predicted_time_s", of_take([](const Candidate& take) { return take.seconds; })},
      {"runner_up",
       [](const Advice& advice) {
         return advice.runner_up ? advice.runner_up->method->name : std::string();
       }},
      {"margin", [](const Advice& advice) { return advice.margin(); }}};
  return columns;
}

// Says at which accuracies something may be left out, as `simulate --accuracy` has it.
void print_lesser(const Subject& subject, const Reductions& reductions,
                  const std::vector<double>& accuracies, AccuracyOf of) {
  for (const double accuracy : accuracies) {
    const auto found = solve_with_less(subject.start(), reductions, subject.until,
                                       {.accuracy = accuracy, .of = of});
    if (!found) continue;
    const Answer& answer = found->answer;
    const std::string how =
        found->by == Reduction::linear
            ? "as a linear motion, mode by mode, it"
            : fmt::format("with rods in place of {} stiff springs {} at {}", found->rods,
                          answer.method->name, knob_in_words(*answer.method, answer.value));
    fmt::print("{:.0e}: {} takes {}, and the error is at most {:.1e}\n", accuracy, how,
               time_in_words(answer.seconds.run), answer.error_estimate);
  }
}

}  // namespace
}  // namespace qddot::advise_program

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::advise_program;
  Program p("advise", "Says which integrator to take for a scene and an accuracy.", {has_threads});
  auto scene = p.scene();
  auto until = p.until();
  auto accuracies =
      p.numbers("--accuracy",
                "a,b,...: relative errors that the motion may have, from 1e-14 to below 1")
          .check_each(require_allowed_accuracy);
  auto of = accuracy_of_option(p);
  auto out = p.word("--out", "the folder for advice.csv")
                 .check([](const std::string& folder, const std::string& name) {
                   require_given(folder, name, "the folder for the results");
                 });
  return p.run(argc, argv, [&] {
    if (accuracies->empty()) {
      throw InvalidInput(
          "--accuracy is missing; it is a,b,...: relative errors from 1e-14 to below 1");
    }
    const AccuracyOf bounded = accuracy_of(of);
    const Subject subject = subject_of(scene, until);
    std::optional<CsvFile> csv;
    if (out.is_given()) {
      require_folder(out);
      csv.emplace(*out + "/advice.csv", advice_columns().header());
    }
    progress().stage("looking for the fastest methods");
    const Advices all = advise(subject.model, subject.until, accuracies, bounded, &subject.start());
    progress().wipe();
    print_scene(all, subject);
    print_advice(all, scene, subject.until);
    print_lesser(subject, reductions_of(*scene), accuracies, bounded);
    if (csv) {
      for (const Advice& advice : all.for_each) advice_columns().write_row(*csv, advice);
      nlohmann::json origin = p.origin(subject);
      origin["accuracy_of"] = of->empty() ? "positions" : *of;
      origin["runs"] = all.runs;
      origin["seconds"] = all.seconds;
      csv->commit(origin);
    }
    const auto missed = std::ranges::count_if(all.for_each, [](auto& one) { return !one.take; });
    if (missed == 0) return done;
    fmt::print(stderr,
               "advise: no method is known to reach {} of {} accuracies; the table says why\n",
               missed, all.for_each.size());
    return end_not_reached;
  });
}
