// The gain of SUNDIALS' implicit methods by the second-order structure. Each of them runs with
// the n x n matrix M - gamma^2 K, and as its users run it, with KLU on 2n x 2n.
//
//   stock_sundials --scene cloth --until 0.1 --out results/cloth
//   stock_sundials --scene lattice --methods arkode_dirk4,cvode_bdf --rtol 1e-5 --out results/l
//
//  1. Both variants solve the same equations to the same tolerances and, except for rounding, in
//     the same steps. Errors are against work_precision's reference.
//  2. They run by turns, each once untimed and then --repeats times, on one thread. The ratio is
//     the median of the ratios of all pairs of runs.
//  3. One more run of each measures where its time goes: force, K, factorisation, solves, and
//     SUNDIALS itself with its vectors (rest). structure.csv has a row for each method and
//     tolerance.
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/points.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/reference_file.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::stock_sundials {

// An implicit method of SUNDIALS with n x n solves, and as its users run it.
struct Pair {
  const Method* structured;
  const Method* stock;
};

// The runs of one of the two.
struct Way {
  static constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

  Outcome outcome{};
  double seconds = nothing;  // the median of the timed runs
  double error = nothing;    // of the positions at the end
  Counts counts{};
  // Parts of a run's time: force, K, factorisation, solves, and the rest.
  std::array<double, 5> shares{nothing, nothing, nothing, nothing, nothing};
};

// The two at one tolerance; numbers are missing unless both reached the end.
struct PairedRuns {
  std::string scene, method;
  double rtol = 0;
  Way structured{}, stock{};
  double ratio = Way::nothing;  // the median of stock over structured times

  bool is_good() const {
    return structured.outcome == Outcome::reached_end && stock.outcome == Outcome::reached_end;
  }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Way, outcome, seconds, error, counts, shares)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PairedRuns, scene, method, rtol, structured, stock, ratio)

namespace {

// One method at one tolerance, run again and again.
class Runs {
 public:
  Runs(const Method& method, double rtol, const Subject& subject, double limit)
      : method_(method),
        scene_(subject.reduced),
        until_(subject.until),
        limit_(limit),
        options_(options_for(method, rtol, scene_)),
        integrator_(make_integrator(method, scene_.system(), options_)) {}

  // The seconds of one run, set-up left out.
  double once() {
    const Deadline deadline(limit_);
    state_ = scene_.initial();
    return seconds_of(
        [&] { summary_ = integrator_->advance(state_, until_, {}, deadline.token()); });
  }
  bool has_reached_end() const { return summary_.outcome == Outcome::reached_end; }

  // The outcome, error and counts of the last run.
  Way way(const Reference& reference) const {
    Way way{.outcome = summary_.outcome, .counts = summary_.counts};
    if (has_reached_end())
      way.error = errors_between(scene_, state_, reference.end, reference.energy, reference.scales)
                      .position;
    return way;
  }

  // The parts of a run that is slowed by clocks.
  std::array<double, 5> shares() {
    options_.timed = true;
    integrator_ = make_integrator(method_, scene_.system(), options_);
    const double all = once();
    const auto& [force, stiffness, factorization, solve] = summary_.seconds;
    std::array shares = {force / all, stiffness / all, factorization / all, solve / all, 1.0};
    for (std::size_t i = 0; i < 4; ++i) shares[4] -= shares[i];
    return shares;
  }

