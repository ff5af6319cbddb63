#include "experiments/local_global/iterated_steps.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/integrators/base/compression.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::local_global {
namespace {

constexpr int most_halvings = 30;

template <bool is_clamped>
class Newton final : public Formula {
 public:
  using Formula::Formula;

  Outcome step(const State& now, double h, State& next) {
    const auto move_to = [&](const Vec& v) {
      next.v = v;
      next.q = now.q + h * v;
    };
    const auto energy = [&] {
      return system().kinetic(next.v - now.v) + system().potential(next.q);
    };
    move_to(now.v);
    compression_.start();
    double g = energy();
    for (int i = 0; i < options().iterations; ++i) {
      force(next.q, f_);
      r_ = system().mass().cwiseProduct(next.v - now.v) - h * f_;
      if (!factorize(next.q, h * h)) return Outcome::indefinite_matrix;
      matrix_.solve(r_, p_);
      ++counts().solves;
      ++counts().newton_iterations;
      v_ = next.v;
      const double slope = r_.dot(p_);
      double alpha = 1, lower = g;
      for (int halvings = 0; halvings < most_halvings; ++halvings, alpha /= 2) {
        move_to(v_ - alpha * p_);
        lower = energy();
        if (lower <= g - 1e-4 * alpha * slope) break;
        move_to(v_);
      }
      g = std::min(g, lower);
    }
    return Outcome::reached_end;
  }

 private:
  bool factorize(const Vec& q, double s) {
    const auto works = [&](double kept) {
      run_.counted().weighted_stiffness(q, kept, k_);
      ++counts().factorizations;
      return matrix_.factorize_positive(1, s, k_);
    };
    if (is_clamped) return works(0);
    compression_.harden();
    return compression_.find(works);
  }

  Vec f_{system().size()}, r_{system().size()}, p_{system().size()}, v_{system().size()};
  SymmetricMatrix k_{system().stiffness_pattern()};
  EffectiveMass matrix_{system()};
  Compression compression_;
};

template <bool is_clamped>
Method newton(const char* name, const char* summary) {
  return {.name = name,
          .summary = summary,
          .source = "Nocedal and Wright, Numerical Optimization, chapter 3",
          .traits = {Trait::implicit, Trait::accepts_massless},
          .needs = {Need::stiffness},
          .takes = {Option::iterations},
          .make = create<Newton<is_clamped>>};
}

// The steps of one solver, and what it takes before the first.
struct Solved {
  struct Step {
    int iterations = 0;
    double seconds = 0;
    State end{};
  };

  const Method* method = nullptr;
  double analysis = INFINITY, factorization = INFINITY;  // [s]; the latter of a constant matrix
  std::vector<Step> steps{};
  std::string failure{};
};

std::vector<const Method*> solvers() {
  std::vector<const Method*> all;
  for (const Method& method : methods()) {
    if (method.listens_to(Option::iterations)) all.push_back(&method);
  }
  all.push_back(&newton_exact());
  all.push_back(&newton_clamped());
  return all;
}

// All numbers of iterations at first, then each two fifths more.
std::vector<int> iteration_counts(int most) {
  std::vector<int> counts;
  for (int i = 1; i <= most; i = std::max(i + 1, i * 7 / 5)) counts.push_back(i);
  return counts;
}

Solved solve(const Method& method, const SwingingCloth& cloth, double h, int most, int repeats) {
  Solved solved{.method = &method};
  solved.steps.push_back(
      {0, 0, {cloth.start.t + h, cloth.start.q + h * cloth.start.v, cloth.start.v}});
  if (!method.asks(Need::laplacian)) most = std::min(most, most_newton_iterations);
  for (const int iterations : iteration_counts(most)) {
    const Options options{.step_size = h, .iterations = iterations, .timed = true};
    std::unique_ptr<Integrator> integrator;
    const double analysis =
        seconds_of([&] { integrator = make_integrator(method, cloth.system(), options); });
    std::vector<double> times, factorizations;
    Solved::Step step{.iterations = iterations};
    // The first of several is not timed.
    for (int i = repeats > 1 ? -1 : 0; i < repeats; ++i) {
      stop_if_interrupted();
      step.end = cloth.start;
      Summary summary;
      const double all =
          seconds_of([&] { summary = integrator->advance(step.end, cloth.start.t + h); });
      if (summary.outcome != Outcome::reached_end) {
        solved.failure =
            fmt::format("{} at {} iterations: {}", method.name, iterations, summary.message);
        return solved;
      }
      const double constant = method.asks(Need::laplacian) ? summary.seconds.factorization : 0;
      if (i < 0) continue;
      times.push_back(all - constant);
      factorizations.push_back(constant);
    }
    // Other work on the machine only ever adds to it.
    step.seconds = std::ranges::min(times);
    solved.analysis = std::min(solved.analysis, analysis);
    solved.factorization = std::min(solved.factorization, std::ranges::min(factorizations));
    solved.steps.push_back(std::move(step));
  }
  return solved;
}

// The energy that the step minimises [J].
double objective(const SwingingCloth& cloth, const State& end) {
  return cloth.system().kinetic(end.v - cloth.start.v) + cloth.system().potential(end.q);
}

const Columns<StepRow> error = {{"relative_error", &StepRow::relative_error}};

RowTable<StepRow>& step_table(Program& p, const std::string& file, const std::string& varied,
                              const Columns<StepRow>& last) {
  Columns<StepRow> columns = {};
  if (!varied.empty()) columns += {{varied, &StepRow::varied}};
  columns += {{"solver", &StepRow::solver},
              {"iteration", &StepRow::iteration},
              {"seconds", &StepRow::seconds}};
  columns += last;
  return p.table(file, columns);
}

}  // namespace

