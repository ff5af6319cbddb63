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
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/accuracy_choice.hpp"
#include "experiments/kit/columns.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/scene/explain.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::advise_program {
namespace {

struct Arguments {
  SceneChoice scene;
  std::string out, accuracy_of;
  double until = 0;
  std::vector<double> accuracies;
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option("--until", a.until, "the time to run to in s (default: the scene's own)");
  line.add_option("--accuracy", a.accuracies,
                  "a,b,...: relative errors that the motion may have, from 1e-14 to below 1")
      .delimiter(',');
  add_accuracy_of_option(line, a.accuracy_of);
  line.add_option("--out", a.out, "the folder for advice.csv");
}

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

std::string beside(const std::optional<Candidate>& other, const Advice& advice) {
  if (!other || !advice.take) return "";
  if (other->method == advice.take->method) return "the one to take";
  return fmt::format("{} {:.3g} x", other->method->name, other->seconds / advice.take->seconds);
}

std::string word_option(const std::string& word) {
  const bool is_plain = word.find_first_not_of(
                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                            "._/-") == std::string::npos;
  if (is_plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void print_scene(const Advices& all, const Scene& start, const ReducedScene& scene, double until) {
  fmt::print("{} to t = {:g} s, in {} and {} runs\n", in_one_line(start.name), until,
             time_in_words(all.seconds), all.runs);
  if (std::isfinite(all.largest_stable_step)) {
    fmt::print(
        "w_max = {:.5g} rad/s at the start, up to {:.5g} on the way: verlet is stable up to h = "
        "{:.4g} s\n",
        all.w_start, all.w_motion, all.largest_stable_step);
  }
  if (all.own_frequency > 0) {
    fmt::print("the motion's own frequency is {:.4g} rad/s, 1/{:.3g} of that\n", all.own_frequency,
               all.w_motion / all.own_frequency);
  }
  const Explanation explanation = explain(start, scene, at_a_glance);
  if (explanation.unstable > 0) {
    fmt::print("compressed springs push to the side in {} directions{}\n", explanation.unstable,
               explanation.growth > 0 ? fmt::format(", as exp({:.3g} t)", explanation.growth) : "");
  }
  if (all.lyapunov > 0) {
    fmt::print(
        "the motion is chaotic: runs part as exp({:.3g} t), and nobody knows positions from t = "
        "{:.3g} s on\n",
        all.lyapunov, all.horizon);
  }
}

void print_advice(const Advices& all, const Arguments& a, double until) {
  constexpr const char* row = "{:<9} {:<18} {:<16} {:>8}  {:>8}  {:<26} {:<26} {:<26} {}\n";
  fmt::print("\n");
  fmt::print(fmt::runtime(row), "accuracy", "take", "knob", "error", "time", "next",
             "best own explicit", "best own implicit", "best of SUNDIALS");
  for (const Advice& advice : all.for_each) {
    if (!advice.take) {
      fmt::print("{:<9.1e} none: {}\n", advice.accuracy, advice.why);
      continue;
    }
    const Candidate& take = *advice.take;
    fmt::print(fmt::runtime(row), fmt::format("{:.1e}", advice.accuracy), take.method->name,
               knob_in_words(*take.method, take.value),
               fmt::format("{:.1e}{}", take.error, advice.is_seen ? " " : "?"),
               time_in_words(take.seconds), beside(advice.runner_up, advice),
               beside(advice.own_explicit, advice), beside(advice.own_implicit, advice),
               beside(advice.sundials, advice));
  }
  fmt::print(
      "? expected, not measured; N x: N times as long (other methods: mostly expected); times are "
      "of one run, without set-up\n\n");
  std::string last;
  for (const Advice& advice : all.for_each) {
    if (!advice.take) continue;
    const Candidate& take = *advice.take;
    const std::string reductions =
        a.scene.no_reduce.empty()
            ? ""
            : fmt::format(" --no-reduce {}", fmt::join(a.scene.no_reduce, ","));
    const std::string command =
        fmt::format("simulate --scene {}{} --until {} --method {} --{} {} --final end.csv",
                    word_option(a.scene.name), reductions, until, take.method->name,
                    take.method->knob == Knob::step_size ? "step-size" : "rtol", take.value);
    if (command != last) fmt::print("{}\n", command);
    last = command;
  }
}

int answer(const CommandLine& line, const Arguments& a,
           const std::vector<std::string>& command_line) {
  if (a.accuracies.empty()) {
    throw InvalidInput(
        "--accuracy is missing; it is a,b,...: relative errors from 1e-14 to below 1");
  }
  for (const double accuracy : a.accuracies) require_allowed_accuracy(accuracy);
  if (line.has("--out")) require_given(a.out, "--out", "the folder for the results");
  const AccuracyOf of = accuracy_of(a.accuracy_of);
  const Scene drawn = load(a.scene);
  const double until = end_time(a.until, line.has("--until"), drawn);
  const Scene start = started(drawn, a.scene);
  const ReducedScene scene(start, reductions_of(a.scene));
  std::unique_ptr<CsvFile> csv;
  if (!a.out.empty()) {
    require_folder(a.out);
    csv = std::make_unique<CsvFile>(a.out + "/advice.csv", advice_columns().header());
  }
  progress().stage("looking for the fastest methods");
  const Advices all = measure::advise(scene, until, a.accuracies, of);
  progress().wipe();
  print_scene(all, start, scene, until);
  print_advice(all, a, until);
  if (csv) {
    for (const Advice& advice : all.for_each) advice_columns().write_row(*csv, advice);
    nlohmann::json origin = provenance(command_line, drawn, start, scene);
    origin["until"] = until;
    origin["accuracy_of"] = a.accuracy_of.empty() ? "positions" : a.accuracy_of;
    origin["runs"] = all.runs;
    origin["seconds"] = all.seconds;
    csv->commit(origin);
  }
  const bool is_answered = std::ranges::all_of(
      all.for_each, [](const Advice& advice) { return advice.take.has_value(); });
  return is_answered ? done : end_not_reached;
}

}  // namespace
}  // namespace qddot::advise_program

int main(int argc, char** argv) {
  using namespace qddot::advise_program;
  return qddot::kit::enter<Arguments>(
      {.name = "advise",
       .summary = "Says which integrator to take for a scene and an accuracy.",
       .has_threads = true},
      declare, answer, argc, argv);
}
