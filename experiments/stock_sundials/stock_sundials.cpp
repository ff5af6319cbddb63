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
#include <string>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/reference_file.hpp"
#include "experiments/stock_sundials/paired_runs.hpp"

namespace qddot::stock_sundials {
namespace {

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
  Program p("stock_sundials",
            "Measures what SUNDIALS' implicit methods gain from n x n solves, against stock KLU.",
            {has_threads, has_resume});
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
  auto& table =
      p.table("structure.csv",
              columns_in("scene method rtol outcome stock_outcome structured_s stock_s ratio "
                         "structured_error stock_error steps stock_steps newton_iterations "
                         "stiffness_evaluations factorizations stock_factorizations "
                         "indefinite_factorizations structured_force structured_stiffness "
                         "structured_factorization structured_solve structured_rest stock_force "
                         "stock_stiffness stock_factorization stock_solve stock_rest"));
  return p.run(argc, argv, [&] {
    const Subject subject = subject_of(choice, until);
    require_no_rods(subject.drawn, subject.source, "one way alone of SUNDIALS keeps them");
    require_reference_exists(subject);
    const auto pairs = select_pairs(names, subject);
    const auto origin = p.origin(subject);
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
