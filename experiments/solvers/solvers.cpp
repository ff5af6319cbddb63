// The cost of a factorisation of M - h^2 K and of a solve with it, by solver, beside what the
// machine can do.
//
//   solvers --scene cloth --no-reduce mirror --out results/cloth
//
//  1. K is the scene's at its start. Each solver analyses the pattern once (analysis_s), and is
//     checked: |A x - b| of its solution must be rounding.
//  2. Solvers run by turns, --repeats times, on as many threads as OMP_NUM_THREADS says.
//     factorization_s and solve_s are those of the fastest sample, which neighbours disturb least.
//     A sample is several calls where one is short.
//  3. gflops: a solver's own operations over its time; gigabytes_per_second: its factors, read once
//     forward and once back, over the time of a solve. The row `machine` has one thread's limits:
//     a dense product's operations a second, and the rate of reading as many bytes as the
//     multifrontal solver's factors have. solvers.csv holds a row for each solver.
//  4. CHOLMOD and the dense product run OpenBLAS's code for one processor, which the sidecar names
//     (`blas`). The output names a faster one where this processor has wider vectors.
#include <cmath>
#include <omp.h>

#include <fmt/format.h>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/blas.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/solvers/direct_solvers.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/speed/machine_limits.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::solvers {
namespace {

std::vector<DirectSolverKind> select_solvers(const std::vector<std::string>& names) {
  if (names.empty()) return direct_solvers();
  std::vector<DirectSolverKind> chosen;
  for (const std::string& name : names) {
    chosen.push_back(
        named(name, direct_solvers(), &DirectSolverKind::name, "--solvers", "a solver"));
  }
  return chosen;
}

void require_unknowns(const Subject& subject) {
  if (subject.system().size() > 0) return;
  throw InvalidInput(
      fmt::format("{}: it has no unknowns, so that there is no matrix; allowed are scenes with "
                  "free nodes on springs",
                  subject.source));
}

void print(const SolverRow& row) {
  const auto number = [](double x) { return std::isnan(x) ? "" : fmt::format("{:.1f}", x); };
  fmt::print("{:<13} {:>9.2f} {:>10.3f} {:>9.4f} {:>9} {:>7} {:>9}   {:.0e}\n", row.solver,
             1e3 * row.analysis, 1e3 * row.factorization, 1e3 * row.solve, number(row.gflops),
             number(row.gigabytes_per_second), number(1e-6 * row.bytes), row.residual);
}

// The limits of one thread, each found in `look` seconds.
SolverRow machine(const Subject& subject, double bytes) {
  constexpr double look = 0.1;
  SolverRow row{.scene = subject.drawn.name,
                .unknowns = subject.system().size(),
                .solver = "machine",
                .gflops = 1e-9 * product_flops(look),
                .gigabytes_per_second = 1e-9 * reading_rate(bytes, look),
                .bytes = bytes};
  fmt::print("{:<43} {:>9.1f} {:>7.1f}\n", "one thread of the machine", row.gflops,
             row.gigabytes_per_second);
  return row;
}

// Says so if OpenBLAS runs its code for processors with narrower vectors.
void advise_core() {
  const std::string core = blas_core();
  const std::string_view wider = wider_core(core, vector_bits());
  if (wider.empty()) return;
  fmt::print(
      "OpenBLAS runs its code for a {0}, whose vectors are narrower than this processor's: "
      "CHOLMOD and the limit of one thread are faster with OPENBLAS_CORETYPE={1}\n",
      core, wider);
}

}  // namespace
}  // namespace qddot::solvers

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::solvers;
  Program p("solvers", "Measures direct solvers of M - h^2 K against each other and the machine.",
            {has_threads, has_resume});
  auto choice = p.scene();
  auto names = p.words("--solvers",
                       "a,b,...: the solvers, of multifrontal, cholmod, eigen, klu (default: all)")
                   .check(require_each_once<std::string>);
  auto step_size =
      p.number("--step-size", 1e-3, "the step size h of M - h^2 K in s")
          .last()
          .check([](double h, const std::string& option) { require_step_size(h, option); });
  auto repeats = p.whole("--repeats", 20, "timed samples of each solver").last().within(1, 1000);
  auto& table =
      p.table<SolverRow>("solvers.csv", {{"scene", &SolverRow::scene},
                                         {"unknowns", &SolverRow::unknowns},
                                         {"solver", &SolverRow::solver},
                                         {"analysis_s", &SolverRow::analysis},
                                         {"factorization_s", &SolverRow::factorization},
                                         {"solve_s", &SolverRow::solve},
                                         {"gflops", &SolverRow::gflops},
                                         {"gigabytes_per_second", &SolverRow::gigabytes_per_second},
                                         {"bytes", &SolverRow::bytes},
                                         {"residual", &SolverRow::residual}});
  return p.run(argc, argv, [&] {
    const auto kinds = select_solvers(names);
    const Subject subject = subject_of(choice);
    require_no_rods(subject.drawn, subject.source, "steps of implicit methods do not keep them");
    require_unknowns(subject);
    const System& system = subject.system();
    const int threads = omp_get_max_threads();
    SymmetricMatrix k = system.stiffness_pattern();
    std::vector<Contender> contenders;
    nlohmann::json about = subject.about();
    about["threads"] = threads;
    about["blas"] = blas();
    return p.study(
        about,
        [&](Study& study) {
          system.stiffness(subject.model.initial().q, k);
          for (const auto& kind : kinds) {
            stop_if_interrupted();
            contenders.emplace_back(kind, system, step_size * step_size, k);
          }
          for (int i = 0; i < repeats; ++i) {
            for (Contender& one : contenders)
              one.take(study.piece(fmt::format("{} {}", one.name(), i),
                                   [&] { return nlohmann::json(one.sample()); }));
          }
        },
        [&] {
          fmt::print("{}, {} unknowns, {} threads\n", subject.drawn.name, system.size(), threads);
          fmt::print("{:<13} {:>9} {:>10} {:>9} {:>9} {:>7} {:>9}   {}\n", "ms", "analysis",
                     "factorise", "solve", "GFlop/s", "GB/s", "factor MB", "residual");
          for (const Contender& one : contenders) {
            const SolverRow row = one.row(subject.drawn.name);
            table.add(row);
            if (one.has_solved())
              print(row);
            else
              fmt::print("{:<13} it finds the matrix singular\n", one.name());
          }
          if (!contenders.empty()) table.add(machine(subject, contenders.front().bytes()));
          advise_core();
          nlohmann::json origin = p.origin(subject);
          origin["step_size"] = *step_size;
          origin["threads"] = threads;
          return origin;
        });
  });
}
