#include "experiments/advise/advice_words.hpp"

#include <cmath>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/program.hpp"
#include "qddot/measure/speed/chart_words.hpp"
#include "qddot/scene/explain.hpp"

namespace qddot::advise_program {
namespace {

std::string beside(const std::optional<Candidate>& other, const Advice& advice) {
  if (!other || !advice.take) return "";
  if (other->method == advice.take->method) return "the one to take";
  return fmt::format("{} {:.3g} x", other->method->name, other->seconds / advice.take->seconds);
}

// The words that call a program of this kind, as "python -m qddot ", from the environment; empty if
// a program is called by its own name.
std::string caller() {
  const char* words = std::getenv("QDDOT_CALLER");
  return words ? fmt::format("{} ", words) : "";
}

}  // namespace

void print_scene(const Advices& all, const Subject& subject) {
  fmt::print("{} to t = {:g} s, in {} and {} runs\n", in_one_line(subject.start().name),
             subject.until, time_in_words(all.seconds), all.runs);
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
  const Explanation explanation = explain(subject.start(), subject.model, at_a_glance);
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

void print_advice(const Advices& all, const SceneChoice& scene, double until) {
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
               knob_in_words(*take.method, take.value), fmt::format("{:.1e}", take.error),
               time_in_words(take.seconds), beside(advice.runner_up, advice),
               beside(advice.own_explicit, advice), beside(advice.own_implicit, advice),
               beside(advice.sundials, advice));
  }
  fmt::print(
      "error: a bound. time: of one run, without set-up; all of these runs were made. next, best: "
      "the\nnext fastest method, and the fastest of its kind; 2 x takes twice the time of the one "
      "to take.\n\n");
  std::string last;
  for (const Advice& advice : all.for_each) {
    if (!advice.take) continue;
    const Candidate& take = *advice.take;
    const std::string reductions =
        scene.no_reduce.empty() ? ""
                                : fmt::format(" --no-reduce {}", fmt::join(scene.no_reduce, ","));
    const std::string command =
        fmt::format("{}simulate --scene {}{} --until {} --method {} --{} {} --final end.csv",
                    caller(), shell_word(scene.name), reductions, until, take.method->name,
                    take.method->knob == Knob::step_size ? "step-size" : "rtol", take.value);
    if (command != last) fmt::print("{}\n", command);
    last = command;
  }
}

}  // namespace qddot::advise_program
