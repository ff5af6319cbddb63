// What a factorisation of M - h^2 K and a solve with it cost, by solver, against what the machine
// can do.
//
//   solvers --scene cloth --no-reduce mirror --out results/cloth
//
//  1. K is the scene's at its start. Each solver analyses the pattern once (analysis_s), and is
//     checked: |A x - b| of its solution must be rounding.
//  2. Solvers run by turns, --repeats times, on as many threads as OMP_NUM_THREADS says;
//     factorization_s and solve_s are those of the fastest sample, which neighbours disturb least;
//     a sample is several calls where one is short.
//  3. gflops: a solver's own operations over its time; gigabytes_per_second: its factors, read once
//     forward and once back, over the time of a solve. The row `machine` has one thread's limits:
//     a dense product's operations a second, and the rate of reading as many bytes as the
//     multifrontal solver's factors have. solvers.csv holds a row for each solver.
#include <algorithm>
#include <cmath>
#include <limits>
#include <omp.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/command_line.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/entry.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/solvers/direct_solvers.hpp"
#include "experiments/solvers/product_flops.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/machine_limits.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::solvers {
namespace {

struct Arguments {
  SceneChoice scene;
  std::vector<std::string> solvers;
  std::string out;
  double step_size = 1e-3;
  int repeats = 20;
};

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option("--solvers", a.solvers,
                  "a,b,...: the solvers, of multifrontal, cholmod, eigen, klu (default: all)")
      .delimiter(',');
  line.add_option("--step-size", a.step_size, "the step size h of M - h^2 K in s")
      .take_last()
      .capture_default_str();
  line.add_option("--repeats", a.repeats, "timed samples of each solver")
      .take_last()
      .capture_default_str();
  line.add_option("--out", a.out, "the folder for solvers.csv");
}

std::vector<DirectSolverKind> select_solvers(const std::vector<std::string>& names) {
  if (names.empty()) return direct_solvers();
  std::vector<DirectSolverKind> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(direct_solvers(), name, &DirectSolverKind::name);
    if (found == direct_solvers().end()) {
      std::vector<std::string> all;
      for (const auto& kind : direct_solvers()) all.push_back(kind.name);
      throw InvalidInput(
          fmt::format("--solvers: {} is not a solver; allowed are {}", name, fmt::join(all, ", ")));
    }
    if (std::ranges::count(chosen, name, &DirectSolverKind::name) > 0)
      throw InvalidInput(fmt::format("--solvers: {} is named twice; allowed is once", name));
    chosen.push_back(*found);
  }
  return chosen;
}

// A solver and its measured times.
class Contender {
 public:
  Contender(const DirectSolverKind& kind, const System& system, double s, const SymmetricMatrix& k)
      : name_(kind.name), s_(s), k_(k), b_(Vec::LinSpaced(system.size(), -1, 2)), x_(b_) {
    analysis_ = seconds_of([&] { solver_ = kind.make(system); });
    solved_ = solver_->factorize(s, k);
    if (!solved_) return;
    solver_->solve(b_, x_);
    const SymmetricMatrix whole = k.selfadjointView<Eigen::Lower>();
    const Vec product = system.mass().cwiseProduct(x_) - s * (whole * x_);
    residual_ = (product - b_).cwiseAbs().maxCoeff();
    factorizations_ = calls_in_a_sample([&] { solver_->factorize(s_, k_); });
    solves_ = calls_in_a_sample([&] { solver_->solve(b_, x_); });
  }

  // The seconds of a factorisation and of a solve; empty if the matrix is singular for the solver.
  std::vector<double> sample() {
    if (!solved_) return {};
    return {time_of(factorizations_, [&] { solver_->factorize(s_, k_); }),
            time_of(solves_, [&] { solver_->solve(b_, x_); })};
  }
  void take(const std::vector<double>& sample) {
    if (sample.empty()) return;
    factorization_.push_back(sample[0]);
    solve_.push_back(sample[1]);
  }

  void report(Csv& csv, const std::string& scene) const {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    const auto known = [&](double x) { return x > 0 ? x : nothing; };
    const double factorization =
        has_samples() ? *std::ranges::min_element(factorization_) : nothing;
    const double solve = has_samples() ? *std::ranges::min_element(solve_) : nothing;
    const double gflops = known(1e-9 * solver_->flops / factorization);
    const double rate = known(2e-9 * solver_->bytes / solve);
    csv.row(scene, b_.size(), name_, analysis_, factorization, solve, gflops, rate,
            known(solver_->bytes), solved_ ? residual_ : nothing);
    if (!solved_) {
      fmt::print("{:<13} it finds the matrix singular\n", name_);
      return;
    }
    const auto number = [](double x) { return std::isnan(x) ? "" : fmt::format("{:.1f}", x); };
    fmt::print("{:<13} {:>9.2f} {:>10.3f} {:>9.4f} {:>9} {:>7} {:>9}   {:.0e}\n", name_,
               1e3 * analysis_, 1e3 * factorization, 1e3 * solve, number(gflops), number(rate),
               number(1e-6 * known(solver_->bytes)), residual_);
  }

