// What do SUNDIALS' implicit methods gain from the second-order structure? Each of them runs with
// the n x n matrix M - gamma^2 K, and as its users run it, with KLU on 2n x 2n.
//
//   stock_sundials --scene cloth --until 0.1 --out results/cloth
//   stock_sundials --scene lattice --methods arkode_dirk4,cvode_bdf --rtol 1e-5 --out results/l
//
//  1. Both variants solve the same equations to the same tolerances and, except for rounding, in
//  the
//     same steps. Errors are against work_precision's reference.
//  2. They run by turns, each once untimed and then --repeats times, on one thread. The ratio is
//  the
//     median of the ratios of all pairs of runs.
//  3. One more run of each measures where its time goes: force, K, factorisation, solves, and
//     SUNDIALS itself with its vectors (rest). structure.csv has a row for each method and
//     tolerance.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/speed/measurement.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::stock_sundials {
namespace {

struct Arguments {
  SceneChoice scene;
  std::string out;
  double until = 0;
  std::vector<std::string> methods;
  std::vector<double> rtols = {1e-3, 1e-5, 1e-7};
  Effort effort{.seconds = 120, .repeats = 3};
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option("--until", a.until, "the time to run to in s (default: the scene's own)");
  line.add_option("--methods", a.methods,
                  "a,b,...: the methods, of those that also have a stock way, _klu (default: all)")
      .delimiter(',');
  line.add_option("--rtol", a.rtols, "a,b,...: relative tolerances")
      .delimiter(',')
      .capture_default_str();
  line.add_option("--repeats", a.effort.repeats, "timed pairs of runs")
      .take_last()
      .capture_default_str();
  line.add_option("--point-limit", a.effort.seconds, "seconds that one run may take")
      .take_last()
      .capture_default_str();
  line.add_option("--out", a.out, "the folder for structure.csv and reference.json");
}

struct Pair {
  const Method* structured;
  const Method* stock;
};

const Method* stock_way_of(const Method& method) {
  const auto found = std::ranges::find(methods(), method.name, &Method::stock_of);
  return found == methods().end() ? nullptr : &*found;
}

std::vector<Pair> select_pairs(const std::vector<std::string>& names, const ReducedScene& scene,
                               const std::string& source) {
  std::vector<Pair> pairs;
  for (const Method* method : select_methods(names, scene, source)) {
    if (const Method* stock = stock_way_of(*method)) {
      pairs.push_back({method, stock});
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

// One method at one tolerance, run again and again.
class Runs {
 public:
  Runs(const Method& method, double rtol, const ReducedScene& scene, double until, double limit)
      : method_(method),
        scene_(scene),
        until_(until),
        limit_(limit),
        options_(options_for(method, rtol, scene)),
        integrator_(make_integrator(method, scene.system(), options_)) {}

  // Seconds that one run takes, set-up left out.
  double once() {
    const Deadline deadline(limit_);
    state_ = scene_.initial();
    const auto start = std::chrono::steady_clock::now();
    summary_ = integrator_->advance(state_, until_, {}, deadline.token());
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  // A run that is slowed by clocks, and what fraction of it went where.
  Seconds shares() {
    options_.timed = true;
    integrator_ = make_integrator(method_, scene_.system(), options_);
    const double all = once();
    const Seconds& s = summary_.seconds;
    return {s.force / all, s.stiffness / all, s.factorization / all, s.solve / all};
  }

  bool has_reached_end() const { return summary_.outcome == Outcome::reached_end; }
  const Summary& summary() const { return summary_; }
  const State& state() const { return state_; }

 private:
  const Method& method_;
  const ReducedScene& scene_;
  double until_, limit_;
  Options options_;
  std::unique_ptr<Integrator> integrator_;
  State state_;
  Summary summary_;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

const std::vector<std::string> columns = {"scene",
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
                                          "stock_rest"};

double rest(const Seconds& shares) {
  return 1 - shares.force - shares.stiffness - shares.factorization - shares.solve;
}

// A row of the table, and the line that is printed of it.
struct Compared {
  std::string row, line;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Compared, row, line)

Compared compare(const std::string& scene_name, const Pair& pair, double rtol,
                 const ReducedScene& scene, double until, const Reference& reference,
                 const Effort& effort) {
  Runs structured(*pair.structured, rtol, scene, until, effort.seconds);
  Runs stock(*pair.stock, rtol, scene, until, effort.seconds);
  structured.once();
  stock.once();
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> structured_times, stock_times, ratios;
  const auto have_both = [&] { return structured.has_reached_end() && stock.has_reached_end(); };
  for (int i = 0; have_both() && i < effort.repeats; ++i) {
    structured_times.push_back(structured.once());
    stock_times.push_back(stock.once());
    ratios.push_back(stock_times.back() / structured_times.back());
  }
  const bool both = have_both();  // a repeat that fails is a failure as well
  const auto error = [&](const Runs& runs) {
    if (!runs.has_reached_end()) return nothing;
    return errors_between(scene, runs.state(), reference.end, reference.energy, reference.scales)
        .position;
  };
  const Counts counts = structured.summary().counts, stock_counts = stock.summary().counts;
  const double errors[] = {error(structured), error(stock)};
  const auto outcomes = std::pair(structured.summary().outcome, stock.summary().outcome);
  const Seconds missing{nothing, nothing, nothing, nothing};
  const Seconds s = both ? structured.shares() : missing, k = both ? stock.shares() : missing;
  const double seconds = both ? median(structured_times) : nothing;
  const double stock_seconds = both ? median(stock_times) : nothing;
  const double ratio = both ? median(ratios) : nothing;
  Csv csv;
  csv.row(scene_name, pair.structured->name, rtol, name(outcomes.first), name(outcomes.second),
          seconds, stock_seconds, ratio, errors[0], errors[1], counts.steps, stock_counts.steps,
          counts.newton_iterations, counts.stiffness_evaluations, counts.factorizations,
          stock_counts.factorizations, counts.indefinite_factorizations, s.force, s.stiffness,
          s.factorization, s.solve, rest(s), k.force, k.stiffness, k.factorization, k.solve,
          rest(k));
  if (!both) {
    return {std::string(csv.text()),
            fmt::format("{:<13} {:>6.0e}  {}, stock {}\n", pair.structured->name, rtol,
                        name(outcomes.first), name(outcomes.second))};
  }
  const auto percent = [](const Seconds& x) {
    return fmt::format("{:2.0f} {:2.0f} {:2.0f} {:2.0f} {:2.0f}", 100 * x.force, 100 * x.stiffness,
                       100 * x.factorization, 100 * x.solve, 100 * rest(x));
  };
  return {std::string(csv.text()),
          fmt::format("{:<13} {:>6.0e} {:>9.4f} {:>9.4f} {:>6.2f}  {:.1e} {:.1e} {:>6} {:>5}  {}  "
                      "{}\n",
                      pair.structured->name, rtol, stock_seconds, seconds, ratio, errors[1],
                      errors[0], counts.steps, counts.factorizations, percent(k), percent(s))};
}

int stock_sundials(const CommandLine& line, const Arguments& a,
                   const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  require_positive(a.effort.seconds, "--point-limit", "the seconds a run may take");
  for (const double rtol : a.rtols) require_rtol(rtol, "--rtol");
  require_repeats(a.effort.repeats);
  const Scene drawn = load(a.scene);
  const double until = end_time(a.until, line.has("--until"), drawn);
  const Scene start = started(drawn, a.scene);
  const ReducedScene scene(start, reductions_of(a.scene));
  require_reference_exists(scene, a.scene.name);
  const auto pairs = select_pairs(a.methods, scene, a.scene.name);
  require_folder(a.out);
  Study study(line, a.out, {"structure.csv"},
              {{"scene", content_hash(drawn)}, {"name", drawn.name}, {"until", until}});
  if (const auto status = study.completed()) return *status;
  CsvFile csv(a.out + "/structure.csv", columns);
  nlohmann::json origin = provenance(command_line, drawn, start, scene);
  origin["until"] = until;
  study.measure([&] {
    const Reference reference = reference_for(drawn, start, scene, until, a.out, origin);
    fmt::print("{}, {} unknowns, until {:g} s; shares in %: force K factorisation solve rest\n",
               drawn.name, scene.system().size(), until);
    fmt::print("{:<13} {:>6} {:>9} {:>9} {:>6}  {:<15} {:>6} {:>5}  {:<14}  {}\n", "method", "rtol",
               "stock s", "n x n s", "ratio", "errors", "steps", "fact.", "stock", "n x n");
    for (const Pair& pair : pairs) {
      for (const double rtol : a.rtols) {
        const std::string name = fmt::format("{} {:.17g}", pair.structured->name, rtol);
        const Compared compared = study.piece(name, [&] {
          return nlohmann::json(compare(drawn.name, pair, rtol, scene, until, reference, a.effort));
        });
        csv.rows(compared.row);
        fmt::print("{}", compared.line);
      }
    }
  });
  return study.finish({&csv}, origin, done);
}

}  // namespace
}  // namespace qddot::stock_sundials

int main(int argc, char** argv) {
  using namespace qddot::stock_sundials;
  return qddot::kit::enter<Arguments>(
      {.name = "stock_sundials",
       .summary =
           "Measures what SUNDIALS' implicit methods gain from n x n solves, against stock KLU.",
       .has_threads = true,
       .has_resume = true},
      declare, stock_sundials, argc, argv);
}