 private:
  const Method& method_;
  const ReducedScene& scene_;
  double until_, limit_;
  Options options_;
  std::unique_ptr<Integrator> integrator_;
  State state_;
  Summary summary_;
};

// The methods of that name with their stock ways, or all that can run the scene. Throws
// InvalidInput for a method without one.
std::vector<Pair> select_pairs(const std::vector<std::string>& names, const Subject& subject) {
  std::vector<Pair> pairs;
  for (const Method* method : select_methods(names, subject)) {
    const auto stock = std::ranges::find(methods(), method->name, &Method::stock_of);
    if (stock != methods().end()) {
      pairs.push_back({method, &*stock});
    } else if (!names.empty()) {
      std::vector<std::string> allowed;
      for (const Method& m : methods()) {
        if (!m.stock_of.empty()) allowed.push_back(m.stock_of);
      }
      throw InvalidInput(fmt::format("--methods: {} has no stock way beside it; allowed are {}",
                                     method->name, fmt::join(allowed, ", ")));
    }
  }
  return pairs;
}

// Runs both by turns, once untimed and then `effort.repeats` times, and once more by the clocks of
// their parts.
PairedRuns paired_runs(const Subject& subject, const Pair& pair, double rtol,
                       const Reference& reference, const Effort& effort) {
  Runs structured(*pair.structured, rtol, subject, effort.seconds);
  Runs stock(*pair.stock, rtol, subject, effort.seconds);
  structured.once();
  stock.once();
  std::vector<double> structured_times, stock_times, ratios;
  const auto have_both = [&] { return structured.has_reached_end() && stock.has_reached_end(); };
  for (int i = 0; have_both() && i < effort.repeats; ++i) {
    structured_times.push_back(structured.once());
    stock_times.push_back(stock.once());
    ratios.push_back(stock_times.back() / structured_times.back());
  }
  PairedRuns runs{.scene = subject.drawn.name,
                  .method = pair.structured->name,
                  .rtol = rtol,
                  .structured = structured.way(reference),
                  .stock = stock.way(reference)};
  if (!runs.is_good()) return runs;
  runs.structured.seconds = median(structured_times);
  runs.stock.seconds = median(stock_times);
  runs.ratio = median(ratios);
  runs.structured.shares = structured.shares();
  runs.stock.shares = stock.shares();
  return runs;
}

void write(Csv& csv, const PairedRuns& r) {
  const auto& [outcome, seconds, error, counts, shares] = r.structured;
  const Way& stock = r.stock;
  csv.row(r.scene, r.method, r.rtol, name(outcome), name(stock.outcome), seconds, stock.seconds,
          r.ratio, error, stock.error, counts.steps, stock.counts.steps, counts.newton_iterations,
          counts.stiffness_evaluations, counts.factorizations, stock.counts.factorizations,
          counts.indefinite_factorizations, shares[0], shares[1], shares[2], shares[3], shares[4],
          stock.shares[0], stock.shares[1], stock.shares[2], stock.shares[3], stock.shares[4]);
}

void print_header(const Subject& subject) {
  fmt::print("{}, {} unknowns, until {:g} s; shares in %: force K factorisation solve rest\n",
             subject.drawn.name, subject.system().size(), subject.until);
  fmt::print("{:<13} {:>6} {:>9} {:>9} {:>6}  {:<15} {:>6} {:>5}  {:<14}  {}\n", "method", "rtol",
             "stock s", "n x n s", "ratio", "errors", "steps", "fact.", "stock", "n x n");
}

void print(const PairedRuns& r) {
  if (!r.is_good()) {
    fmt::print("{:<13} {:>6.0e}  {}, stock {}\n", r.method, r.rtol, name(r.structured.outcome),
               name(r.stock.outcome));
    return;
  }
  const auto percent = [](const Way& way) {
    std::string text;
    for (const double share : way.shares)
      text += fmt::format("{}{:2.0f}", text.empty() ? "" : " ", 100 * share);
    return text;
  };
  fmt::print("{:<13} {:>6.0e} {:>9.4f} {:>9.4f} {:>6.2f}  {:.1e} {:.1e} {:>6} {:>5}  {}  {}\n",
             r.method, r.rtol, r.stock.seconds, r.structured.seconds, r.ratio, r.stock.error,
             r.structured.error, r.structured.counts.steps, r.structured.counts.factorizations,
             percent(r.stock), percent(r.structured));
}

}  // namespace
}  // namespace qddot::stock_sundials

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::stock_sundials;
  Program p({.name = "stock_sundials",
             .summary =
                 "Measures what SUNDIALS' implicit methods gain from n x n solves, against stock "
                 "KLU.",
             .has_threads = true,
             .has_resume = true});
  auto choice = p.scene();
  auto until = p.until();
  auto names =
      p.methods("a,b,...: the methods, of those that also have a stock way, _klu (default: all)");
  auto rtols = p.numbers("--rtol", {1e-3, 1e-5, 1e-7}, "a,b,...: relative tolerances")
                   .check_each(require_rtol);
  auto repeats = p.whole("--repeats", 3, "timed pairs of runs").last().within(1, 1000);
  auto limit = p.number("--point-limit", 120, "seconds that one run may take")
                   .last()
                   .positive("the seconds a run may take");
  p.out("the folder for structure.csv and reference.json");
  auto& table = p.table("structure.csv", {"scene",
                                          "method",
                                          "rtol",
                                          "outcome",
                                          "stock_outcome",
                                          "structured_s",
                                          "stock_s",
                                          "ratio",
                                          "structured_error",
                                          "stock_error",
                                          "steps",
                                          "stock_steps",
                                          "newton_iterations",
                                          "stiffness_evaluations",
                                          "factorizations",
                                          "stock_factorizations",
                                          "indefinite_factorizations",
                                          "structured_force",
                                          "structured_stiffness",
                                          "structured_factorization",
                                          "structured_solve",
                                          "structured_rest",
                                          "stock_force",
                                          "stock_stiffness",
                                          "stock_factorization",
                                          "stock_solve",
                                          "stock_rest"});
  return p.run(argc, argv, [&] {
    const Subject subject = subject_of(choice, until);
    require_reference_exists(subject);
    const auto pairs = select_pairs(names, subject);
    nlohmann::json origin = p.origin(subject);
    origin["until"] = subject.until;
    return p.study(
        subject.about(),
        [&](Study& study) {
          const Reference reference = reference_for(subject, p.folder(), origin);
          print_header(subject);
          for (const Pair& pair : pairs) {
            for (const double rtol : *rtols) {
              const PairedRuns runs =
                  study.piece(fmt::format("{} {:.17g}", pair.structured->name, rtol), [&] {
                    return nlohmann::json(paired_runs(subject, pair, rtol, reference,
                                                      {.seconds = limit, .repeats = repeats}));
                  });
              write(*table, runs);
              print(runs);
            }
          }
        },
        [&] { return origin; });
  });
}