  double bytes() const { return solver_->bytes; }
  const std::string& name() const { return name_; }
  bool has_samples() const { return !factorization_.empty(); }

 private:
  // Calls as many times as take about a millisecond.
  template <class Call>
  static int calls_in_a_sample(const Call& call) {
    return std::clamp(static_cast<int>(1e-3 / seconds_of(call)), 1, 1000);
  }
  template <class Call>
  static double time_of(int calls, const Call& call) {
    call();  // reloads the caches after the other solvers
    return seconds_of([&] {
             for (int i = 0; i < calls; ++i) call();
           }) /
           calls;
  }

  std::string name_;
  double s_;
  const SymmetricMatrix& k_;
  Vec b_, x_;
  std::unique_ptr<DirectSolver> solver_;
  bool solved_;
  double analysis_, residual_;
  int factorizations_, solves_;
  std::vector<double> factorization_, solve_;
};

int solvers(const CommandLine& line, const Arguments& a,
            const std::vector<std::string>& command_line) {
  require_given(a.out, "--out", "the folder for the results");
  require_step_size(a.step_size, "--step-size");
  require_repeats(a.repeats);
  const auto kinds = select_solvers(a.solvers);
  const Scene drawn = load(a.scene);
  const Scene start = started(drawn, a.scene);
  const ReducedScene scene(start, reductions_of(a.scene));
  const System& system = scene.system();
  if (system.size() == 0) {
    throw InvalidInput(
        fmt::format("{}: it has no unknowns, so that there is no matrix; allowed are scenes with "
                    "free nodes on springs",
                    a.scene.name));
  }
  require_folder(a.out);
  Study study(
      line, a.out, {"solvers.csv"},
      {{"scene", content_hash(drawn)}, {"name", drawn.name}, {"threads", omp_get_max_threads()}});
  if (const auto status = study.completed()) return *status;
  CsvFile csv(a.out + "/solvers.csv",
              {"scene", "unknowns", "solver", "analysis_s", "factorization_s", "solve_s", "gflops",
               "gigabytes_per_second", "bytes", "residual"});
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(scene.initial().q, k);

  std::vector<Contender> contenders;
  study.measure([&] {
    for (const auto& kind : kinds) {
      stop_if_interrupted();
      contenders.emplace_back(kind, system, a.step_size * a.step_size, k);
    }
    for (int i = 0; i < a.repeats; ++i) {
      for (std::size_t c = 0; c < contenders.size(); ++c) {
        const auto sample = study.piece(fmt::format("{} {}", contenders[c].name(), i),
                                        [&] { return nlohmann::json(contenders[c].sample()); });
        contenders[c].take(sample);
      }
    }
  });

  fmt::print("{}, {} unknowns, {} threads\n", drawn.name, system.size(), omp_get_max_threads());
  fmt::print("{:<13} {:>9} {:>10} {:>9} {:>9} {:>7} {:>9}   {}\n", "ms", "analysis", "factorise",
             "solve", "GFlop/s", "GB/s", "factor MB", "residual");
  for (const Contender& contender : contenders) contender.report(csv, drawn.name);
  if (!contenders.empty()) {
    constexpr double look = 0.1;  // seconds in which each of the machine's limits is measured
    const double gflops = 1e-9 * product_flops(look), bytes = contenders.front().bytes();
    const double rate = 1e-9 * reading_rate(bytes, look),
                 nothing = std::numeric_limits<double>::quiet_NaN();
    csv.row(drawn.name, system.size(), "machine", nothing, nothing, nothing, gflops, rate, bytes,
            nothing);
    fmt::print("{:<43} {:>9.1f} {:>7.1f}\n", "one thread of the machine", gflops, rate);
  }
  nlohmann::json origin = provenance(command_line, drawn, start, scene);
  origin["step_size"] = a.step_size;
  origin["threads"] = omp_get_max_threads();
  return study.finish({&csv}, origin, done);
}

}  // namespace
}  // namespace qddot::solvers

int main(int argc, char** argv) {
  using namespace qddot::solvers;
  return qddot::kit::enter<Arguments>(
      {.name = "solvers",
       .summary = "Measures direct solvers of M - h^2 K against each other and the machine.",
       .has_threads = true,
       .has_resume = true},
      declare, solvers, argc, argv);
}
