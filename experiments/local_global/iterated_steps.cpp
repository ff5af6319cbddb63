#include "experiments/local_global/iterated_steps.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "experiments/local_global/iterated_newton.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::local_global {
namespace {

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
    Step step{.iterations = iterations};
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
    // What others do on the machine only ever adds to it.
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

}  // namespace

Comparison::Comparison(const SwingingCloth& on, double h, int most, int repeats) : cloth(on) {
  for (const Method* method : solvers()) all.push_back(solve(*method, on, h, most, repeats));
  first = objective(on, all.front().steps.front().end);
  least = std::numeric_limits<double>::infinity();
  for (const Solved& solved : all) {
    for (const Step& step : solved.steps) {
      const double g = objective(on, step.end);
      if (g >= least) continue;
      least = g;
      converged = step.end;
    }
  }
}

double iterations_of_comparison(int most, int repeats) {
  double sum = 0;
  for (const Method* method : solvers()) {
    const int own = method->asks(Need::laplacian) ? most : std::min(most, most_newton_iterations);
    for (const int count : iteration_counts(own)) sum += count;
  }
  return sum * (repeats > 1 ? repeats + 1 : 1);
}

double seconds_of_iterations(const SwingingCloth& cloth, double h, double iterations) {
  constexpr int some = 10;
  const auto integrator = make_integrator(*find_method("local_global"), cloth.system(),
                                          {.step_size = h, .iterations = some});
  State state = cloth.start;
  const double seconds = seconds_of([&] { integrator->advance(state, cloth.start.t + h); });
  return seconds / some * iterations;
}

double Comparison::relative_error(const Step& step) const {
  return (objective(cloth, step.end) - least) / (first - least);
}

}  // namespace qddot::local_global