const Method& newton_exact() {
  static const Method method =
      newton<false>("newton_exact", "backward Euler by Newton with K as it is");
  return method;
}

const Method& newton_clamped() {
  static const Method method =
      newton<true>("newton_clamped", "backward Euler by Newton with compressed springs' K clamped");
  return method;
}

Comparison compare(const SwingingCloth& cloth, double h, int most, int repeats, double varied,
                   bool with_truth) {
  std::vector<Solved> all;
  for (const Method* method : solvers()) all.push_back(solve(*method, cloth, h, most, repeats));
  const double first = objective(cloth, all.front().steps.front().end);
  double least = INFINITY;
  State converged;
  for (const Solved& solved : all) {
    for (const auto& step : solved.steps) {
      const double g = objective(cloth, step.end);
      if (g >= least) continue;
      least = g;
      converged = step.end;
    }
  }
  Comparison result;
  if (with_truth) result.step_error = cloth.distance(converged, cloth.truth(cloth.start, h));
  for (const Solved& solved : all) {
    const std::string& name = solved.method->name;
    for (const auto& step : solved.steps) {
      result.rows.push_back({varied, name, step.iterations, step.seconds,
                             (objective(cloth, step.end) - least) / (first - least),
                             cloth.distance(step.end, converged), result.step_error});
    }
    result.setup[name] = {{"analysis_s", solved.analysis},
                          {"factorization_s", solved.factorization}};
    if (!solved.failure.empty()) result.failures.push_back(solved.failure);
  }
  return result;
}

StepTables::StepTables(Program& p)
    : convergence(step_table(p, "convergence.csv", "", error)),
      positions(step_table(
          p, "positions.csv", "",
          {{"distance_to_converged", &StepRow::distance}, {"step_error", &StepRow::own}})),
      stiffness(step_table(p, "stiffness.csv", "stiffness", error)),
      resolution(step_table(p, "resolution.csv", "nodes", error)) {}

void StepTables::add(RowTable<StepRow>& table, const Comparison& step,
                     const nlohmann::json& setup) {
  for (const StepRow& row : step.rows) table.add(row);
  table.note({{"setup", setup}});
}

void print(const Comparison& step, double h) {
  const double own = step.step_error;
  fmt::print("one step of {:g} s: {:.3g} m from the true motion when converged\n", h, own);
  fmt::print("{:<24} {:>10} {:>9}  {}\n", "solver", "iterations", "ms",
             "until no more than a tenth is added to that");
  for (auto first = step.rows.begin(); first != step.rows.end();) {
    const auto next = std::find_if(first, step.rows.end(),
                                   [&](const StepRow& row) { return row.solver != first->solver; });
    const auto good =
        std::find_if(first, next, [&](const StepRow& row) { return row.distance <= own / 10; });
    if (good != next) {
      fmt::print("{:<24} {:>10} {:>9.3f}\n", good->solver, good->iteration, 1e3 * good->seconds);
    } else {
      fmt::print("{:<24} {:>10}\n", first->solver, fmt::format("> {}", (next - 1)->iteration));
    }
    first = next;
  }
}

}  // namespace qddot::local_global
